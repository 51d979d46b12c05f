// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <array>
#include <string>

namespace vernier::probe {

/// Controller for which a program of a circular test is written.
enum class CircleDialect {
  kIso,  // DIN 66025 / ISO 6983 as the software of a ball bar writes it: G71, numbered blocks with remarks
  kLinuxcnc,  // the same blocks with the words of LinuxCNC
  kUrscript   // movel and movec of a Universal Robots controller
};

/// A circular test (ISO 230-4): the circle in one direction, out, a pause, in again, and the circle in the
/// other direction. mm, deg.
struct CirclePath {
  std::string plane = "XY";           // XY, YZ or ZX: angles count from the first axis to the second
  double radius_mm = 100;             // of the bar
  double feed_mm_min = 1000;          // along the circle
  double from_deg = 0, to_deg = 360;  // of the analysed arc, at most a turn
  double overshoot_deg = 180;         // additional arc before and after it, at most a turn
  double feed_in_mm = 1.5;            // radial path in and out, which starts the instrument
  double pause_s = 5;                 // between the directions
  std::array<double, 3> centre_mm{};
  /// urscript: rotation vector of the tool during the test (rad in the program), and the acceleration of the
  /// tool.
  std::array<double, 3> tool_deg{};
  double acceleration_mm_s2 = 1000;
};

/// Returns the program. The operator mounts the bar when the program stops at the start point.
/// Throws InputError if the path is not possible. The ISO dialect writes the blocks of the
/// published programs byte for byte (Walker, PhD thesis, Strathclyde 2026, figure 4-8, figure 6-5,
/// appendix 16.1).
std::string circle_program(const CirclePath& path, CircleDialect dialect);

}  // namespace vernier::probe
