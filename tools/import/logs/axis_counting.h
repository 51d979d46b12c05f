// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <map>
#include <optional>
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
  double position(double number) const { return (reversed ? -number : number) + zero; }
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

/// Another way to count the positions of a list.
struct OtherCounting {
  std::map<std::string, AxisCounting> axes;  // those that are counted otherwise
  double farthest_mm = 0;                    // largest distance of a point from its nominal position with it
};
/// Finds joints that a list counts in the other direction, and at most two joints whose zeros are others by
/// 90 or 180 deg, with which the points agree with the nominal machine: within `limit_mm`, or ten times
/// better than as given (`given_mm`). The machine can have errors above the limit. `table`: with a position
/// of every axis in each row. `axes`: names of the axes that may be counted otherwise. No value: no such
/// counting agrees, or two with the same number of joints do.
std::optional<OtherCounting> counting_that_agrees(const ImportTable& table, const model::Machine& machine,
                                                  const std::vector<std::string>& axes, ToolPlace place,
                                                  double limit_mm, double given_mm);

}  // namespace vernier::importer
