// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <string>
#include <vector>

#include "tools/evaluate/robot.h"

namespace vernier::evaluate {

/// Results of a pose in one block of cycles of a long test, compared with the first block of cycles.
struct DriftBlock {
  std::string run;
  double time_s = 0;  // mean time of the block's readings minus that of the first block; NaN without times
  PoseResult pose;
  double accuracy_drift_mm = 0, accuracy_drift_std_mm = 0;  // dAP, and its standard uncertainty from the
                                                            // scatter
  double repeatability_drift_mm = 0, repeatability_drift_std_mm = 0;  // dRP, and its standard uncertainty
                                                                      // from the scatter
  double shift_mm = 0;  // shift of the barycentre; dAP is 0 if the barycentre moves on a circle about the
                        // commanded point
};

/// Results of a pose over the whole test.
struct DriftResult {
  std::vector<DriftBlock> blocks;                                   // the first block is the reference
  std::size_t accuracy_at = 0, repeatability_at = 0, shift_at = 0;  // indices of the blocks with the largest
                                                                    // drifts and shift
};

/// Returns the drift of each pose. The run of a reading identifies its block of cycles. The drifts are dAP =
/// |AP of the first block - AP of this block| and dRP = |RP of the first block - RP of this block|. The
/// result also identifies the blocks with the largest drifts. Throws InputError if a block has fewer than two
/// readings of a pose, if a pose occurs in only one block, or if the blocks are not in time order. The
/// definitions are those of ISO 9283:1998, 7.6. The shift of the barycentre is not defined in the standard.
/// An instrument error that is equal in both blocks is no drift. The uncertainties of a drift therefore
/// contain only the scatter. A drift of the instrument cannot be distinguished from a drift of the robot.
std::vector<DriftResult> evaluate_drift(const std::vector<PoseReading>& readings);

}  // namespace vernier::evaluate
