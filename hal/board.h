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

/// All devices of a board. The pointers do not own the devices. A null pointer means that the board does not
/// have the device.
struct Board {
  Clock& clock;
  AxisReader& axes;
  InputReader& inputs;
  CorrectionWriter& corrections;
  ProbeLine* probe = nullptr;
  AxisReader* actual = nullptr;      // actual positions for touches, used if `axes` gives commanded positions
  TickSync* sync = nullptr;          // signal that starts the ticks; null: the clock starts them
  DigitalInput* enable = nullptr;    // enable signal; off: no correction is applied
  DigitalOutput* healthy = nullptr;  // output that is on if all devices answer and no fault is latched
  IdentityKey* identity = nullptr;   // key that proves the identity of the board; null: the board has no key
};

}  // namespace vernier
