// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <array>
#include <string>
#include <vector>

#include "tools/import/words/joint_names.h"

namespace vernier::importer {

/// A point with its commanded position, as the user states it (--point, or a list of nominal positions).
struct NamedPoint {
  std::string name;
  std::vector<double> values;        // one for each axis of NamedPoints::axes, mm or deg
  std::array<double, 3> at_mm = {};  // tool point of the nominal machine at this position, mm
};

/// The points that the user stated, and the axes whose positions they have.
struct NamedPoints {
  // Axes of the machine (X Y Z without a machine) that no constant states.
  std::vector<MissingAxis> axes = {{"X", false}, {"Y", false}, {"Z", false}};
  std::vector<NamedPoint> points;
  std::string list;           // file of the list of nominal positions; empty: no list
  double tolerance_mm = 0.5;  // largest permitted difference of a nominal distance from the distance of the
                              // stated points: a rounded drawing, and much less than two exchanged corners
};

}  // namespace vernier::importer
