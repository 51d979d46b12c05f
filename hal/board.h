// SPDX-License-Identifier: Apache-2.0
#pragma once
#include "hal/axis_reader.h"
#include "hal/clock.h"
#include "hal/correction_writer.h"
#include "hal/digital_line.h"
#include "hal/identity_key.h"
#include "hal/input_reader.h"
#include "hal/probe_line.h"
#include "hal/tick_sync.h"

namespace vernier {

/// All devices of a board; the pointers do not own the devices. A null pointer means that the board does not
/// have the device.
struct Board {
  Clock& clock;
  AxisReader& axes;
  InputReader& inputs;
  CorrectionWriter& corrections;
  ProbeLine* probe = nullptr;
  AxisReader* actual = nullptr;      // actual positions, for touches, if `axes` gives commanded positions
  TickSync* sync = nullptr;          // starts the ticks; null: the clock does
  DigitalInput* enable = nullptr;    // off: no correction is let in
  DigitalOutput* healthy = nullptr;  // on: devices answer and no fault is latched
  IdentityKey* identity = nullptr;   // proves the identity of the board; null: the board has no key
};

}  // namespace vernier
