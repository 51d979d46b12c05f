// SPDX-License-Identifier: GPL-3.0-or-later
// What every backend of AxisReader, InputReader and CorrectionWriter owes the firmware: the simulated plant
// in several states of disrepair, and the Linux devices (CAN axes, IIO sensors, PWM and IIO converters) on a
// directory laid out as sysfs is and on joined sockets in place of a bus.
#include <gtest/gtest.h>
#include <unistd.h>

#include <functional>
#include <memory>

#include "firmware/daemon/routing.h"
#include "hal/linux/analogue_output.h"
#include "hal/linux/can/can_axes.h"
#include "hal/linux/iio/iio_input.h"
#include "hal/sim/plant.h"
#include "hal/sim/roaming.h"
#include "tests/conformance/linux_devices.h"

namespace vernier::board_test {
namespace {

constexpr std::uint32_t kAxes = 3, kInputs = 2, kFirstId = 0x180;

/// A backend with its world: three axes, two inputs.
class World {
 public:
  virtual ~World() = default;
  /// The next tick begins.
  virtual void advance() = 0;
  virtual AxisReader& axes() = 0;
  virtual InputReader& inputs() = 0;
  virtual CorrectionWriter& corrections() = 0;
  /// What the drive of an axis has been given.
  virtual AxisTravel written(std::uint32_t axis) = 0;
};

class SimWorld : public World {
 public:
  explicit SimWorld(const PlantOptions& options)
      : motion_({{0, 600'000'000}, {0, 400'000'000}, {-300'000'000, 0}},
                {InputMicro(20'000'000), InputMicro(0)}, TimeUs(1000), 0.1, options.seed),
        plant_(motion_, kAxes, kInputs, options) {
    plant_.release();
  }
  void advance() override {
    plant_.advance();
    static_cast<AxisReader&>(plant_).begin_tick();
  }
  AxisReader& axes() override { return plant_; }
  InputReader& inputs() override { return plant_; }
  CorrectionWriter& corrections() override { return plant_; }
  AxisTravel written(std::uint32_t axis) override { return plant_.written(axis); }

