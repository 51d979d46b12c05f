// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <cstdint>
#include <span>

#include "firmware/linuxcnc/hatch.h"
#include "hal/slot_store.h"

namespace vernier {

/// vernier-hal's side of the component's store: executes requests of the component, one at a time.
class StoreServer {
 public:
  /// call, store, given (the image to start with): outlive this object. Not real-time safe.
  StoreServer(Call& call, SlotStore& store, std::span<const std::uint8_t> given) noexcept
      : call_(call), store_(store), given_(given) {}
  /// Waits at most `wait` for a request of the component and answers it. Not real-time safe.
  void serve(TimeUs wait) noexcept;

 private:
  HalFault run() noexcept;
  HalFault read_given() noexcept;

  Call& call_;
  SlotStore& store_;
  std::span<const std::uint8_t> given_;
};

}  // namespace vernier
