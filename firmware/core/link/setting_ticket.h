// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>

#include "tables/link_format.h"

namespace vernier {

/// A ticket for a reply that is sent after a setting of the operator is stored. The ticket contains the
/// values that the reply repeats, and the tick after which the stored state contains the setting. The ticket
/// belongs to CommandHandler. Any number of clients can wait for delayed replies.
struct SettingTicket {
  std::uint8_t op = 0;        // kCommand, kWeight or kSigned; 0: a Modbus master that uses only registers,
                              // whose reply has no head
  std::uint8_t sequence = 0;  // sequence number of the request
  std::uint32_t ticks = 0;    // low bits of Exchange::ticks.count() at the tick

  static constexpr std::uint32_t kMark = 1u << 31;  // bit of a SettingTicket; no ticket of StoreDesk has this
                                                    // bit
  static constexpr std::uint32_t kTickBits = 21, kTickMask = (1u << kTickBits) - 1;

  static bool is_one(std::uint32_t ticket) noexcept { return (ticket & kMark) != 0; }
  std::uint32_t packed() const noexcept {
    return kMark | code_of(op) << 29 | std::uint32_t{sequence} << kTickBits | (ticks & kTickMask);
  }
  /// `now`: number of ticks until now. The tick of the ticket is at most two ticks after `now`, and at most
  /// 2^21 ticks before `now`.
  static SettingTicket unpacked(std::uint32_t ticket, std::uint32_t now) noexcept {
    constexpr std::uint8_t kOps[] = {0, static_cast<std::uint8_t>(LinkOp::kCommand),
                                     static_cast<std::uint8_t>(LinkOp::kWeight),
                                     static_cast<std::uint8_t>(LinkOp::kSigned)};
    const std::uint32_t latest = now + 2;
    return {kOps[ticket >> 29 & 3], static_cast<std::uint8_t>(ticket >> kTickBits),
            latest - ((latest - ticket) & kTickMask)};
  }
  /// True if the tick number `by` (32 bits, which wrap) is that of the ticket or later.
  bool reached_by(std::uint32_t by) const noexcept { return static_cast<std::int32_t>(by - ticks) >= 0; }

 private:
  static std::uint32_t code_of(std::uint8_t op) noexcept {
    switch (static_cast<LinkOp>(op)) {
      case LinkOp::kCommand:
        return 1;
      case LinkOp::kWeight:
        return 2;
      case LinkOp::kSigned:
        return 3;
      default:
        return 0;
    }
  }
};

}  // namespace vernier
