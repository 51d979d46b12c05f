// SPDX-License-Identifier: GPL-3.0-or-later
#include "firmware/linuxcnc/hatch_link.h"

#include <algorithm>
#include <cstring>

#include "tables/link_format.h"

namespace vernier {

LinkAccess HatchLink::access() const noexcept {
  return is_asked(call_) && call_.place <= static_cast<std::uint32_t>(LinkAccess::kUpload)
             ? static_cast<LinkAccess>(call_.place)
             : LinkAccess::kRead;
}

HalFault HatchLink::serve(CommandHandler& handler, TimeUs wait) noexcept {
  if (!wait_for_call(call_, wait)) return HalFault::kNone;
  std::uint8_t reply[kMaxReplyBytes] = {};
  std::uint16_t values[kLiveRegisters] = {};
  std::uint32_t size = 0;
  switch (static_cast<LinkCall>(call_.op)) {
    case LinkCall::kAnswer:
      handler.comes_over(call_.connection);
      size = handler.answer(call_.bytes, std::min(call_.size, Call::kMostBytes), reply);
      if (size == CommandHandler::kLater) call_.offset = handler.ticket();
      call_.result = handler.was_signed() ? 1 : 0;
      break;
    case LinkCall::kLater:
      size = handler.later(call_.offset, reply);
      break;
    case LinkCall::kRegisters:
      handler.fill_registers(values);
      std::memcpy(call_.bytes, values, sizeof(values));
      break;
    case LinkCall::kCommand:
      call_.result = static_cast<int>(handler.give(static_cast<std::uint16_t>(call_.offset)));
      call_.offset = handler.ticket();
      break;
    case LinkCall::kEnds:
      handler.ends(call_.connection);
      break;
  }
  call_.size = size;
  if (size <= sizeof(reply)) std::copy_n(reply, size, call_.bytes);
  answer_call(call_);
  return HalFault::kNone;
}

bool HatchHandler::ask(LinkCall op, std::uint32_t offset, const std::uint8_t* bytes, std::uint32_t size) {
  Call& link = hatch_.link;
  link.op = static_cast<std::uint32_t>(op);
  link.place = static_cast<std::uint32_t>(access_);
  link.offset = offset, link.size = size, link.result = 0, link.connection = connection_;
  std::copy_n(bytes, size, link.bytes);
  return make_call(link, hatch_.component, stop_);
}

std::uint32_t HatchHandler::answer(const std::uint8_t* request, std::uint32_t size, std::uint8_t* reply) {
  signed_ = false;
  if (size > Call::kMostBytes || !ask(LinkCall::kAnswer, 0, request, size)) return 0;
  signed_ = hatch_.link.result == 1;
  if (hatch_.link.size == kLater) return ticket_ = hatch_.link.offset, kLater;
  std::copy_n(hatch_.link.bytes, std::min(hatch_.link.size, kMaxReplyBytes), reply);
  return hatch_.link.size;
}

std::uint32_t HatchHandler::later(std::uint32_t ticket, std::uint8_t* reply) {
  if (!ask(LinkCall::kLater, ticket, nullptr, 0)) return 0;
  if (hatch_.link.size == kLater) return kLater;
  std::copy_n(hatch_.link.bytes, std::min(hatch_.link.size, kMaxReplyBytes), reply);
  return hatch_.link.size;
}

void HatchHandler::fill_registers(std::uint16_t* values) {
  std::fill_n(values, int{kLiveRegisters}, std::uint16_t{0});
  if (ask(LinkCall::kRegisters, 0, nullptr, 0))
    std::memcpy(values, hatch_.link.bytes, kLiveRegisters * sizeof(std::uint16_t));
}

void HatchHandler::ends(std::uint64_t connection) {
  connection_ = connection;
  ask(LinkCall::kEnds, 0, nullptr, 0);
}

CommandGiven HatchHandler::give(std::uint16_t command) {
  if (!ask(LinkCall::kCommand, command, nullptr, 0)) return CommandGiven::kRefused;
  ticket_ = hatch_.link.offset;
  const auto given = static_cast<CommandGiven>(hatch_.link.result);
  return given == CommandGiven::kTaken || given == CommandGiven::kLater ? given : CommandGiven::kRefused;
}

}  // namespace vernier
