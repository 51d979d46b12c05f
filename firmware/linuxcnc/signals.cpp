// SPDX-License-Identifier: GPL-3.0-or-later
#include "firmware/linuxcnc/signals.h"

#include <cmath>

namespace vernier {

HalFault PinInputs::read_input(std::uint32_t input, InputMicro& value) noexcept {
  constexpr double kMost = 9e12;  // a million of them fit
  if (input >= count_) return HalFault::kNoDevice;
  const double read = *pins_.input[input];
  if (!(std::abs(read) < kMost)) return HalFault::kNoReading;
  value = InputMicro(std::llround(read * 1e6));
  return HalFault::kNone;
}

HalFault PinProbe::read_edge(ProbeEdge& edge) noexcept {
  const bool made = *pins_.probe_in;
  if (made == made_ || runner_ == nullptr) return HalFault::kNoReading;
  made_ = made;
  edge = {runner_->woke() - InstantNs(tick_.count / 2), made};
  return HalFault::kNone;
}

}  // namespace vernier
