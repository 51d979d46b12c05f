// SPDX-License-Identifier: GPL-3.0-or-later
#include "hal/sim/plant.h"

#include <gtest/gtest.h>

#include <cmath>

#include "hal/sim/roaming.h"

namespace vernier::plant_test {
namespace {

/// Axis 0 runs at 1 um a tick from zero.
class Ramp : public Trajectory {
 public:
  void at(std::int64_t tick, PlantState& state) noexcept override {
    state.axis[0].position = AxisPosition(1000 * tick);
    state.axis[0].velocity = AxisSpeed(1'000'000);
    state.axis[0].sense = 1;
    state.input[0] = InputMicro(tick);
  }
};

AxisReading read(SimPlant& plant) {
  AxisReading reading;
  EXPECT_EQ(plant.read_axis(0, reading), HalFault::kNone);
  return reading;
}

TEST(SimPlant, StandsUntilReleasedAndStartsAtTheFirstTick) {
  Ramp ramp;
  SimPlant plant(ramp, 1, 1);
  for (int i = 0; i < 5; ++i) {
    plant.advance();
    EXPECT_EQ(read(plant).position, AxisPosition(0));
    EXPECT_EQ(read(plant).velocity, AxisSpeed(0));
  }
  plant.release();
  for (int i = 0; i < 5; ++i) {
    plant.advance();
    EXPECT_EQ(read(plant).position, AxisPosition(1000 * i));
    EXPECT_EQ(read(plant).velocity, AxisSpeed(1'000'000));
  }
}

TEST(SimPlant, DelayShowsThePast) {
  Ramp ramp;
  PlantOptions options;
  options.delay_ticks = 4;
  SimPlant plant(ramp, 1, 1, options);
  plant.release();
  for (int i = 0; i < 10; ++i) plant.advance();
  EXPECT_EQ(read(plant).position, AxisPosition(1000 * (9 - 4)));
}

TEST(SimPlant, FaultsComeAndGoAtTheirTicks) {
  Ramp ramp;
  PlantOptions options;
  options.faults = {{PlantFaultKind::kMissingPosition, 0, 2, 1},
                    {PlantFaultKind::kFrozenAxis, 0, 4, 2},
                    {PlantFaultKind::kJump, 0, 7, 1, 500'000},
                    {PlantFaultKind::kSensorLost, 0, 3, 1},
                    {PlantFaultKind::kWriteFailure, 0, 5, 1}};
  SimPlant plant(ramp, 1, 1, options);
  plant.release();
  for (int tick = 0; tick < 9; ++tick) {
    plant.advance();
    AxisReading reading;
    InputMicro input;
    EXPECT_EQ(plant.read_axis(0, reading), tick == 2 ? HalFault::kNoReading : HalFault::kNone);
    EXPECT_EQ(plant.read_input(0, input), tick == 3 ? HalFault::kNoReading : HalFault::kNone);
    EXPECT_EQ(plant.write_correction(0, AxisTravel(tick)), tick == 5 ? HalFault::kRefused : HalFault::kNone);
    EXPECT_EQ(plant.written(0), AxisTravel(tick == 5 ? 4 : tick));
    if (tick == 4 || tick == 5) {
      EXPECT_EQ(reading.position, AxisPosition(3000)) << tick;
    }
    if (tick == 6) {
      EXPECT_EQ(reading.position, AxisPosition(6000));
    }
    if (tick == 7) {
      EXPECT_EQ(reading.position, AxisPosition(7000 + 500'000));
    }
  }
}

TEST(SimPlant, NoiseHasTheGivenSpread) {
  Ramp ramp;
  PlantOptions options;
  options.position_noise_counts = 300;
  SimPlant plant(ramp, 1, 1, options);
  double sum = 0, squares = 0;
  constexpr int kCount = 20000;
  for (int i = 0; i < kCount; ++i) {
    plant.advance();
    const double value = static_cast<double>(read(plant).position.count);
    sum += value, squares += value * value;
  }
  // Standard deviations of mean and of standard deviation over 20000 draws: 300/141 and 300/200; five of
  // them.
  EXPECT_NEAR(sum / kCount, 0, 11);
  EXPECT_NEAR(std::sqrt(squares / kCount), 300, 8);
}

TEST(Roaming, MotionStateIsTheDerivativeOfThePosition) {
  Roaming motion({{0, 600'000'000}}, {}, TimeUs(1000), 0.1, 3);
  PlantState before, now, after;
  for (std::int64_t tick = 1; tick < 60000; tick += 7) {
    motion.at(tick - 1, before), motion.at(tick, now), motion.at(tick + 1, after);
    const auto position = [](const PlantState& s) { return static_cast<double>(s.axis[0].position.count); };
    // Central differences over 2 ms: positions are rounded to 1 count (1000 counts/s here), third derivatives
    // are below 1e7 counts/s^3.
    ASSERT_NEAR(static_cast<double>(now.axis[0].velocity.count), (position(after) - position(before)) / 2e-3,
                1100);
    ASSERT_GE(position(now), 0);
    ASSERT_LE(position(now), 600'000'000);
    const bool turned = now.axis[0].sense != before.axis[0].sense;
    if (!turned) {
      ASSERT_NEAR(static_cast<double>((now.axis[0].since - before.axis[0].since).count),
                  std::abs(position(now) - position(before)), 3);
    }
  }
}

}  // namespace
}  // namespace vernier::plant_test
