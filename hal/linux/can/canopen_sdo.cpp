// SPDX-License-Identifier: Apache-2.0
#include "hal/linux/can/canopen_sdo.h"

#include <poll.h>
#include <sys/socket.h>
#include <unistd.h>

#include <chrono>
#include <cstdio>

#include "hal/linux/can/can_socket.h"

namespace vernier {
namespace {

constexpr std::uint32_t kRequest = 0x600, kAnswer = 0x580;  // + node
constexpr std::uint8_t kUpload = 0x40, kAbort = 0x80, kExpedited = 0x43, kBytes = 8;
constexpr std::uint16_t kRpdo = 0x1400, kTpdo = 0x1800, kMapping = 0x200, kMostPdos = 8;
constexpr std::uint32_t kIdMask = 0x1fffffff, kPdoOff = 0x80000000;
constexpr std::uint32_t kLastSyncType = 240;  // transmission types up to this one are synchronous
constexpr std::uint32_t kStatusword = 0x60410010, kPositionActual = 0x60640020;

std::string hex(std::uint32_t value, int digits = 4) {
  char text[16];
  std::snprintf(text, sizeof text, "0x%0*X", digits, value);
  return text;
}

std::string name_of(CanopenObject object) {
  char text[16];
  std::snprintf(text, sizeof text, "0x%04X:%02X", object.index, object.subindex);
  return text;
}

}  // namespace

CanopenSdo::CanopenSdo(const std::string& interface, std::uint32_t node, std::string& error)
    : socket_(open_can(interface, {kAnswer + node}, false, error)), node_(node) {}

CanopenSdo::~CanopenSdo() {
  if (socket_ >= 0) ::close(socket_);
}

std::string CanopenSdo::read(CanopenObject object, std::uint32_t& value) {
  can_frame frame{};
  frame.can_id = kRequest + node_;
  frame.can_dlc = kBytes;
  frame.data[0] = kUpload;
  frame.data[1] = static_cast<std::uint8_t>(object.index),
  frame.data[2] = static_cast<std::uint8_t>(object.index >> 8);
  frame.data[3] = object.subindex;
  silent_ = true;
  if (::send(socket_, &frame, sizeof frame, MSG_NOSIGNAL) != static_cast<ssize_t>(sizeof frame))
    return "the bus takes no frame";
  const auto end = std::chrono::steady_clock::now() + std::chrono::milliseconds(kWaitMs);
  for (auto now = std::chrono::steady_clock::now(); now < end; now = std::chrono::steady_clock::now()) {
    pollfd waiting{socket_, POLLIN, 0};
    ::poll(&waiting, 1,
           static_cast<int>(std::chrono::duration_cast<std::chrono::milliseconds>(end - now).count()) + 1);
    can_frame answer{};
    if (::recv(socket_, &answer, sizeof answer, MSG_DONTWAIT) != static_cast<ssize_t>(sizeof answer))
      continue;
    if (answer.can_id != kAnswer + node_ || answer.can_dlc != kBytes) continue;
    if (answer.data[1] != frame.data[1] || answer.data[2] != frame.data[2] || answer.data[3] != frame.data[3])
      continue;
    silent_ = false;
    std::uint32_t content = 0;
    for (int i = 0; i < 4; ++i) content |= static_cast<std::uint32_t>(answer.data[4 + i]) << (8 * i);
    if (answer.data[0] == kAbort) return name_of(object) + " cannot be read (abort " + hex(content, 8) + ")";
    if ((answer.data[0] & kExpedited) != kExpedited) continue;
    const int unused = answer.data[0] >> 2 & 3;
    value = unused == 0 ? content : content & ((1u << (32 - 8 * unused)) - 1);
    return "";
  }
  return "the drive does not answer a request for " + name_of(object);
}

std::string CanopenSdo::check_mapping(const char* name, std::uint16_t communication, std::uint32_t id,
                                      const std::uint32_t* mapped, std::uint8_t count,
                                      std::uint8_t lowest_type) {
  for (std::uint16_t pdo = 0; pdo < kMostPdos; ++pdo) {
    const auto at = static_cast<std::uint16_t>(communication + pdo);
    std::uint32_t value = 0;
    if (const std::string error = read({at, 1}, value); !error.empty()) {
      if (silent_) return error;
      continue;  // a drive may leave numbers out
    }
    if ((value & kIdMask) != id || (value & kPdoOff) != 0) continue;
    if (const std::string error = read({at, 2}, value); !error.empty()) return error;
    if (value < lowest_type || value > kLastSyncType)
      return std::string(name) + " " + hex(at) + ": transmission type " + std::to_string(value) +
             ", needed is 1: with each SYNC";
    const auto map = static_cast<std::uint16_t>(at + kMapping);
    if (const std::string error = read({map, 0}, value); !error.empty()) return error;
    if (value != count)
      return std::string(name) + " " + hex(map) + ": " + std::to_string(value) +
             " mapped objects, needed are " + std::to_string(count);
    for (std::uint8_t i = 0; i < count; ++i) {
      if (const std::string error = read({map, static_cast<std::uint8_t>(i + 1)}, value); !error.empty())
        return error;
      if (value != mapped[i])
        return std::string(name) + " " + hex(map) + ": object " + hex(value, 8) + " is mapped, needed is " +
               hex(mapped[i], 8);
    }
    return "";
  }
  return std::string("no active ") + name + " of the drive has the identifier " + hex(id, 3);
}

std::string CanopenSdo::check_offset(std::uint32_t rpdo, CanopenObject object) {
  const std::uint32_t mapped =
      static_cast<std::uint32_t>(object.index) << 16 | static_cast<std::uint32_t>(object.subindex) << 8 | 32u;
  return check_mapping("RPDO", kRpdo, rpdo, &mapped, 1, 0);
}

std::string CanopenSdo::check_position(std::uint32_t tpdo) {
  const std::uint32_t mapped[] = {kStatusword, kPositionActual};
  return check_mapping("TPDO", kTpdo, tpdo, mapped, 2, 1);
}

}  // namespace vernier