 private:
  Roaming motion_;
  SimPlant plant_;
};

/// The Linux devices on a simulated plant, whose axes speak CAN and whose sensors are files.
class LinuxWorld : public World {
 public:
  LinuxWorld()
      : files_(testing::TempDir() + "devices_" + std::to_string(getpid()) + "_" + std::to_string(++made_)) {
    files_.put("pwm0/period", "0"), files_.put("pwm0/duty_cycle", "0"), files_.put("pwm0/enable", "0");
    files_.put("iio:device0/out_voltage0_raw", "0"), files_.put("iio:device0/out_voltage1_raw", "0");
    files_.put("iio:device0/in_temp0_input", "21500"), files_.put("iio:device0/in_voltage3_raw", "2050");
    // One code is one count, so that what was written can be told exactly.
    const AnalogueScale scale{.span = 100'000, .codes = 100'000, .zero = 50'000, .low = 0, .high = 100'000};
    std::string error;
    outputs_.push_back(AnalogueOutput::pwm(files_.path() + "/pwm0", 100'000, scale, error));
    for (const unsigned channel : {0u, 1u})
      outputs_.push_back(AnalogueOutput::iio_dac(files_.path() + "/iio:device0", channel, scale, error));
    const std::string device = files_.path() + "/iio:device0/";
    sensors_.push_back(IioInput::open(device + "in_temp0_input", {0, 0.001}, 1000, error));
    sensors_.push_back(IioInput::open(device + "in_voltage3_raw", {-2048, 0.5}, 1000, error));
    bus_ = std::make_unique<CanAxes>(cable_.near(),
                                     std::vector<std::uint32_t>{kFirstId, kFirstId + 1, kFirstId + 2});
    EXPECT_EQ(error, "");
    std::vector<Route<CorrectionWriter>> outputs;
    std::vector<Route<InputReader>> inputs;
    for (auto& output : outputs_) outputs.push_back({output.get(), 0});
    for (auto& sensor : sensors_) inputs.push_back({sensor.get(), 0});
    routed_outputs_ = std::make_unique<RoutedOutputs>(std::move(outputs));
    routed_inputs_ = std::make_unique<RoutedInputs>(std::move(inputs));
    routed_axes_ = std::make_unique<RoutedAxes>(
        std::vector<Route<AxisReader>>{{bus_.get(), 0}, {bus_.get(), 1}, {bus_.get(), 2}});
  }
  void advance() override {
    truth_.advance();
    ++tick_;
    for (std::uint32_t axis = 0; axis < kAxes; ++axis) {
      AxisReading reading;
      truth_.axes().read_axis(axis, reading);
      // 1 ms of the controller's clock is 15.6 units of its stamp.
      const auto stamp = static_cast<std::uint8_t>(tick_ * 1000 / 64 % 64);
      EXPECT_TRUE(cable_.send(kFirstId + axis, {reading.position.count, static_cast<std::uint8_t>(tick_),
                                                true, reading.referenced, stamp}));
    }
    for (auto& sensor : sensors_) EXPECT_EQ(sensor->sample(), HalFault::kNone);
    routed_axes_->begin_tick();
  }
  AxisReader& axes() override { return *routed_axes_; }
  InputReader& inputs() override { return *routed_inputs_; }
  CorrectionWriter& corrections() override { return *routed_outputs_; }
  AxisTravel written(std::uint32_t axis) override {
    AxisTravel held;
    EXPECT_EQ(outputs_[axis]->read_back(0, held), HalFault::kNone);
    return held;
  }

 private:
  static inline int made_ = 0;
  SysfsDirectory files_;
  JoinedSockets cable_;
  SimWorld truth_{PlantOptions{}};
  std::int64_t tick_ = 0;
  std::vector<std::unique_ptr<AnalogueOutput>> outputs_;
  std::vector<std::unique_ptr<IioInput>> sensors_;
  std::unique_ptr<CanAxes> bus_;
  std::unique_ptr<RoutedAxes> routed_axes_;
  std::unique_ptr<RoutedInputs> routed_inputs_;
  std::unique_ptr<RoutedOutputs> routed_outputs_;
};

struct Backend {
  const char* name;
  std::function<std::unique_ptr<World>()> make;
};

class DeviceConformance : public testing::TestWithParam<Backend> {
 protected:
  const std::unique_ptr<World> world_ = GetParam().make();
  AxisReader& axes() { return world_->axes(); }
  InputReader& inputs() { return world_->inputs(); }
  CorrectionWriter& corrections() { return world_->corrections(); }
};

TEST_P(DeviceConformance, NothingIsReadBeforeTheFirstTick) {
  AxisReading reading;
  InputMicro value(77);
  EXPECT_EQ(axes().read_axis(0, reading), HalFault::kNoReading);
  EXPECT_EQ(inputs().read_input(0, value), HalFault::kNoReading);
  EXPECT_EQ(value, InputMicro(77)) << "a failed read leaves its result untouched";
}

TEST_P(DeviceConformance, UnknownDeviceIsNamedAsSuch) {
  world_->advance();
  AxisReading reading;
  InputMicro value;
  EXPECT_EQ(axes().read_axis(kAxes, reading), HalFault::kNoDevice);
  EXPECT_EQ(inputs().read_input(kInputs, value), HalFault::kNoDevice);
  EXPECT_EQ(corrections().write_correction(kAxes, AxisTravel(1)), HalFault::kNoDevice);
}

TEST_P(DeviceConformance, ReadingTwiceInATickGivesTheSame) {
  for (int tick = 0; tick < 200; ++tick) {
    world_->advance();
    AxisReading first, second;
    const HalFault fault = axes().read_axis(1, first);
    ASSERT_EQ(axes().read_axis(1, second), fault);
    ASSERT_EQ(first.position, second.position);
    ASSERT_EQ(first.sense, second.sense);
  }
}

TEST_P(DeviceConformance, SenseIsMinusOneZeroOrOne) {
  for (int tick = 0; tick < 2000; ++tick) {
    world_->advance();
    AxisReading reading;
    if (axes().read_axis(2, reading) != HalFault::kNone) continue;
    ASSERT_LE(std::abs(reading.sense), 1);
    ASSERT_GE(reading.since.count, 0);
  }
}

TEST_P(DeviceConformance, WrittenCorrectionIsHeld) {
  world_->advance();
  ASSERT_EQ(corrections().write_correction(1, AxisTravel(-4321)), HalFault::kNone);
  world_->advance();
  EXPECT_EQ(world_->written(1), AxisTravel(-4321));
  ASSERT_EQ(corrections().write_correction(0, AxisTravel(77)), HalFault::kNone);
  EXPECT_EQ(world_->written(0), AxisTravel(77));
  EXPECT_EQ(world_->written(1), AxisTravel(-4321)) << "the other axis is untouched";
}

TEST_P(DeviceConformance, SameSeedSameReadings) {
  const std::unique_ptr<World> other = GetParam().make();
  for (int tick = 0; tick < 500; ++tick) {
    world_->advance();
    other->advance();
    AxisReading a, b;
    ASSERT_EQ(axes().read_axis(0, a), other->axes().read_axis(0, b));
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

std::unique_ptr<World> sim(const PlantOptions& options) { return std::make_unique<SimWorld>(options); }

INSTANTIATE_TEST_SUITE_P(Backends, DeviceConformance,
                         testing::Values(Backend{"sim", [] { return sim({}); }},
                                         Backend{"simPoor", [] { return sim(poor_instruments()); }},
                                         Backend{"simPositions", [] { return sim(positions_only()); }},
                                         Backend{"linux", [] { return std::make_unique<LinuxWorld>(); }}),
                         [](const testing::TestParamInfo<Backend>& parameter) {
                           return parameter.param.name;
                         });

}  // namespace
}  // namespace vernier::board_test
