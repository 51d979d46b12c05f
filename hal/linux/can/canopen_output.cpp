// SPDX-License-Identifier: Apache-2.0
#include "hal/linux/can/canopen_output.h"

#include <sys/socket.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstdio>

#include "hal/linux/can/can_socket.h"
#include "hal/linux/monotonic_clock.h"

namespace vernier {
namespace {

constexpr TimeUs kListen(100'000);      // for another sender of the RPDO
constexpr TimeUs kPatience(1'500'000);  // until SYNC, heartbeat and TPDO have come
constexpr InstantNs kBetween(2'000'000);

}  // namespace

std::unique_ptr<CanopenOutput> CanopenOutput::open(const CanopenPlace& place, const CanopenSettings& settings,
                                                   const AnalogueScale& scale, std::string& error) {
  const int fd = open_can(
      place.interface, {settings.sync, settings.emergency, settings.heartbeat, settings.tpdo, settings.rpdo},
      true, error);
  if (fd < 0) return nullptr;
  if (!hear_own_frames(fd, place.interface, error)) return nullptr;
  auto output = std::make_unique<CanopenOutput>(fd, place, settings, scale);
  if (!place.test_pdos) return output;
  CanopenSdo sdo(place.interface, place.node, error);
  if (error.empty()) error = sdo.check_offset(settings.rpdo, place.object);
  if (error.empty()) error = sdo.check_position(settings.tpdo);
  std::uint32_t offset = 0;
  if (error.empty()) error = sdo.read(place.object, offset);
  if (!error.empty()) return nullptr;
  output->known_ = true;
  output->before_ = static_cast<std::int32_t>(offset);
  output->drive_.begin_with(output->before_);
  return output;
}

CanopenOutput::CanopenOutput(int socket, const CanopenPlace& place, const CanopenSettings& settings,
                             const AnalogueScale& scale)
    : socket_(socket), place_(place), settings_(settings), converter_(scale), drive_(settings) {}

CanopenOutput::~CanopenOutput() { ::close(socket_); }

/// Takes the frames that are there, without waiting.
void CanopenOutput::drain(InstantNs now) noexcept {
  for (int i = 0; i < kMostFrames; ++i) {
    can_frame frame{};
    const ssize_t got = ::recv(socket_, &frame, sizeof frame, MSG_DONTWAIT);
    if (got < 0 && errno == EINTR) continue;
    if (got <= 0) return;
    if (got == static_cast<ssize_t>(sizeof frame)) drive_.take(frame, now);
  }
}

bool CanopenOutput::send(std::int32_t offset) noexcept {
  can_frame frame{};
  frame.can_id = settings_.rpdo;
  frame.can_dlc = CanopenDrive::kOffsetBytes;
  for (int i = 0; i < CanopenDrive::kOffsetBytes; ++i)
    frame.data[i] = static_cast<std::uint8_t>(static_cast<std::uint32_t>(offset) >> (8 * i));
  return ::send(socket_, &frame, sizeof frame, MSG_DONTWAIT | MSG_NOSIGNAL) ==
         static_cast<ssize_t>(sizeof frame);
}

std::int32_t CanopenOutput::number_of(AxisTravel correction) const noexcept {
  return static_cast<std::int32_t>(converter_.code_for(correction) - converter_.scale().zero);
}

HalFault CanopenOutput::write_correction(std::uint32_t axis, AxisTravel correction) noexcept {
  if (axis != 0) return HalFault::kNoDevice;
  held_at_end_ += converter_.wanted_code(correction) != converter_.code_for(correction) ? 1 : 0;
  const InstantNs now = MonotonicClock().now();
  drain(now);
  const CanopenDrive::Step step = drive_.step(number_of(correction), now);
  if (!step.send) return step.fault;
  if (!send(step.offset)) {
    drive_.not_sent();
    return HalFault::kRefused;
  }
  drive_.sent(step.offset, now);
  return step.fault;
}

AxisTravel CanopenOutput::within_range(std::uint32_t axis, AxisTravel correction) const noexcept {
  if (axis != 0) return AxisTravel{};
  const AnalogueScale& scale = converter_.scale();
  if (!drive_.follows()) return scale.correction_of(scale.zero + drive_.offset());
  const std::int64_t a = scale.correction_of(scale.low).count, b = scale.correction_of(scale.high).count;
  return AxisTravel(std::clamp(correction.count, std::min(a, b), std::max(a, b)));
}

/// Returns what is missing at the end of `time`, or when nothing is missing.
std::string CanopenOutput::listen(TimeUs time, bool until_complete) noexcept {
  MonotonicClock clock;
  const InstantNs end = clock.now() + InstantNs(1000 * time.count);
  const char* missing = "";
  for (InstantNs now = clock.now(); now < end; now = clock.now()) {
    drain(now);
    missing = drive_.missing(now);
    if (until_complete && missing == nullptr) return "";
    clock.sleep_until(now + kBetween);
  }
  return missing == nullptr ? "" : missing;
}

bool CanopenOutput::lock() noexcept {
  listen(kListen, false);
  return drive_.counts().foreign == 0;
}

HalFault CanopenOutput::read_back(std::uint32_t, AxisTravel& correction) noexcept {
  if (!known_) return HalFault::kNoReading;
  const AnalogueScale& scale = converter_.scale();
  correction = scale.correction_of(scale.zero + before_);
  return HalFault::kNone;
}

std::string CanopenOutput::attempt(std::uint32_t) { return listen(kPatience, true); }

std::string CanopenOutput::trial() const { return "no offset was sent"; }

std::string CanopenOutput::account() const {
  const CanopenCounts& c = drive_.counts();
  char text[360];
  std::snprintf(
      text, sizeof text,
      "canopen %s node %u: %llu SYNC, %llu positions, %llu offsets sent, %llu not taken by the bus, %llu "
      "losses, %llu emergencies (last 0x%04X), %llu malformed, %llu of another sender, %llu times bus "
      "off; %llu ticks without Operation enabled",
      place_.interface.c_str(), place_.node, static_cast<unsigned long long>(c.syncs),
      static_cast<unsigned long long>(c.positions), static_cast<unsigned long long>(c.offsets),
      static_cast<unsigned long long>(c.refused), static_cast<unsigned long long>(c.losses),
      static_cast<unsigned long long>(c.emergencies), c.last_emergency,
      static_cast<unsigned long long>(c.malformed), static_cast<unsigned long long>(c.foreign),
      static_cast<unsigned long long>(c.bus_errors), static_cast<unsigned long long>(c.not_enabled));
  return text;
}

}  // namespace vernier
