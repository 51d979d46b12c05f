// SPDX-License-Identifier: GPL-3.0-or-later
#include <algorithm>

#include "hal/linux/modbus/modbus_conversation.h"
#include "tables/link_format.h"
#include "tests/fuzz/target.h"

namespace vernier::fuzz {
namespace {

class Echo : public CommandHandler {
 public:
  std::uint32_t answer(const std::uint8_t* request, std::uint32_t size, std::uint8_t* reply) override {
    expect(size <= kMaxRequestBytes + 6, "a request longer than the mailbox");
    if (size > 0 && request[0] == 0xee) return kLater;
    std::copy_n(request, std::min(size, kMaxReplyBytes), reply);
    return std::min(size, kMaxReplyBytes);
  }
  std::uint32_t later(std::uint32_t, std::uint8_t* reply) override {
    std::fill_n(reply, kMaxReplyBytes, std::uint8_t{7});
    return ++asked_ % 3 == 0 ? kMaxReplyBytes : kLater;
  }
  void fill_registers(std::uint16_t* values) override {
    std::fill_n(values, kLiveRegisters, std::uint16_t{1});
  }
  CommandGiven give(std::uint16_t command) override {
    return command >= 8 ? CommandGiven::kRefused : command == 7 ? CommandGiven::kLater : CommandGiven::kTaken;
  }

 private:
  std::uint32_t asked_ = 0;
};

constexpr ModbusLayout kLayout{kMailboxRegister, kMailboxRegisters, kLiveRegisters};

/// First byte: the unit of a serial line, 0 for TCP. Then what comes in at once, in pieces. On a serial line
/// a piece of two bytes at least gets the sum that it needs to be looked at.
void take(Bytes bytes) {
  Pieces pieces(bytes);
  const int unit = pieces.byte() % 3;
  ModbusConversation talk(kLayout, unit, InstantNs(500'000'000));
  Echo handler;
  std::int64_t now = 1'000'000'000;
  talk.begin(InstantNs(now), 1);
  for (Bytes piece; pieces.next(piece);) {
    std::vector<std::uint8_t> line(piece.begin(), piece.end());
    if (unit != 0 && line.size() >= 2) {
      line[0] = static_cast<std::uint8_t>(unit);
      const std::uint16_t sum = modbus_crc(line.data(), static_cast<std::uint32_t>(line.size()));
      line.push_back(static_cast<std::uint8_t>(sum & 0xff));
      line.push_back(static_cast<std::uint8_t>(sum >> 8));
    }
    for (std::size_t at = 0; at < line.size();) {
      const auto fits = std::min<std::size_t>(talk.room(), line.size() - at);
      std::copy_n(line.data() + at, fits, talk.space());
      talk.took(static_cast<std::uint32_t>(fits), InstantNs(now += 1'000'000));
      at += fits;
      talk.work(handler, InstantNs(now));
      expect(talk.waiting() <= ModbusConversation::kMostFrame, "a reply longer than a frame");
      talk.sent(talk.waiting());
      if (talk.broken(InstantNs(now)) && unit == 0) return;
      if (fits == 0) now += 10'000'000;  // a reply that takes its time
    }
    now += 40'000'000;
  }
}

const Registered kTarget("modbus", take);

}  // namespace
}  // namespace vernier::fuzz
