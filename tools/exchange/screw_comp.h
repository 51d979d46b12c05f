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

/// Type 0 contains the actual positions of the axis (nominal, forward, reverse; the controller makes trim =
/// nominal - actual of it), type 1 the trims. Source: LinuxCNC src/emc/motion/usrmotintf.cc, usrmotLoadComp.
enum class ScrewType { kActual = 0, kTrim = 1 };

/// Lines that the controller keeps at most (EMCMOT_COMP_SIZE).
inline constexpr std::size_t kMostScrewPoints = 256;

/// The lines of one axis, and how well they hold its errors.
struct ScrewTable {
  std::vector<ScrewPoint> points;
  double worst_um = 0;     // largest distance between the trims and the lines, rounding of the file included
  std::size_t probed = 0;  // positions that were evaluated, in both directions
};

/// Trims of one linear axis in both directions, at the stations of its table and at further positions until
/// the error between them is within tolerance_um; other axes, motion and inputs as in `at` (count 1). They
/// are first-order offsets, as if measured at the commanded positions, so that an axis that carries the
/// workpiece has the right sign. At least 4096 positions at uneven distances are evaluated, 32 in each period
/// and 8 between stations (65536 at most). Throws InputError: no min and max; LimitNotMet, with the error
/// reached: more lines than the controller accepts. tool.
ScrewTable screw_table(const model::Machine& machine, std::size_t axis, const model::States& at,
                       double tolerance_um);

/// Text of a file: only lines of three numbers (the controller stops reading at any other line).
std::string screw_text(const std::vector<ScrewPoint>& points, ScrewType type);

/// Reads a file. Throws InputError with file, line and word: not three numbers, positions that do not
/// increase, too many lines. tool.
std::vector<ScrewPoint> parse_screw(const std::string& text, const std::string& file, ScrewType type);

/// The machine text with the points as the axis' column of its table: minus the mean of both trims, and half
/// their difference as static `reversal` (empty: no reversal is allowed). Verified: the resulting machine has
/// the same trims. Throws InputError if it has not, or if the reversal is not the same at all points. tool.
std::string screw_into_machine(const std::string& text, const model::Machine& machine, std::size_t axis,
                               const std::vector<ScrewPoint>& points, const std::string& reversal);

}  // namespace vernier::exchange
