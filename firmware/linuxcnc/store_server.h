// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <cstdint>
#include <span>

#include "firmware/linuxcnc/hatch.h"
#include "hal/slot_store.h"

namespace vernier {

/// The part of the component's store that is in vernier-hal. The store part in vernier-hal executes the
/// requests of the component, one at a time.
class StoreServer {
 public:
  /// `call`, `store`, `given` (the image to start with): must exist longer than this object. Not real-time
  /// safe.
  StoreServer(Call& call, SlotStore& store, std::span<const std::uint8_t> given) noexcept
      : call_(call), store_(store), given_(given) {}
  /// Waits for a request of the component for at most `wait`, and answers it. Not real-time safe.
  void serve(TimeUs wait) noexcept;

 private:
  HalFault run() noexcept;
  HalFault read_given() noexcept;

  Call& call_;
  SlotStore& store_;
  std::span<const std::uint8_t> given_;
};

}  // namespace vernier
