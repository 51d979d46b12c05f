// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include "firmware/linuxcnc/hatch.h"
#include "hal/command_link.h"

namespace vernier {

/// The part of a link that is in the component. The process vernier-hal serves the link itself.
class HatchLink : public CommandLink {
 public:
  /// `call`: must exist longer than the link. Not real-time safe.
  explicit HatchLink(Call& call) noexcept : call_(call) {}
  HalFault serve(CommandHandler& handler, TimeUs wait) noexcept override;
  /// Returns the access of the link for the waiting request; LinkAccess::kRead if no request is waiting. Not
  /// real-time safe.
  LinkAccess access() const noexcept;

 private:
  Call& call_;
};

/// The part of a link that is in vernier-hal. The link part in vernier-hal passes the requests of the link to
/// the component.
class HatchHandler : public CommandHandler {
 public:
  /// `hatch`, `stop`: must exist longer than the handler. Not real-time safe.
  HatchHandler(Hatch& hatch, LinkAccess access, const std::atomic<bool>& stop) noexcept
      : hatch_(hatch), access_(access), stop_(stop) {}
  void comes_over(std::uint64_t connection) override { connection_ = connection; }
  void ends(std::uint64_t connection) override;
  std::uint32_t answer(const std::uint8_t* request, std::uint32_t size, std::uint8_t* reply) override;
  bool was_signed() const override { return signed_; }
  std::uint32_t ticket() const override { return ticket_; }
  std::uint32_t later(std::uint32_t ticket, std::uint8_t* reply) override;
  void fill_registers(std::uint16_t* values) override;
  CommandGiven give(std::uint16_t command) override;

 private:
  bool ask(LinkCall op, std::uint32_t offset, const std::uint8_t* bytes, std::uint32_t size);

  Hatch& hatch_;
  LinkAccess access_;
  const std::atomic<bool>& stop_;
  std::uint32_t ticket_ = 0;
  std::uint64_t connection_ = 0;
  bool signed_ = false;
};

}  // namespace vernier
