// SPDX-License-Identifier: GPL-3.0-or-later
#include "tests/fuzz/target.h"
#include "tools/format/csv_file.h"
#include "tools/import/columns/sheet_columns.h"
#include "tools/import/tables/sheet_table.h"
#include "tools/import/tables/wide_sheet.h"

namespace vernier::fuzz {

using namespace vernier::importer;
using namespace vernier::sheet;
using namespace vernier::format;
using namespace vernier::text;
namespace {

/// A profile, a line of ====, the spreadsheet that it is for: what comes out is a measurement file.
void take(Bytes bytes) {
  const std::string text = text_of(bytes), mark = "\n====\n";
  const std::size_t split = text.find(mark);
  if (split == std::string::npos) return;
  try {
    SheetWishes wishes;
    read_sheet_profile(wishes, text.substr(0, split), "f.profile");
    Sheet sheet = read_sheet(text.substr(split + mark.size()), "f.txt", wishes.format);
    SheetTable table = parts_of_sheet(sheet);
    unfold_runs(sheet, table, wishes);
    parse_csv(measurement_csv(table_of_sheet(sheet, table, columns_of_sheet(sheet, table, wishes), wishes)),
              "f.csv");
  } catch (const InputError& error) {
    expect_place(error.what(), "f.");
  }
}

const Registered kTarget("spreadsheet", take);

}  // namespace
}  // namespace vernier::fuzz
