// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <hal.h>

#include "firmware/core/cycle/wiring.h"

namespace vernier {

/// Pins of one joint, `vernier.0.joint.N.`, in the units of the machine: mm or deg.
struct JointPins {
  hal_float_t *cmd_in, *cmd_out, *fb_in, *fb_out, *correction;
  hal_float_t* pos_in;                 // position of the joint; if it is not connected, cmd-in is used
  hal_float_t *min_limit, *max_limit;  // limits for the sum of command and correction
  hal_float_t* max_velocity;           // largest speed of the joint; 0: its largest observed speed
  hal_bit_t* homed;                    // on if the pin is not connected
  hal_bit_t *at_limit, *saturated;
  const hal_float_t *pos_loose, *fb_loose;  // addresses of the pins' data while the pins are not connected
};

/// All HAL pins of the component.
struct Pins {
  JointPins joint[kMaxAxes];
  hal_float_t* input[kMaxInputs];  // a value that is not a number (also: pin not connected) is a missing
                                   // reading
  hal_bit_t *enable, *hold, *clear, *probe_in;
  hal_float_t *weight, *current_vel, *probe_delay;
  hal_bit_t *active, *fault, *saturated, *at_limit, *abort;
  hal_s32_t *mode, *fault_code, *limit_mode;
  hal_u32_t *execution, *execution_max;  // execution time of a tick, ns
};

/// Creates the HAL pins of a component. Returns null if HAL refuses to create a pin. Not real-time safe.
Pins* make_pins(int component, const Wiring& wiring) noexcept;

}  // namespace vernier
