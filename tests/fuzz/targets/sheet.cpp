// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/sheet/sheet.h"

#include "tests/fuzz/target.h"
#include "tools/text/error.h"

namespace vernier::fuzz {

using namespace vernier::sheet;
using namespace vernier::text;
namespace {

void take(Bytes bytes) {
  try {
    const Sheet sheet = read_sheet(text_of(bytes), "f.txt");
    expect(sheet.rows.size() == sheet.line.size(), "rows without lines");
    for (const auto& row : sheet.rows)
      expect(row.size() == sheet.rows.front().size(), "a row of another width");
  } catch (const InputError& error) {
    expect_place(error.what(), "f.txt");
  }
}

const Registered kTarget("sheet", take);

}  // namespace
}  // namespace vernier::fuzz
