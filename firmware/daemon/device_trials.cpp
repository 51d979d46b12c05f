// SPDX-License-Identifier: Apache-2.0
#include "firmware/daemon/device_trials.h"

#include "hal/linux/can/can_axes.h"
#include "hal/linux/iio/iio_buffer.h"

namespace vernier {
namespace {

constexpr TimeUs kTrialWait(5'000);

}  // namespace

bool hear_position(Clock& clock, AxisReader& axes, std::uint32_t axis) {
  const InstantNs end = clock.now() + instant_ns(kPatience);
  for (AxisReading reading; clock.now() < end; clock.sleep_until(clock.now() + instant_ns(kTrialWait))) {
    axes.begin_tick();
    if (axes.read_axis(axis, reading) == HalFault::kNone) return true;
  }
  return false;
}

std::string hear_axis(Clock& clock, CanAxes& bus, std::uint32_t axis) {
  if (hear_position(clock, bus, axis)) return {};
  return bus.counts().frames + bus.counts().invalid + bus.counts().stalled == 0
             ? "no CAN frame of this axis has come within 1 s"
             : "no valid frame within 1 s";
}

std::string hear_scan(Clock& clock, IioBuffer& buffer, std::uint32_t channel) {
  const InstantNs end = clock.now() + instant_ns(kPatience);
  for (InputMicro value; clock.now() < end; clock.sleep_until(clock.now() + instant_ns(kTrialWait))) {
    buffer.begin_tick();
    if (buffer.read_input(channel, value) == HalFault::kNone) return {};
  }
  return "no scan of this sensor has come within 1 s";
}

}  // namespace vernier
