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

/// The note of read() about the texts beside a table, given as it quotes them.
inline std::string beside_the_table(const std::string& texts) {
  return "note: beside the table: " + texts +
         ". Does one of these texts change values, their sign (--sign) or unit, positions, or the order or "
         "way "
         "of a run? Then change the file accordingly\n";
}

}  // namespace vernier::importer_test
