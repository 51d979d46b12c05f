// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <cstdint>

#include "hal/board.h"
#include "tables/checksum.h"

namespace vernier {

/// Ticks that are measured.
constexpr std::uint32_t kTicks = 100'000;

/// Time that passes where the runner waits for it: ticks follow one another without a pause.
class TickClock : public Clock {
 public:
  InstantNs now() noexcept override { return now_; }
  HalFault sleep_until(InstantNs due) noexcept override {
    if (now_ < due) now_ = due;
    return HalFault::kNone;
  }

 private:
  InstantNs now_{1'000'000};
};

/// Two axes that go to and fro at 20 and 7 mm/s between 0 and 180 mm, a sensor at 21 degrees, drives that
/// take what they are given.
class Machine : public AxisReader, public InputReader, public CorrectionWriter {
 public:
  void begin_tick() noexcept override {
    for (int i = 0; i < 2; ++i) {
      position_[i] += sense_[i] * kStep[i];
      since_[i] += kStep[i];
      if (position_[i] >= 0 && position_[i] <= 180'000'000) continue;
      sense_[i] = static_cast<std::int8_t>(-sense_[i]);
      position_[i] += 2 * sense_[i] * kStep[i];
      since_[i] = 0;
    }
  }
  HalFault read_axis(std::uint32_t axis, AxisReading& reading) noexcept override {
    if (axis >= 2) return HalFault::kNoDevice;
    reading.position = AxisPosition(position_[axis]);
    reading.velocity = AxisSpeed(std::int64_t{sense_[axis]} * kStep[axis] * 1000);
    reading.since = AxisTravel(since_[axis]);
    reading.sense = sense_[axis];
    return HalFault::kNone;
  }
  HalFault read_path(PathReading&) noexcept override { return HalFault::kNone; }
  bool gives_motion() const noexcept override { return true; }
  HalFault read_input(std::uint32_t, InputMicro& value) noexcept override {
    value = InputMicro(21'000'000);
    return HalFault::kNone;
  }
  HalFault write_correction(std::uint32_t axis, AxisTravel correction) noexcept override {
    if (axis >= 2) return HalFault::kNoDevice;
    written_[axis] = correction.count;
    return HalFault::kNone;
  }
  std::int64_t position(std::uint32_t axis) const { return position_[axis]; }
  std::int64_t written(std::uint32_t axis) const { return written_[axis]; }
  /// FNV-1a over what the drives hold.
  std::uint64_t mixed(std::uint64_t hash) const {
    for (const std::int64_t counts : written_)
      hash = (hash ^ static_cast<std::uint64_t>(counts)) * 0x100000001b3u;
    return hash;
  }

 private:
  static constexpr std::int64_t kStep[2] = {20'000, 7'000};
  std::int64_t position_[2] = {}, since_[2] = {}, written_[2] = {};
  std::int8_t sense_[2] = {1, 1};
};

}  // namespace vernier
