// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/import/columns/column_map.h"

#include "tests/fuzz/target.h"
#include "tools/format/csv_file.h"
#include "tools/import/tables/survey.h"

namespace vernier::fuzz {

using namespace vernier::importer;
using namespace vernier::format;
using namespace vernier::text;
namespace {

/// A map of columns, a line of ====, the table that it is for: trackers and probes come in so.
void take(Bytes bytes) {
  const std::string text = text_of(bytes), mark = "\n====\n";
  const std::size_t split = text.find(mark);
  if (split == std::string::npos) return;
  try {
    ColumnMap map;
    read_column_map(map, text.substr(0, split), "f.map");
    for (const bool tracker : {true, false}) {
      ImportTable table = mapped_table(text.substr(split + mark.size()), "f.txt", map);
      if (tracker)
        finish_tracker(table);
      else
        finish_probe(table, 1);
      parse_csv(measurement_csv(table), "f.csv");
    }
  } catch (const InputError& error) {
    expect_place(error.what(), "f.");
  }
}

const Registered kTarget("column_map", take);

}  // namespace
}  // namespace vernier::fuzz
