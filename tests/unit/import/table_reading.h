// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <string>

#include "tools/import/reading/sheet_import.h"
#include "tools/text/error.h"

namespace vernier::importer_test {

/// The measurement file of a table and its notes, or the refusal.
inline std::string read(const std::string& bytes, const importer::SheetWords& words = {}) {
  try {
    const importer::SheetReading reading = importer::read_as_sheet(bytes, "s.csv", words);
    std::string text = measurement_csv(importer::table_of_reading(reading));
    for (const std::string& note : reading.sheet.notes) text += "note: " + note + "\n";
    return text;
  } catch (const text::InputError& error) {
    return std::string("refused: ") + error.what();
  }
}

}  // namespace vernier::importer_test
