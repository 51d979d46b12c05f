// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <string>
#include <vector>

#include "tools/evaluate/robot.h"

namespace vernier::evaluate {

/// Characteristics of a pose in one block of cycles of a long test, compared with the first block.
struct DriftBlock {
  std::string run;
  double time_s = 0;  // middle of its readings since that of the first; not a number without times
  PoseResult pose;
  double accuracy_drift_mm = 0, accuracy_drift_std_mm = 0;  // dAP, and what its scatter makes it uncertain by
  double repeatability_drift_mm = 0, repeatability_drift_std_mm = 0;  // dRP, likewise
  double shift_mm = 0;  // of the barycentre: dAP is 0 if it moves on a circle about the commanded point
};

/// A pose over the whole test.
struct DriftResult {
  std::vector<DriftBlock> blocks;                                   // the first is the reference
  std::size_t accuracy_at = 0, repeatability_at = 0, shift_at = 0;  // blocks of the largest
};

/// Returns the drift of the characteristics of each pose; the run of a reading is its block of cycles. dAP =
/// |AP of the first block - AP of this block|, dRP = |RP of the first block - RP of this block|. The largest
/// drifts are returned. Throws InputError: a block with fewer than two readings of a pose, a pose in one
/// block only, blocks that go back in time. Source: ISO 9283:1998, 7.6. The shift of the barycentre is
/// not in the standard. An instrument error that is equal in both blocks is no drift: the uncertainties
/// contain only the scatter. A drift of the instrument cannot be distinguished from a drift of the robot.
std::vector<DriftResult> evaluate_drift(const std::vector<PoseReading>& readings);

}  // namespace vernier::evaluate
