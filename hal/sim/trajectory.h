// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>

#include "comp/equation.h"
#include "hal/axis_reader.h"

namespace vernier {

/// Motion of the simulated machine at one tick, without the errors of instruments. The positions of axes with
/// rollover include whole turns.
struct PlantState {
  AxisReading axis[kMaxAxes];
  InputMicro input[kMaxInputs];
  PathReading path;
};

/// A motion of the machine as a function of the tick.
class Trajectory {
 public:
  virtual ~Trajectory() = default;
  /// Computes the state at a tick. `tick`: 0 is the start. The function may be called for ticks in any order.
  virtual void at(std::int64_t tick, PlantState& state) noexcept = 0;
};

}  // namespace vernier
