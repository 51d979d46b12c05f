// SPDX-License-Identifier: GPL-3.0-or-later
#include "tests/fuzz/target.h"
#include "tools/text/error.h"
#include "tools/workbench/files/excluded.h"

namespace vernier::fuzz {

using namespace vernier::text;
using namespace vernier::workbench;
namespace {

/// Lines and a measurement file: what was taken out is there again when it is put back.
void take(Bytes bytes) {
  const std::string text = text_of(bytes);
  const std::size_t end = std::min(text.find('\n'), text.size());
  const std::string rows = end < text.size() ? text.substr(end + 1) : "";
  try {
    const std::vector<std::size_t> lines = parse_lines(text.substr(0, end));
    excluded_rows(rows);
    const std::string without = exclude_rows(rows, "f.csv", lines, "a reason");
    expect(restore_rows(without, "f.csv", lines) == rows, "does not come back the same");
  } catch (const InputError&) {  // of the lines, which are an argument, or of the file
  }
}

const Registered kTarget("exclude", take);

}  // namespace
}  // namespace vernier::fuzz
