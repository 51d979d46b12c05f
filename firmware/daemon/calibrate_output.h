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

/// Moves an output through its range, up and down again, and asks for the reading of the instrument at each
/// code. The code changes by at most the whole range in five seconds, and is at its zero at the end. output:
/// its axis 0, made with `scale`, whose range is used; start: present code; steps: codes on the way up, at
/// least 2; stop: ends the motion. Fewer than 2 * steps - 1 points in the result: the motion was ended early.
/// Throws BoardError if a write is refused. Not real-time safe.
std::vector<CalibrationPoint> calibrate_output(CorrectionWriter& output, const AnalogueScale& scale,
                                               std::int64_t start, int steps, Clock& clock,
                                               std::istream& answers, std::ostream& questions,
                                               const std::atomic<bool>& stop);

}  // namespace vernier
