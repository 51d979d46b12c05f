// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>

#include "comp/quantity.h"
#include "hal/fault.h"

namespace vernier {

/// Result of a command of a Modbus master that uses only registers.
enum class CommandGiven : std::uint8_t {
  kRefused,  // not a command, or it cannot be taken now
  kTaken,
  kLater,  // taken; later() gives one byte, 0 when a start of the board restores its effect
};

/// Answers the requests that a link receives.
class CommandHandler {
 public:
  virtual ~CommandHandler() = default;
  /// Names the connection of the next requests: a number that the link uses for no other connection later. A
  /// link without connections does not call this function. Not real-time safe.
  virtual void comes_over(std::uint64_t connection) { static_cast<void>(connection); }
  /// Reports that a connection has ended. Not real-time safe.
  virtual void ends(std::uint64_t connection) { static_cast<void>(connection); }
  /// answer() returns this value if the reply is delayed because a storage medium is busy.
  static constexpr std::uint32_t kLater = UINT32_MAX;

  /// request: any bytes; reply: room for the longest. answer() returns the bytes of the reply, 0: no reply,
  /// or kLater: the link then calls later() for the reply, and serves other clients meanwhile.
  /// Not real-time safe.
  virtual std::uint32_t answer(const std::uint8_t* request, std::uint32_t size, std::uint8_t* reply) = 0;
  /// True if the request of the last answer() had a valid signature. Not real-time safe.
  virtual bool was_signed() const { return false; }
  /// Argument for later(), valid right after answer() or give() returned kLater. Not real-time safe.
  virtual std::uint32_t ticket() const { return 0; }
  /// Fetches the deferred reply. Returns its bytes, kLater while the reply is being made, 0 if no reply is
  /// pending. Not real-time safe.
  virtual std::uint32_t later(std::uint32_t ticket, std::uint8_t* reply) {
    return static_cast<void>(ticket), static_cast<void>(reply), 0;
  }
  /// The live registers for masters that use registers only. Not real-time safe.
  virtual void fill_registers(std::uint16_t* values) = 0;
  /// Receives a command of a Modbus master that uses only registers. Not real-time safe.
  virtual CommandGiven give(std::uint16_t command) = 0;
};

/// A way in from outside. Runs outside the tick.
class CommandLink {
 public:
  virtual ~CommandLink() = default;
  /// Waits at most `wait` for requests and answers them. This function never waits for a peer that stops
  /// within a request or does not read the reply. kRefused: the connection was lost; this call or the next
  /// call opens it again. An error of the peer is not a fault of the board. Not real-time safe.
  virtual HalFault serve(CommandHandler& handler, TimeUs wait) noexcept = 0;
  /// Handles on which the operating system can wait for a request: at most `room` handles are put into
  /// `handles`. Returns how many; 0 if the link has no handle. Not real-time safe.
  virtual std::uint32_t handles(int* handles, std::uint32_t room) const noexcept {
    return static_cast<void>(handles), static_cast<void>(room), 0;
  }
};

}  // namespace vernier
