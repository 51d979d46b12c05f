// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <array>
#include <string>

namespace vernier::probe {

/// Controller for which the program of a circular test is written.
enum class CircleDialect {
  kIso,  // DIN 66025 / ISO 6983, as the software of a ball bar writes it: G71, numbered blocks with comments
  kLinuxcnc,  // the same blocks with the G-code words of LinuxCNC
  kUrscript   // commands movel and movec of a Universal Robots controller
};

/// Program of a circular test (ISO 230-4): the circle in one direction, feed-out, a pause, feed-in, and the
/// circle in the other direction. Units are mm and deg.
struct CirclePath {
  std::string plane = "XY";           // XY, YZ or ZX; angles are counted from the first axis to the second
                                      // axis
  double radius_mm = 100;             // length of the ball bar
  double feed_mm_min = 1000;          // feed along the circle
  double from_deg = 0, to_deg = 360;  // start and end of the analysed arc, at most one turn
  double overshoot_deg = 180;         // additional arc before and after the analysed arc, at most one turn
  double feed_in_mm = 1.5;            // length of the radial feed-in and feed-out, which starts the
                                      // instrument
  double pause_s = 5;                 // pause between the two directions
  std::array<double, 3> centre_mm{};
  /// For kUrscript: rotation vector of the tool during the test (rad in the program), and acceleration of the
  /// tool.
  std::array<double, 3> tool_deg{};
  double acceleration_mm_s2 = 1000;
};

/// Returns the program of a circular test as text. The program stops at the start point, where the operator
/// mounts the ball bar. Throws InputError if the path is not possible. With the dialect kIso, the blocks are
/// identical to those of the published programs (Walker, PhD thesis, Strathclyde 2026, figure 4-8, figure
/// 6-5, appendix 16.1).
std::string circle_program(const CirclePath& path, CircleDialect dialect);

}  // namespace vernier::probe
