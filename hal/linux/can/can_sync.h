// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <memory>
#include <string>

#include "hal/tick_sync.h"

namespace vernier {

/// The sync frame of a CAN bus (SYNC of CiA 301, identifier 0x80). Any CAN frame with the
/// identifier `id` is a sync signal.
class CanSync : public TickSync {
 public:
  /// `interface`: for example "can0"; `id`: 11 bits, or 29 bits if above 0x7ff. If the socket cannot be
  /// opened, open() returns null and sets `error`. Not real-time safe.
  static std::unique_ptr<CanSync> open(const std::string& interface, std::uint32_t id, std::string& error);
  /// Takes ownership of the socket. The socket must preserve the boundaries of frames and must not block. Not
  /// real-time safe.
  explicit CanSync(int socket) : socket_(socket) {}
  ~CanSync() override;
  CanSync(const CanSync&) = delete;
  CanSync& operator=(const CanSync&) = delete;

  HalFault wait_for_sync(InstantNs latest) noexcept override;

 private:
  bool drain() noexcept;
  int socket_;
};

}  // namespace vernier
