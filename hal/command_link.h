// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>

#include "comp/quantity.h"
#include "hal/fault.h"

namespace vernier {

/// What answers the requests that a link brings in.
class CommandHandler {
 public:
  virtual ~CommandHandler() = default;
  /// The connection of the next requests: a number that the link uses for no other connection later. A link
  /// without connections does not call it. setup.
  virtual void comes_over(std::uint64_t connection) { static_cast<void>(connection); }
  /// That connection has ended. setup.
  virtual void ends(std::uint64_t connection) { static_cast<void>(connection); }
  /// A reply that takes its time: a medium is at work.
  static constexpr std::uint32_t kLater = UINT32_MAX;

  /// request: any bytes; reply: room for the longest. Returns the bytes of the reply, 0: no reply, or kLater:
  /// the link calls later() for it, and serves others meanwhile. setup.
  virtual std::uint32_t answer(const std::uint8_t* request, std::uint32_t size, std::uint8_t* reply) = 0;
  /// True if the request of the last answer() had a valid signature. setup.
  virtual bool was_signed() const { return false; }
  /// Argument for later(), valid right after answer() returned kLater. setup.
  virtual std::uint32_t ticket() const { return 0; }
  /// The deferred reply: its bytes, kLater while it is being made, 0 if no reply is pending. setup.
  virtual std::uint32_t later(std::uint32_t ticket, std::uint8_t* reply) {
    return static_cast<void>(ticket), static_cast<void>(reply), 0;
  }
  /// The live registers for masters that use registers only. setup.
  virtual void fill_registers(std::uint16_t* values) = 0;
  /// A command from such a master: false if it is not a command, or cannot be taken now. setup.
  virtual bool give(std::uint16_t command) = 0;
};

/// A way in from outside. Runs outside the tick.
class CommandLink {
 public:
  virtual ~CommandLink() = default;
  /// Waits at most `wait` for requests and answers those that came; never for a peer that stops in the middle
  /// of one, or does not take its reply. kRefused: the link is broken and has been taken up again, or will be
  /// at the next call; a peer that misbehaves is no fault. setup.
  virtual HalFault serve(CommandHandler& handler, TimeUs wait) noexcept = 0;
  /// Handles on which the operating system can wait for a request: at most `room` handles are put into
  /// `handles`. Returns how many; 0 if the link has no handle. setup.
  virtual std::uint32_t handles(int* handles, std::uint32_t room) const noexcept {
    return static_cast<void>(handles), static_cast<void>(room), 0;
  }
};

}  // namespace vernier
