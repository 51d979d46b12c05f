// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <string>
#include <vector>

#include "tools/probe/conditions.h"

namespace vernier::probe {

/// Controllers for which a probing program can be written.
enum class Dialect {
  kTurning,   // the dialect of NISTIR 6415: X as a diameter, G70/G94, probe on by M14, "!" comments
  kLinuxcnc,  // G38.2, results into a file by (PROBEOPEN)
  kFanuc,     // G31, results in #5061..#5063 printed by DPRNT
  kAerobasic  // PROBE MODE, LINEAR, as in the published routine of an A3200
};

/// A calibration by touches on a sphere or a gauge block. Lengths in mm.
struct ProbePath {
  bool sphere = true;
  double radius = 0;       // sphere: radius, artefact alone; block: half the distance of its faces
  double clearance = 0;    // from the surface to the start of an approach
  double overtravel = 2;   // beyond the surface; for controllers that stop at a touch
  double ball_radius = 0;  // of the stylus; the program moves its centre (not in the turning dialect)
  double from_deg = -100, to_deg = 100, step_deg = 2.5;  // sphere: of the approach in its plane
  std::vector<double> elevations_deg = {0};  // sphere, three axes: further circles; 90 is the pole
  std::vector<double> feeds = {100};         // mm/min; in/min if inch
  int repeats = 1;                           // block: touches of each face and feed
  bool inch = false;                         // numbers of the program
  double dwell = 3;                          // turning: after each touch, as written behind G04
  double centre_offset = 1.25;  // turning: from the coordinate's zero to the sphere's axis, program units
  std::string name = "PROBE", title = "PROBE CALIBRATION";
  std::vector<std::string> comments;  // at the top, one per line
  TouchConditions conditions;
  bool unchecked = false;  // written even if a touch would not be valid
};

/// Returns the program. Throws InputError if the path is not possible (no step, no feed, elevations in two
/// axes). Throws LimitNotMet if a touch would not be valid (broken_conditions), each reason on a line.
/// Turning dialect: blocks 210, 215, 225, 240, then 50 more for each point. Coordinates are in single
/// precision from points of six decimals, as in the published program. The function reproduces the 324 blocks
/// of the published program exactly (NISTIR 6415, appendices A1, B).
std::string probe_program(const ProbePath& path, Dialect dialect);

}  // namespace vernier::probe
