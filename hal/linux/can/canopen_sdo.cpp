// SPDX-License-Identifier: Apache-2.0
#include "hal/linux/can/canopen_sdo.h"

#include <poll.h>
#include <sys/socket.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <cstdio>

#include "hal/linux/can/can_socket.h"

namespace vernier {
namespace {

constexpr std::uint32_t kRequest = 0x600, kAnswer = 0x580;  // + node
constexpr std::uint8_t kUpload = 0x40, kAbort = 0x80, kExpedited = 0x43, kBytes = 8;
constexpr std::uint16_t kRpdo = 0x1400, kTpdo = 0x1800, kMapping = 0x200, kMostPdos = 8;
constexpr std::uint32_t kIdMask = 0x1fffffff, kExtended = 0x20000000, kPdoOff = 0x80000000;
constexpr std::uint32_t kLastSyncType = 240;  // transmission types up to this one are synchronous
constexpr std::uint32_t kMostMapped = 64;
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
    return "the bus accepts no frame";
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

/// Finds the PDO with this identifier. Empty, or how it differs from `pdo`.
std::string CanopenSdo::check_mapping(const Pdo& pdo) {
  bool found = false;
  std::string elsewhere;
  for (std::uint16_t number = 0; number < kMostPdos; ++number) {
    const auto at = static_cast<std::uint16_t>(pdo.communication + number);
    std::uint32_t id = 0;
    if (const std::string error = read({at, 1}, id); !error.empty()) {
      if (silent_) return error;
      continue;  // a drive may leave numbers out
    }
    if ((id & kPdoOff) != 0) continue;
    std::string error;
    if ((id & kIdMask) != pdo.id) {
      if (pdo.is_alone && elsewhere.empty()) elsewhere = check_other(pdo, at);
      if (silent_) error = elsewhere;
    } else if ((id & kExtended) != 0) {
      error = std::string(pdo.name) + " " + hex(at) + ": the identifier " + hex(pdo.id, 3) +
              " has 29 bits, but 11 bits are required";
    } else if (found) {
      error = std::string("the drive has two active ") + pdo.name + "s with the identifier " + hex(pdo.id, 3);
    } else {
      error = check_contents(pdo, at);
      found = true;
    }
    if (!error.empty()) return error;
  }
  return found
             ? elsewhere
             : std::string("the drive has no active ") + pdo.name + " with the identifier " + hex(pdo.id, 3);
}

std::string CanopenSdo::check_contents(const Pdo& pdo, std::uint16_t at) {
  std::uint32_t value = 0;
  if (const std::string error = read({at, 2}, value); !error.empty()) return error;
  if (value < pdo.first_type || value > pdo.last_type)
    return std::string(pdo.name) + " " + hex(at) + ": transmission type " + std::to_string(value) +
           ", but the required type is 1: with each SYNC";
  const auto map = static_cast<std::uint16_t>(at + kMapping);
  if (const std::string error = read({map, 0}, value); !error.empty()) return error;
  if (value != pdo.mapped.size())
    return std::string(pdo.name) + " " + hex(map) + ": " + std::to_string(value) +
           " mapped objects, but the required number is " + std::to_string(pdo.mapped.size());
  for (std::size_t i = 0; i < pdo.mapped.size(); ++i) {
    if (const std::string error = read({map, static_cast<std::uint8_t>(i + 1)}, value); !error.empty())
      return error;
    if (value != pdo.mapped[i])
      return std::string(pdo.name) + " " + hex(map) + ": object " + hex(value, 8) +
             " is mapped, but the required object is " + hex(pdo.mapped[i], 8);
  }
  return "";
}

/// Another PDO must not write the objects of `pdo`. An entry that cannot be read is none.
std::string CanopenSdo::check_other(const Pdo& pdo, std::uint16_t at) {
  const auto map = static_cast<std::uint16_t>(at + kMapping);
  std::uint32_t count = 0, value = 0;
  if (const std::string error = read({map, 0}, count); !error.empty()) return silent_ ? error : "";
  for (std::uint32_t i = 1; i <= std::min(count, kMostMapped); ++i) {
    if (const std::string error = read({map, static_cast<std::uint8_t>(i)}, value); !error.empty())
      return silent_ ? error : "";
    for (const std::uint32_t own : pdo.mapped)
      if (value >> 8 == own >> 8)
        return std::string(pdo.name) + " " + hex(map) + ": object " + hex(value, 8) +
               " is also mapped in this PDO; only the PDO of the board may contain this object";
  }
  return "";
}

std::string CanopenSdo::check_offset(std::uint32_t rpdo, CanopenObject object) {
  const std::uint32_t mapped =
      static_cast<std::uint32_t>(object.index) << 16 | static_cast<std::uint32_t>(object.subindex) << 8 | 32u;
  // Each synchronous type of an RPDO means: in use with the next SYNC (CiA 301, object 0x1400).
  return check_mapping({"RPDO", kRpdo, rpdo, {mapped}, 0, kLastSyncType, true});
}

std::string CanopenSdo::check_position(std::uint32_t tpdo) {
  return check_mapping({"TPDO", kTpdo, tpdo, {kStatusword, kPositionActual}, 1, 1, false});
}

}  // namespace vernier
