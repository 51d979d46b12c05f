// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <map>
#include <string>
#include <vector>

#include "tools/import/columns/column_map.h"
#include "tools/import/logs/nominal_points.h"
#include "tools/model/machine.h"

namespace vernier::importer {

/// How a list counts the positions of an axis: the position in the machine file is the number in the list,
/// with the other sign if `reversed`, and then plus `zero`.
struct AxisCounting {
  bool reversed = false;
  double zero = 0;  // in the unit of the list

  bool is_that_of_machine() const { return !reversed && zero == 0; }
};

/// A heading with a sign or an addend: "-A3", "A3+90", "-A3-90".
struct CountedHeading {
  std::string heading;
  AxisCounting counting;
};
/// Returns the readings of such words, the one with the longest heading first: a heading may itself end with
/// a sign and a number ("Achse-1").
std::vector<CountedHeading> counted_headings(const std::string& words);
/// Returns the words of a heading with a sign and an addend.
std::string in_words(const CountedHeading& heading);

/// Finds joints that a list counts in the other direction, and at most one joint whose zero is another by 90
/// or 180 deg: with them all points agree within `limit_mm` with the nominal machine. `table`: with a
/// position of every axis in each row. `axes`: names of the axes that may be counted otherwise. Empty: no
/// such counting agrees, or two with the same number of joints do.
std::map<std::string, AxisCounting> counting_that_agrees(const ImportTable& table,
                                                         const model::Machine& machine,
                                                         const std::vector<std::string>& axes,
                                                         ToolPlace place, double limit_mm);

}  // namespace vernier::importer
