// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/format/csv_file.h"

#include "tests/fuzz/target.h"

namespace vernier::fuzz {

using namespace vernier::format;
using namespace vernier::text;
namespace {

void take(Bytes bytes) {
  try {
    const CsvFile csv = parse_csv(text_of(bytes), "f.csv");
    expect(csv.rows.size() == csv.line.size(), "rows without lines");
    for (const auto& row : csv.rows) expect(row.size() == csv.columns.size(), "a row of another width");
  } catch (const InputError& error) {
    expect_place(error.what(), "f.csv");
  }
}

const Registered kTarget("csv", take);

}  // namespace
}  // namespace vernier::fuzz
