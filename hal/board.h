// SPDX-License-Identifier: Apache-2.0
#pragma once
#include "hal/axis_reader.h"
#include "hal/clock.h"
#include "hal/correction_writer.h"
#include "hal/input_reader.h"

namespace vernier {

/// All devices of a board, non-owning.
struct Board {
  Clock& clock;
  AxisReader& axes;
  InputReader& inputs;
  CorrectionWriter& corrections;
};

}  // namespace vernier
