// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <string>
#include <vector>

#include "tools/model/machine.h"
#include "tools/model/states.h"

namespace vernier::exchange {

/// One line of a screw-compensation file of LinuxCNC. A trim is a correction: the value that the controller
/// adds to the command.
struct ScrewPoint {
  double nominal = 0;  // nominal position, mm or deg
  double forward_trim = 0, reverse_trim = 0;
};

/// A file of type 0 contains the nominal position and the actual positions (forward, reverse). The controller
/// computes trim = nominal - actual. A file of type 1 contains the trims. The format is that of LinuxCNC
/// src/emc/motion/usrmotintf.cc, usrmotLoadComp.
enum class ScrewType { kActual = 0, kTrim = 1 };

/// Largest number of lines that the LinuxCNC controller stores (EMCMOT_COMP_SIZE).
inline constexpr std::size_t kMostScrewPoints = 256;

/// The screw-compensation lines of one axis, and the accuracy with which they represent the errors of the
/// axis.
struct ScrewTable {
  std::vector<ScrewPoint> points;
  double worst_um = 0;     // largest difference between the true trims and the lines, including the rounding
                           // of the file
  std::size_t probed = 0;  // number of positions at which the difference was computed, in both directions
};

/// Returns the trims of one linear axis in both directions. The positions of the lines are the stations of
/// the axis' table, and further positions until the error between them is within tolerance_um. `at` (one
/// state): positions of other axes, motion and inputs. The trims are first-order offsets, as if the errors
/// were measured at the commanded positions. For an axis that moves the workpiece, the trims therefore have
/// the correct sign. The error between the positions is computed at 4096 or more uneven positions: 32 in each
/// period, 8 between stations, at most 65536. Throws InputError if the axis has no min and max. Throws
/// LimitNotMet with the reached error if more lines are necessary than the controller accepts.
ScrewTable screw_table(const model::Machine& machine, std::size_t axis, const model::States& at,
                       double tolerance_um);

/// Returns the text of a screw-compensation file. The file has only lines of three numbers, because the
/// controller stops reading at any other line.
std::string screw_text(const std::vector<ScrewPoint>& points, ScrewType type);

/// Reads a screw-compensation file. Throws InputError with file, line and word for: a line without three
/// numbers, positions that do not increase, too many lines.
std::vector<ScrewPoint> parse_screw(const std::string& text, const std::string& file, ScrewType type);

/// Returns the text of a machine file with the points in the axis' table. The column of the axis is minus the
/// mean of both trims. Half the difference of both trims becomes the static with the name `reversal`. If this
/// name is empty, the trims must not differ. The function verifies that the resulting machine has the same
/// trims as the points. Throws InputError if the trims differ although no name is given, or if the reversal
/// is not equal at all points.
std::string screw_into_machine(const std::string& text, const model::Machine& machine, std::size_t axis,
                               const std::vector<ScrewPoint>& points, const std::string& reversal);

}  // namespace vernier::exchange
