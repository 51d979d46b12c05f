// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <memory>
#include <string>

#include "hal/command_link.h"

namespace vernier {

/// Transmits requests and replies as ISO 15765-2 messages on a CAN interface, with the protocol of the
/// kernel.
class IsotpLink : public CommandLink {
 public:
  /// `interface`: for example "can0"; `receive`, `transmit`: identifiers of 11 bits, or of 29 bits if above
  /// 0x7ff. If the kernel refuses, open() returns null and sets `error`. Not real-time safe.
  static std::unique_ptr<IsotpLink> open(const std::string& interface, std::uint32_t receive,
                                         std::uint32_t transmit, std::string& error);
  ~IsotpLink() override;
  IsotpLink(const IsotpLink&) = delete;
  IsotpLink& operator=(const IsotpLink&) = delete;

  HalFault serve(CommandHandler& handler, TimeUs wait) noexcept override;
  std::uint32_t handles(int* handles, std::uint32_t room) const noexcept override {
    if (room == 0 || waits_for_reply_) return 0;
    handles[0] = fd_;
    return 1;
  }

  /// Sends a request as the client of an ISO-TP link, and waits for the reply. The function ask() returns the
  /// number of bytes in the reply; -1 with errno set if no reply came. Not real-time safe.
  int ask(const std::uint8_t* request, std::uint32_t size, std::uint8_t* reply, std::uint32_t room,
          TimeUs wait) noexcept;

 private:
  explicit IsotpLink(int fd) : fd_(fd) {}
  HalFault send(const std::uint8_t* reply, std::uint32_t size) noexcept;

  int fd_;
  std::uint32_t ticket_ = 0;
  bool waits_for_reply_ = false;
};

}  // namespace vernier
