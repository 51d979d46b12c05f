// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <map>
#include <string>
#include <vector>

#include "tools/format/csv_file.h"
#include "tools/model/machine_reader.h"
#include "tools/part/b_head_machine.h"
#include "tools/text/files.h"
#include "tools/text/numbers.h"

namespace vernier::part_data {

using namespace vernier::model;
using namespace vernier::part;
using namespace vernier::format;
using namespace vernier::text;

inline std::string path(const std::string& name) {
  return std::string(VERNIER_SOURCE_DIR) + "/tests/data/spart/" + name;
}

/// Cells of a published table by row and column name.
inline std::vector<std::map<std::string, std::string>> rows(const std::string& name) {
  const CsvFile csv = parse_csv(read_file(path(name)), name);
  std::vector<std::map<std::string, std::string>> result;
  for (const auto& row : csv.rows) {
    auto& cells = result.emplace_back();
    for (std::size_t i = 0; i < csv.columns.size(); ++i) cells[csv.columns[i].name] = row[i];
  }
  return result;
}

/// A number that must be there.
inline double number(const std::string& text) { return parse_number(text).value(); }

/// The built-in machine with errors as `--errors` writes them.
inline BHeadMachine machine(const std::string& errors = "") {
  Machine m = parse_machine(default_b_head_text(), "built-in machine");
  set_errors(m, errors);
  return b_head_machine(std::move(m));
}

/// The errors that the paper simulated with, from its table 4.
inline constexpr const char* kTable4 = "EA0B=3.2419e-4rad,EX0B=0.0294mm";

}  // namespace vernier::part_data
