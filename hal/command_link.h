// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>

#include "comp/quantity.h"
#include "hal/fault.h"

namespace vernier {

/// Result of a command of a Modbus master that uses only registers.
enum class CommandGiven : std::uint8_t {
  kRefused,  // the value is not a command, or the command is not possible now
  kTaken,
  kLater,  // the command is accepted; later() returns one byte, which is 0 if a start of the board restores
           // the effect of the command
};

/// Answers the requests that a link receives.
class CommandHandler {
 public:
  virtual ~CommandHandler() = default;
  /// Sets the number of the connection over which the following requests come. A link uses each
  /// connection number only once. A link without connections does not call comes_over(). Not
  /// real-time safe.
  virtual void comes_over(std::uint64_t connection) { static_cast<void>(connection); }
  /// Reports that a connection has ended. Not real-time safe.
  virtual void ends(std::uint64_t connection) { static_cast<void>(connection); }
  /// answer() returns this value if the reply is delayed because a storage medium is busy.
  static constexpr std::uint32_t kLater = UINT32_MAX;

  /// `request`: any bytes; `reply`: memory for the longest reply. answer() returns the number of bytes in the
  /// reply, 0 for no reply, or kLater. After kLater the link calls later() for the reply, and serves other
  /// clients until then. Not real-time safe.
  virtual std::uint32_t answer(const std::uint8_t* request, std::uint32_t size, std::uint8_t* reply) = 0;
  /// True if the request of the last answer() had a valid signature. Not real-time safe.
  virtual bool was_signed() const { return false; }
  /// Returns the argument for later(). The argument for later() is valid directly after answer() or give()
  /// returned kLater. Not real-time safe.
  virtual std::uint32_t ticket() const { return 0; }
  /// Returns a delayed reply. The function later() returns the number of bytes in the reply, kLater while the
  /// reply is not ready, or 0 if no reply is delayed. Not real-time safe.
  virtual std::uint32_t later(std::uint32_t ticket, std::uint8_t* reply) {
    return static_cast<void>(ticket), static_cast<void>(reply), 0;
  }
  /// Writes the live registers for Modbus masters that use only registers. Not real-time safe.
  virtual void fill_registers(std::uint16_t* values) = 0;
  /// Executes a command from a Modbus master that uses only registers. Not real-time safe.
  virtual CommandGiven give(std::uint16_t command) = 0;
};

/// A link over which requests from outside reach the board. A CommandLink runs outside the tick.
class CommandLink {
 public:
  virtual ~CommandLink() = default;
  /// Waits for requests for at most `wait`, and answers them. serve() never waits for a peer that stops
  /// within a request or does not read the reply. The function serve() returns kRefused if the connection was
  /// lost. The same call of serve() that lost the connection, or the next call, opens the
  /// connection again. An error of the peer (client) is not a fault of the board. Not real-time
  /// safe.
  virtual HalFault serve(CommandHandler& handler, TimeUs wait) noexcept = 0;
  /// Writes the handles on which the operating system can wait for a request to `handles`, at most `room`
  /// handles. handles() returns the number of handles; 0 if the link has no handle. Not real-time safe.
  virtual std::uint32_t handles(int* handles, std::uint32_t room) const noexcept {
    return static_cast<void>(handles), static_cast<void>(room), 0;
  }
};

}  // namespace vernier
