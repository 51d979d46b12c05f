// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <hal.h>

#include "firmware/core/cycle/wiring.h"

namespace vernier {

/// Pins of one joint, `vernier.0.joint.N.`, in the units of the machine: mm or deg.
struct JointPins {
  hal_float_t *cmd_in, *cmd_out, *fb_in, *fb_out, *correction;
  hal_float_t* pos_in;                 // the joint's position; not connected: cmd-in
  hal_float_t *min_limit, *max_limit;  // that command and correction together keep
  hal_float_t* max_velocity;           // of the joint; 0: its greatest observed speed
  hal_bit_t* homed;                    // on if it is not connected
  hal_bit_t *at_limit, *saturated;
  const hal_float_t *pos_loose, *fb_loose;  // where HAL points them while they are not connected
};

/// All pins of the component, in the memory of HAL.
struct Pins {
  JointPins joint[kMaxAxes];
  hal_float_t* input[kMaxInputs];  // not a number (not connected): no reading
  hal_bit_t *enable, *hold, *clear, *probe_in;
  hal_float_t *weight, *current_vel, *probe_delay;
  hal_bit_t *active, *fault, *saturated, *at_limit, *abort;
  hal_s32_t *mode, *fault_code, *limit_mode;
  hal_u32_t *execution, *execution_max;  // ns
};

/// Exports the pins of a component. Returns null if HAL refuses a pin. Not real-time safe.
Pins* make_pins(int component, const Wiring& wiring) noexcept;

}  // namespace vernier
