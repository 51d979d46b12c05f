// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <atomic>
#include <iosfwd>
#include <vector>

#include "firmware/daemon/settings/calibration.h"
#include "hal/clock.h"
#include "hal/correction_writer.h"
#include "hal/support/analogue_scale.h"

namespace vernier {

/// Moves an analogue output through its range, up and down again. At each code of the output, the
/// function asks for the reading of the measuring instrument. The code changes at a rate of at most
/// the whole range in five seconds. At the end the output has its zero code. `output`: its axis 0
/// is used, with the range of `scale`; `start`: present code; `steps`: number of codes on the way
/// up, at least 2; `stop`: ends the motion. If the result has fewer than 2 * steps - 1 points, the
/// motion was ended before its end. Throws BoardError if the output refuses a write. Not real-time
/// safe.
std::vector<CalibrationPoint> calibrate_output(CorrectionWriter& output, const AnalogueScale& scale,
                                               std::int64_t start, int steps, Clock& clock,
                                               std::istream& answers, std::ostream& questions,
                                               const std::atomic<bool>& stop);

}  // namespace vernier
