// SPDX-License-Identifier: Apache-2.0
#include "hal/linux/modbus/modbus_conversation.h"

#include <algorithm>
#include <cstring>

namespace vernier {
namespace {

constexpr std::uint8_t kReadHolding = 3, kReadInput = 4, kWriteOne = 6, kWriteMany = 16;
constexpr std::uint8_t kIllegalFunction = 1, kIllegalAddress = 2, kIllegalValue = 3, kDeviceFailure = 4;
constexpr std::uint32_t kTcpHeader = 7, kRtuHeader = 1, kCrc = 2;
constexpr int kMostRead = 125;
// A serial line that was quiet for so long begins a new frame; drivers hold bytes back for up to 16 ms.
constexpr InstantNs kSilence(50'000'000);

int word_at(const std::uint8_t* bytes) { return bytes[0] << 8 | bytes[1]; }

}  // namespace

std::uint16_t modbus_crc(const std::uint8_t* bytes, std::uint32_t size) noexcept {
  std::uint32_t crc = 0xffff;
  for (std::uint32_t i = 0; i < size; ++i) {
    crc ^= bytes[i];
    for (int bit = 0; bit < 8; ++bit) crc = (crc & 1) != 0 ? crc >> 1 ^ 0xa001 : crc >> 1;
  }
  return static_cast<std::uint16_t>(crc);
}

void ModbusConversation::took(std::uint32_t bytes, InstantNs now) noexcept {
  if (bytes == 0) return;
  if (!tcp() && now - last_byte_ > kSilence) {
    // The previous bytes are not complete: the new bytes are a separate frame.
    std::memmove(in_, in_ + used_, bytes);
    used_ = 0;
    senseless_ = false;
  }
  last_byte_ = now;
  if (used_ == 0) frame_began_ = now;
  used_ += bytes;
}

void ModbusConversation::drop(std::uint32_t bytes) noexcept {
  std::memmove(in_, in_ + bytes, used_ - bytes);
  used_ -= bytes;
}

// Bytes of the first frame, 0 while it is not known or not all there.
std::uint32_t ModbusConversation::frame_size() noexcept {
  std::uint32_t size = 0;
  if (tcp()) {
    if (used_ < kTcpHeader + 1) return 0;
    const int length = word_at(in_ + 4);  // of unit and request
    senseless_ = senseless_ || word_at(in_ + 2) != 0 || length < 2 || length > 254;
    size = 6 + static_cast<std::uint32_t>(length);
  } else {
    if (used_ < 7) return 0;
    // Functions that are not ours have lengths that are not known: they end with silence.
    const std::uint8_t function = in_[1];
    senseless_ = senseless_ || (function != kReadHolding && function != kReadInput && function != kWriteOne &&
                                function != kWriteMany);
    size = function == kWriteMany ? 9u + in_[6] : 8u;
  }
  return senseless_ || size > used_ ? 0 : size;
}

void ModbusConversation::begin_reply(const std::uint8_t* frame) noexcept {
  out_size_ = sent_ = 0;
  const std::uint32_t header = tcp() ? kTcpHeader : kRtuHeader;
  std::memcpy(out_, frame, header);
  out_size_ = header;
}

void ModbusConversation::end_reply(InstantNs now) noexcept {
  reply_began_ = now;
  if (tcp()) {
    const std::uint32_t length = out_size_ - 6;
    out_[4] = static_cast<std::uint8_t>(length >> 8), out_[5] = static_cast<std::uint8_t>(length);
    return;
  }
  const std::uint16_t crc = modbus_crc(out_, out_size_);
  put(static_cast<std::uint8_t>(crc)), put(static_cast<std::uint8_t>(crc >> 8));
}

void ModbusConversation::refuse(std::uint8_t function, std::uint8_t code) noexcept {
  put(static_cast<std::uint8_t>(function | 0x80));
  put(code);
}

void ModbusConversation::read_registers(CommandHandler& handler, std::uint8_t function, int address,
                                        int count) noexcept {
  const int end = layout_.mailbox + layout_.mailbox_registers;
  if (count < 1 || count > kMostRead) return refuse(function, kIllegalValue);
  if (address + count > end) return refuse(function, kIllegalAddress);
  std::uint16_t live[kMostLive] = {};
  if (function == kReadInput && address < layout_.live_registers) handler.fill_registers(live);
  put(function);
  put(static_cast<std::uint8_t>(2 * count));
  for (int i = address; i < address + count; ++i) {
    int value = i < layout_.live_registers ? live[i] : 0;
    const int byte = 2 * (i - layout_.mailbox);
    if (function == kReadHolding) value = byte >= 0 ? word_at(mailbox_ + byte) : 0;
    if (function == kReadInput && byte == 0) value = static_cast<int>(reply_size_);
    if (function == kReadInput && byte > 0) value = word_at(reply_ + byte - 2);
    put(static_cast<std::uint8_t>(value >> 8));
    put(static_cast<std::uint8_t>(value));
  }
}

void ModbusConversation::open_mailbox(CommandHandler& handler, const std::uint8_t* bytes,
                                      std::uint32_t size) noexcept {
  std::memcpy(mailbox_, bytes, size);
  std::memset(reply_, 0, sizeof(reply_));
  reply_size_ = 0;
  const auto request = static_cast<std::uint32_t>(word_at(mailbox_));
  if (request > size - 2) return;
  handler.comes_over(connection_);
  const std::uint32_t answered = handler.answer(mailbox_ + 2, request, reply_);
  signed_ = signed_ || handler.was_signed();
  waits_for_reply_ = answered == CommandHandler::kLater;
  if (waits_for_reply_)
    ticket_ = handler.ticket();
  else
    reply_size_ = std::min(answered, 2 * static_cast<std::uint32_t>(layout_.mailbox_registers - 1));
}

void ModbusConversation::respond(CommandHandler& handler, const std::uint8_t* pdu,
                                 std::uint32_t size) noexcept {
  const std::uint8_t function = pdu[0];
  const bool known =
      function == kReadHolding || function == kReadInput || function == kWriteOne || function == kWriteMany;
  if (!known) return refuse(function, kIllegalFunction);
  if (size < 5) return refuse(function, kIllegalValue);
  const int address = word_at(pdu + 1), count = word_at(pdu + 3);
  if (function == kReadHolding || function == kReadInput)
    return read_registers(handler, function, address, count);
  if (function == kWriteOne) {
    if (address != 0) return refuse(function, kIllegalAddress);
    const CommandGiven given = handler.give(static_cast<std::uint16_t>(count));
    if (given == CommandGiven::kRefused) return refuse(function, kIllegalValue);
    if (given == CommandGiven::kLater) {
      waits_for_reply_ = of_command_ = true;
      ticket_ = handler.ticket();
      return;
    }
  } else {
    if (address != layout_.mailbox || count < 2 || count > layout_.mailbox_registers)
      return refuse(function, kIllegalAddress);
    const auto bytes = 2 * static_cast<std::uint32_t>(count);
    if (size < 6 + bytes || pdu[5] != bytes) return refuse(function, kIllegalValue);
    open_mailbox(handler, pdu + 6, bytes);
  }
  for (int i = 0; i < 5; ++i) put(pdu[i]);
}

/// The frame of the command is still the first one in in_.
void ModbusConversation::confirm_command(std::uint8_t not_stored) noexcept {
  const std::uint8_t* const pdu = in_ + (tcp() ? kTcpHeader : kRtuHeader);
  begin_reply(in_);
  if (not_stored != 0) return refuse(pdu[0], kDeviceFailure);
  for (int i = 0; i < 5; ++i) put(pdu[i]);
}

void ModbusConversation::answer_frame(CommandHandler& handler, std::uint32_t size, InstantNs now) noexcept {
  const std::uint32_t header = tcp() ? kTcpHeader : kRtuHeader, trailer = tcp() ? 0 : kCrc;
  begin_reply(in_);
  respond(handler, in_ + header, size - header - trailer);
  if (of_command_)
    out_size_ = 0;
  else
    end_reply(now);
}

void ModbusConversation::work(CommandHandler& handler, InstantNs now) noexcept {
  if (waits_for_reply_ && of_command_) {
    std::uint8_t reply[sizeof(reply_)] = {};
    const std::uint32_t answered = handler.later(ticket_, reply);
    if (answered == CommandHandler::kLater) return;
    waits_for_reply_ = of_command_ = false;
    confirm_command(answered == 1 ? reply[0] : 1);
    end_reply(now);
    drop(command_size_);
    frame_began_ = now;
    return;
  }
  if (waits_for_reply_) {
    const std::uint32_t answered = handler.later(ticket_, reply_);
    if (answered == CommandHandler::kLater) return;
    waits_for_reply_ = false;
    frame_began_ = now;
    reply_size_ = std::min(answered, 2 * static_cast<std::uint32_t>(layout_.mailbox_registers - 1));
  }
  if (waiting() > 0) return;
  const std::uint32_t size = frame_size();
  if (size == 0) return;
  const bool whole = tcp() || (in_[size - 2] | in_[size - 1] << 8) == modbus_crc(in_, size - kCrc);
  if (!whole) {
    senseless_ = true;
    return;
  }
  last_request_ = now;
  if (tcp() || in_[0] == unit_) answer_frame(handler, size, now);
  if (of_command_) {
    command_size_ = size;
    return;
  }
  drop(size);
  frame_began_ = now;
}

void ModbusConversation::sent(std::uint32_t bytes) noexcept {
  sent_ += std::min(bytes, waiting());
  if (sent_ == out_size_) sent_ = out_size_ = 0;
}

bool ModbusConversation::broken(InstantNs now) noexcept {
  if (waiting() > 0 && now - reply_began_ > kReplyDeadline) {
    sent_ = out_size_ = 0;
    return tcp();
  }
  const bool late = used_ > 0 && !busy() && now - frame_began_ > frame_time_;
  if (!late && !senseless_) return false;
  if (tcp()) return true;
  // The rest of an invalid frame is discarded, until the line is quiet.
  used_ = 0;
  senseless_ = now - last_byte_ <= kSilence;
  return false;
}

}  // namespace vernier
