// What every backend of AxisReader, InputReader and CorrectionWriter owes the firmware. So far there is the
// simulated plant, in several states of disrepair.
#include <gtest/gtest.h>

#include <functional>
#include <memory>

#include "hal/sim/plant.h"
#include "hal/sim/roaming.h"

namespace vernier {
namespace {

constexpr std::uint32_t kAxes = 3, kInputs = 2;

/// A backend with its world: three axes, two inputs.
struct Devices {
  std::unique_ptr<Roaming> motion;
  std::unique_ptr<SimPlant> plant;
};

Devices simulated(const PlantOptions& options) {
  Devices devices;
  devices.motion = std::make_unique<Roaming>(
      std::vector<RoamingAxis>{{0, 600'000'000}, {0, 400'000'000}, {-300'000'000, 0}},
      std::vector<InputMicro>{InputMicro(20'000'000), InputMicro(0)}, TimeUs(1000), 0.1, options.seed);
  devices.plant = std::make_unique<SimPlant>(*devices.motion, kAxes, kInputs, options);
  devices.plant->release();
  return devices;
}

struct Backend {
  const char* name;
  std::function<Devices()> make;
};

class DeviceConformance : public testing::TestWithParam<Backend> {
 protected:
  Devices devices_ = GetParam().make();
  AxisReader& axes() { return *devices_.plant; }
  InputReader& inputs() { return *devices_.plant; }
  CorrectionWriter& corrections() { return *devices_.plant; }
};

TEST_P(DeviceConformance, NothingIsReadBeforeTheFirstTick) {
  AxisReading reading;
  InputMicro value(77);
  EXPECT_EQ(axes().read_axis(0, reading), HalFault::kNoReading);
  EXPECT_EQ(inputs().read_input(0, value), HalFault::kNoReading);
  EXPECT_EQ(value, InputMicro(77)) << "a failed read leaves its result untouched";
}

TEST_P(DeviceConformance, UnknownDeviceIsNamedAsSuch) {
  devices_.plant->advance();
  AxisReading reading;
  InputMicro value;
  EXPECT_EQ(axes().read_axis(kAxes, reading), HalFault::kNoDevice);
  EXPECT_EQ(inputs().read_input(kInputs, value), HalFault::kNoDevice);
  EXPECT_EQ(corrections().write_correction(kAxes, AxisTravel(1)), HalFault::kNoDevice);
}

TEST_P(DeviceConformance, ReadingTwiceInATickGivesTheSame) {
  for (int tick = 0; tick < 200; ++tick) {
    devices_.plant->advance();
    AxisReading first, second;
    const HalFault fault = axes().read_axis(1, first);
    ASSERT_EQ(axes().read_axis(1, second), fault);
    ASSERT_EQ(first.position, second.position);
    ASSERT_EQ(first.sense, second.sense);
  }
}

TEST_P(DeviceConformance, SenseIsMinusOneZeroOrOne) {
  for (int tick = 0; tick < 2000; ++tick) {
    devices_.plant->advance();
    AxisReading reading;
    if (axes().read_axis(2, reading) != HalFault::kNone) continue;
    ASSERT_LE(std::abs(reading.sense), 1);
    ASSERT_GE(reading.since.count, 0);
  }
}

TEST_P(DeviceConformance, WrittenCorrectionIsHeld) {
  devices_.plant->advance();
  ASSERT_EQ(corrections().write_correction(1, AxisTravel(-4321)), HalFault::kNone);
  devices_.plant->advance();
  EXPECT_EQ(devices_.plant->written(1), AxisTravel(-4321));
}

TEST_P(DeviceConformance, SameSeedSameReadings) {
  Devices other = GetParam().make();
  for (int tick = 0; tick < 500; ++tick) {
    devices_.plant->advance();
    other.plant->advance();
    AxisReading a, b;
    ASSERT_EQ(devices_.plant->read_axis(0, a), other.plant->read_axis(0, b));
    ASSERT_EQ(a.position, b.position);
  }
}

PlantOptions poor_instruments() {
  PlantOptions options;
  options.seed = 5;
  options.position_noise_counts = 200;
  options.input_noise_micro = 1000;
  options.delay_ticks = 3;
  options.dropout = 0.05;
  return options;
}

PlantOptions positions_only() {
  PlantOptions options;
  options.gives_motion = false;
  return options;
}

INSTANTIATE_TEST_SUITE_P(Backends, DeviceConformance,
                         testing::Values(Backend{"sim", [] { return simulated({}); }},
                                         Backend{"simPoor", [] { return simulated(poor_instruments()); }},
                                         Backend{"simPositions", [] { return simulated(positions_only()); }}),
                         [](const testing::TestParamInfo<Backend>& parameter) {
                           return parameter.param.name;
                         });

}  // namespace
}  // namespace vernier
