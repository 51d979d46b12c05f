// SPDX-License-Identifier: GPL-3.0-or-later
// The invariant of the slew limit: whatever the devices say and the operator asks, what a drive holds changes
// by at most its slew limit a tick.
#include <gtest/gtest.h>

#include <cstdio>
#include <cstdlib>
#include <memory>
#include <random>

#include "firmware/core/cycle/cycle.h"
#include "hal/sim/sim_clock.h"
#include "tests/unit/firmware/small_machine.h"

namespace vernier::hostile_test {
namespace {

/// Devices that answer anything, or nothing.
class HostileDevices : public AxisReader, public InputReader, public CorrectionWriter {
 public:
  HostileDevices(std::uint64_t seed, bool gives_motion) : random_(seed), gives_motion_(gives_motion) {}

  HalFault read_axis(std::uint32_t axis, AxisReading& reading) noexcept override {
    if (one_in(silence_)) return HalFault::kNoReading;
    position_[axis] = one_in(wild_) ? anything() : position_[axis] + small();
    reading.position = AxisPosition(position_[axis]);
    reading.velocity = AxisSpeed(one_in(wild_) ? anything() : small() * 1000);
    reading.acceleration = AxisAcceleration(anything());
    reading.since = AxisTravel(anything());
    reading.referenced = !one_in(10 * wild_);
    reading.sense = static_cast<std::int8_t>(static_cast<int>(random_() % 3) - 1);
    return HalFault::kNone;
  }
  HalFault read_path(PathReading& reading) noexcept override {
    reading.feed = FeedNmPerMin(anything());
    reading.tells_feed = true;
    reading.curvature = CurvatureNanoPerMm(anything());
    return one_in(silence_) ? HalFault::kNoReading : HalFault::kNone;
  }
  bool gives_motion() const noexcept override { return gives_motion_; }
  HalFault read_input(std::uint32_t, InputMicro& value) noexcept override {
    if (one_in(silence_)) return HalFault::kNoReading;
    value = InputMicro(one_in(wild_) ? anything() : 20'000'000 + 1000 * small());
    return HalFault::kNone;
  }
  /// A failed write may or may not have reached the drive.
  HalFault write_correction(std::uint32_t axis, AxisTravel correction) noexcept override {
    const bool fails = one_in(silence_);
    if (!fails || one_in(2)) held[axis] = correction;
    return fails ? HalFault::kRefused : HalFault::kNone;
  }
  /// Calm stretches let the firmware become Active, wild ones attack it.
  void change_mood() {
    const bool calm = one_in(2);
    silence_ = calm ? 1u << 30 : 3 + static_cast<std::uint32_t>(random_() % 50);
    wild_ = calm ? 1u << 30 : 2 + static_cast<std::uint32_t>(random_() % 100);
  }

  AxisTravel held[kMaxAxes];

 private:
  bool one_in(std::uint32_t count) { return random_() % count == 0; }
  std::int64_t anything() { return static_cast<std::int64_t>(random_()) >> (random_() % 64); }
  std::int64_t small() { return static_cast<std::int64_t>(random_() % 200'001) - 100'000; }

  std::mt19937_64 random_;
  bool gives_motion_;
  std::uint32_t silence_ = 1u << 30, wild_ = 1u << 30;
  std::int64_t position_[kMaxAxes] = {100'000'000, 100'000'000};
};

Command any_command(std::mt19937_64& random) {
  const std::uint64_t choice = random() % 200;
  if (choice < 3) return Command::kActivate;
  if (choice == 3) return Command::kDeactivate;
  if (choice == 6) return Command::kHold;
  if (choice == 7) return Command::kRelease;
  return choice < 6 ? Command::kClearFault : Command::kNone;
}

Fault any_outer(std::mt19937_64& random) { return random() % 2000 == 0 ? Fault::kOverrun : Fault::kNone; }

/// VERNIER_SEED and VERNIER_COUNT on the environment repeat or extend a run.
std::uint64_t from_environment(const char* name, std::uint64_t value) {
  const char* text = std::getenv(name);
  return text != nullptr ? std::strtoull(text, nullptr, 10) : value;
}

TEST(CycleInvariant, DriveNeverMovesFasterThanItsSlewLimit) {
  const std::uint64_t seed = from_environment("VERNIER_SEED", 20240611);
  const std::uint64_t count = from_environment("VERNIER_COUNT", 300000);
  std::printf("seed %llu, %llu ticks\n", static_cast<unsigned long long>(seed),
              static_cast<unsigned long long>(count));
  const auto image = small_image();
  std::uint64_t active = 0, faults = 0;
  for (const bool gives_motion : {true, false}) {
    std::mt19937_64 random(seed);
    HostileDevices devices(seed + 1, gives_motion);
    SimClock clock;
    const auto cycle = std::make_unique<Cycle>(image->view, Board{clock, devices, devices, devices});
    // Programs are exchanged at any moment, as uploads do.
    std::unique_ptr<BoundProgram> running, next;
    AxisTravel before[2];
    for (std::uint64_t tick = 0; tick < count; ++tick) {
      if (tick % 1500 == 0) devices.change_mood();
      if (random() % 700 == 0) {
        next = std::make_unique<BoundProgram>(image->view);
        cycle->use(*next);
        running = std::move(next);
      }
      if (random() % 300 == 0)
        cycle->set_axis_weight(static_cast<std::uint32_t>(random() % 2),
                               WeightQ16(static_cast<std::int32_t>(random() % 65537)));
      cycle->tick(TimeUs(static_cast<std::int64_t>(random())), any_command(random), any_outer(random));
      ASSERT_LE(std::abs((devices.held[0] - before[0]).count), kSmallSlewX) << "tick " << tick;
      ASSERT_LE(std::abs((devices.held[1] - before[1]).count), kSmallSlewY) << "tick " << tick;
      ASSERT_LE(std::abs(devices.held[0].count), 30'000) << "tick " << tick;
      ASSERT_LE(std::abs(devices.held[1].count), 1'000'000) << "tick " << tick;
      before[0] = devices.held[0], before[1] = devices.held[1];
    }
    active += cycle->health().active_ticks;
    faults += cycle->health().faults;
  }
  // The attack is worth something only if the correction was in and was taken out by faults.
  EXPECT_GT(active, count / 50);
  EXPECT_GT(faults, 20u);
}

}  // namespace
}  // namespace vernier::hostile_test
