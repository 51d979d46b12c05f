// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <string>
#include <vector>

#include "tools/model/machine.h"
#include "tools/model/states.h"

namespace vernier::exchange {

/// One line of a screw-compensation file. A trim is the value that the controller adds to the command: a
/// correction.
struct ScrewPoint {
  double nominal = 0;  // mm or deg
  double forward_trim = 0, reverse_trim = 0;
};

/// Type 0: the file contains the actual positions of the axis (nominal, forward, reverse); the controller
/// computes trim = nominal - actual. A file of type 1 contains the trims. Source: LinuxCNC
/// src/emc/motion/usrmotintf.cc, usrmotLoadComp.
enum class ScrewType { kActual = 0, kTrim = 1 };

/// Largest number of lines that the controller stores (EMCMOT_COMP_SIZE).
inline constexpr std::size_t kMostScrewPoints = 256;

/// The lines of one axis, and the accuracy with which they represent its errors.
struct ScrewTable {
  std::vector<ScrewPoint> points;
  double worst_um = 0;     // largest distance between the trims and the lines, rounding of the file included
  std::size_t probed = 0;  // positions that were evaluated, in both directions
};

/// Returns the trims of one linear axis in both directions. Positions: the stations of its table, and further
/// positions until the error between them is within tolerance_um. `at` (count 1): other axes, motion and
/// inputs. The trims are first-order offsets, as if measured at the commanded positions. An axis that carries
/// the workpiece therefore has the correct sign. The error between positions is tested at 4096 or more uneven
/// positions: 32 in each period, 8 between stations, 65536 at most. Throws InputError: no min and max;
/// LimitNotMet, with the error reached: more lines than the controller accepts.
ScrewTable screw_table(const model::Machine& machine, std::size_t axis, const model::States& at,
                       double tolerance_um);

/// Returns the text of a file: only lines of three numbers (the controller stops reading at any other line).
std::string screw_text(const std::vector<ScrewPoint>& points, ScrewType type);

/// Reads a screw-compensation file. Throws InputError with file, line and word: a line without three numbers,
/// positions that do not increase, too many lines.
std::vector<ScrewPoint> parse_screw(const std::string& text, const std::string& file, ScrewType type);

/// Returns the machine text with the points as the column of the axis in its table: minus the mean of both
/// trims. Half their difference becomes the static `reversal` (empty: a reversal is not allowed). The
/// function verifies that the resulting machine has the same trims. Throws InputError if the trims differ, or
/// if the reversal is not equal at all points.
std::string screw_into_machine(const std::string& text, const model::Machine& machine, std::size_t axis,
                               const std::vector<ScrewPoint>& points, const std::string& reversal);

}  // namespace vernier::exchange
