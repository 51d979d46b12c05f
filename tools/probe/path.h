// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <string>
#include <vector>

#include "tools/probe/conditions.h"

namespace vernier::probe {

/// Controllers for which a probing program can be written.
enum class Dialect {
  kTurning,   // the turning centre of NISTIR 6415: X as a diameter, G70/G94, probe on by M14, "!" comments
  kLinuxcnc,  // G38.2, with results in a file by (PROBEOPEN)
  kFanuc,     // G31, with results in #5061..#5063, which DPRNT prints
  kAerobasic  // PROBE MODE, LINEAR, as in the published routine for an A3200
};

/// Program of a probe calibration by touches on a sphere or a gauge block. All lengths of a ProbePath are in
/// mm.
struct ProbePath {
  bool sphere = true;
  double radius = 0;       // sphere: radius of the artefact alone; block: half the distance between its faces
  double clearance = 0;    // distance from the surface to the start of an approach
  double overtravel = 2;   // distance beyond the surface; for controllers that stop at a touch
  double ball_radius = 0;  // radius of the stylus ball; the program moves the centre of the ball (except for
                           // kTurning)
  double from_deg = -100, to_deg = 100, step_deg = 2.5;  // sphere: range and step of the approach angle in
                                                         // its plane
  /// Sphere, three axes: elevations of further circles; 90 is the pole
  std::vector<double> elevations_deg = {0};
  std::vector<double> feeds = {100};  // mm/min; in/min if `inch` is true
  int repeats = 1;                    // block: number of touches for each face and feed
  bool inch = false;                  // true: the numbers of the program are in inches
  double dwell = 3;                   // turning: dwell after each touch, as it is written after G04
  double centre_offset = 1.25;        // turning: distance from the zero of the coordinate to the axis of the
                                      // sphere, program units
  std::string name = "PROBE", title = "PROBE CALIBRATION";
  std::vector<std::string> comments;  // comments at the beginning of the program, one per line
  TouchConditions conditions;
  bool unchecked = false;  // true: the program is written even if a touch would not be valid
};

/// Returns the probing program as text. Throws InputError if the path is not possible (no step, no feed,
/// elevations with only two axes). Throws LimitNotMet if a touch would not be valid (broken_conditions), with
/// each reason on its own line. For kTurning, the block numbers are 210, 215, 225, 240, and then 50 more for
/// each point. For kTurning, the coordinates are computed in single precision from points with six decimals,
/// as in the published program. For kTurning, the function reproduces the 324 blocks of the published program
/// exactly (NISTIR 6415, appendices A1, B).
std::string probe_program(const ProbePath& path, Dialect dialect);

}  // namespace vernier::probe
