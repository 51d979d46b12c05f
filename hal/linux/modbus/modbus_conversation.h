// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>

#include "hal/clock.h"
#include "hal/command_link.h"

namespace vernier {

/// Layout of the Modbus register map of the board. The client writes a request (function 16) to the mailbox,
/// which is the holding registers from `mailbox` on. The request has its length in bytes first, and then its
/// bytes, high byte first. The reply is in the input registers at the address of the mailbox, separately for
/// each client. The input registers from 0 contain the live state. The holding register 0 receives commands
/// (function 6).
struct ModbusLayout {
  int mailbox = 0, mailbox_registers = 0, live_registers = 0;
};

/// Conversation with one Modbus client, from the side of the server. The conversation processes bytes, uses
/// no device and never waits. The conversation has one buffer for each direction. While a reply is not ready
/// or is not completely sent, the conversation accepts no further bytes. The functions 3, 4, 6 and 16 are
/// supported. Any other function is refused with the exception of the standard (Modbus Application Protocol
/// V1.1b3; Modbus over Serial Line V1.02 for the frames of RTU).
class ModbusConversation {
 public:
  static constexpr std::uint32_t kMostFrame = 260;           // 7 bytes of MBAP and 253 bytes of a request
  static constexpr std::uint32_t kMostMailbox = 123;         // number of registers
  static constexpr std::uint32_t kMostLive = 125;            // number of registers
  static constexpr InstantNs kReplyDeadline{1'000'000'000};  // longest time for a peer to read its reply

  /// `unit`: address on a serial line, 1..247; 0: TCP, where any unit is accepted. `frame_time`: longest time
  /// for a whole request, beginning with its first byte. Not real-time safe.
  ModbusConversation(const ModbusLayout& layout, int unit, InstantNs frame_time) noexcept
      : layout_(layout), unit_(unit), frame_time_(frame_time) {}

  /// Sets the time of the last request to `when`. `connection`: number for CommandHandler::comes_over.
  void begin(InstantNs when, std::uint64_t connection) noexcept {
    last_request_ = when, connection_ = connection;
  }
  std::uint64_t connection() const noexcept { return connection_; }

  /// Returns the memory for received bytes; room() is the number of bytes for which there is space.
  std::uint8_t* space() noexcept { return in_ + used_; }
  std::uint32_t room() const noexcept { return busy() ? 0 : kMostFrame - used_; }
  /// Informs the conversation that `bytes` bytes were written to space().
  void took(std::uint32_t bytes, InstantNs now) noexcept;

  /// Answers the request if it is complete, or continues with a request whose reply takes time.
  void work(CommandHandler& handler, InstantNs now) noexcept;

  /// out() returns the bytes to send, and waiting() returns their number. The caller gives the number of
  /// bytes that were sent to sent().
  const std::uint8_t* out() const noexcept { return out_ + sent_; }
  std::uint32_t waiting() const noexcept { return out_size_ - sent_; }
  void sent(std::uint32_t bytes) noexcept;

  /// True if the peer sent a wrong length, is too slow, or does not read its reply. A TCP
  /// connection with a failed conversation must be closed. After a failure on a serial line, the
  /// conversation continues and the received bytes are discarded.
  bool broken(InstantNs now) noexcept;
  /// True if the client has not yet read its reply.
  bool has_reply() const noexcept { return waiting() > 0; }
  /// True if a request of the client waits for the medium (storage).
  bool waits_for_medium() const noexcept { return waits_for_reply_; }
  /// True if a request of the client had a valid signature.
  bool is_signed() const noexcept { return signed_; }
  InstantNs last_request() const noexcept { return last_request_; }

 private:
  bool tcp() const noexcept { return unit_ == 0; }
  bool busy() const noexcept { return waiting() > 0 || waits_for_reply_; }
  std::uint32_t frame_size() noexcept;
  void respond(CommandHandler& handler, const std::uint8_t* pdu, std::uint32_t size) noexcept;
  void answer_frame(CommandHandler& handler, std::uint32_t size, InstantNs now) noexcept;
  void confirm_command(std::uint8_t not_stored) noexcept;
  void open_mailbox(CommandHandler& handler, const std::uint8_t* bytes, std::uint32_t size) noexcept;
  void read_registers(CommandHandler& handler, std::uint8_t function, int address, int count) noexcept;
  void refuse(std::uint8_t function, std::uint8_t code) noexcept;
  void put(std::uint8_t byte) noexcept { out_[out_size_++] = byte; }
  void begin_reply(const std::uint8_t* frame) noexcept;
  void end_reply(InstantNs now) noexcept;
  void drop(std::uint32_t bytes) noexcept;

  ModbusLayout layout_;
  int unit_;
  std::uint64_t connection_ = 0;
  InstantNs frame_time_, frame_began_, reply_began_, last_request_, last_byte_;
  std::uint8_t in_[kMostFrame] = {}, out_[kMostFrame] = {};
  std::uint32_t used_ = 0, out_size_ = 0, sent_ = 0;
  std::uint8_t mailbox_[2 * kMostMailbox] = {};  // bytes that the peer wrote to the mailbox
  std::uint8_t reply_[256] = {};
  std::uint32_t reply_size_ = 0, ticket_ = 0, command_size_ = 0;
  bool waits_for_reply_ = false, senseless_ = false, signed_ = false;
  bool of_command_ = false;  // true: the delayed reply confirms the write of a command
};

/// Returns the CRC of a Modbus RTU frame (Modbus over Serial Line V1.02, 6.2.2).
std::uint16_t modbus_crc(const std::uint8_t* bytes, std::uint32_t size) noexcept;

}  // namespace vernier
