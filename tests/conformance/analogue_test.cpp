// SPDX-License-Identifier: GPL-3.0-or-later
// Analogue outputs and IIO sensors on a directory laid out as sysfs is: codes to the last one, the ends of
// the range, what a refused write, a missing attribute and a silent sensor look like.
#include <gtest/gtest.h>
#include <unistd.h>

#include <random>

#include "hal/linux/analogue_output.h"
#include "hal/linux/iio/iio_device.h"
#include "hal/linux/iio/iio_input.h"
#include "hal/sim/analogue_chain.h"
#include "tests/conformance/linux_devices.h"

namespace vernier::analogue_test {
namespace {

// The published chain of 8 bits: 255 codes are 250 um, code 127 is no correction, 254 the last used.
constexpr AnalogueScale kEightBits{.span = 250'000, .codes = 255, .zero = 127, .low = 0, .high = 254};
constexpr std::int64_t kPeriod = 50'000;  // ns
constexpr AnalogueScale kPulse{.span = 250'000, .codes = kPeriod, .zero = 25'000, .low = 0, .high = kPeriod};

class Analogue : public testing::Test {
 protected:
  Analogue() {
    files_.put("pwm0/period", "0"), files_.put("pwm0/duty_cycle", "0"), files_.put("pwm0/enable", "0");
    files_.put("iio:device3/name", "mcp4922"), files_.put("iio:device3/out_voltage1_raw", "0");
    files_.put("iio:device4/name", "tmp117"), files_.put("iio:device4/in_temp_input", "21500");
  }
  std::unique_ptr<AnalogueOutput> dac(const AnalogueScale& scale = kEightBits) {
    return AnalogueOutput::iio_dac(files_.path() + "/iio:device3", 1, scale, error_);
  }
  std::unique_ptr<AnalogueOutput> pwm(const AnalogueScale& scale = kPulse) {
    return AnalogueOutput::pwm(files_.path() + "/pwm0", kPeriod, scale, error_);
  }
  std::string raw() const { return files_.get("iio:device3/out_voltage1_raw"); }
  const SysfsDirectory files_{testing::TempDir() + "analogue_" + std::to_string(getpid()) + "_" +
                              testing::UnitTest::GetInstance()->current_test_info()->name()};
  std::string error_;
};

TEST_F(Analogue, ConverterGetsTheCodesOfThePublishedChain) {
  const AnalogueChain chain(8);
  const auto output = dac();
  ASSERT_NE(output, nullptr) << error_;
  // A step is 980.4 nm: all codes and both ends are visited, halves (25.5 codes at 25 um) too.
  for (std::int64_t nm = -140'000; nm <= 140'000; nm += 97) {
    ASSERT_EQ(output->write_correction(0, AxisTravel(nm)), HalFault::kNone);
    ASSERT_EQ(raw(), std::to_string(chain.code_for(AxisTravel(nm)))) << nm;
  }
  EXPECT_GT(output->held_at_end(0), 0u);
}

TEST_F(Analogue, CodeIsTheNearestOfAll) {
  std::mt19937_64 random(1);
  RecordProperty("seed", 1);
  for (int i = 0; i < 200'000; ++i) {
    AnalogueScale scale{.span = std::uniform_int_distribution<std::int64_t>(1, 4'000'000)(random),
                        .codes = std::uniform_int_distribution<std::int64_t>(1, 65535)(random),
                        .zero = 0,
                        .low = 0,
                        .high = INT32_MAX};
    scale.inverted = (random() & 1) != 0;
    const std::int64_t nm = std::uniform_int_distribution<std::int64_t>(-5'000'000, 5'000'000)(random);
    const std::int64_t code = scale.wanted_code(AxisTravel(nm));
    const std::int64_t wanted = scale.inverted ? -nm : nm;
    // Twice the distance to the ideal code, in units of 1/span of a code: at most one code wide.
    ASSERT_LE(std::abs(2 * (code * scale.span - wanted * scale.codes)), scale.span)
        << nm << " nm, " << scale.codes << " codes in " << scale.span << " nm";
  }
}

TEST_F(Analogue, AnyCorrectionIsHeldWithinTheRangeAndCounted) {
  const auto output = dac();
  ASSERT_NE(output, nullptr) << error_;
  const std::pair<std::int64_t, const char*> kEnds[] = {{INT64_MAX, "254"}, {INT64_MIN, "0"},
                                                        {125'000, "254"},   {-125'000, "0"},
                                                        {124'509, "254"},   {-124'509, "0"}};
  for (const auto& [nm, code] : kEnds) {
    ASSERT_EQ(output->write_correction(0, AxisTravel(nm)), HalFault::kNone);
    EXPECT_EQ(raw(), code) << nm;
  }
  // 124.509 um is 127.0 codes, the last of the range; 125 um is 127.5, which rounds beyond it.
  EXPECT_EQ(output->held_at_end(0), 4u);
}

TEST_F(Analogue, PolarityTurnsTheSign) {
  AnalogueScale inverted = kEightBits;
  inverted.inverted = true;
  const auto output = dac(inverted);
  ASSERT_NE(output, nullptr) << error_;
  ASSERT_EQ(output->write_correction(0, AxisTravel(98'039)), HalFault::kNone);
  EXPECT_EQ(raw(), "27");
  AxisTravel held;
  ASSERT_EQ(output->read_back(0, held), HalFault::kNone);
  EXPECT_EQ(held, AxisTravel(98'039));
}

TEST_F(Analogue, EveryCodeReadsBackAsACorrectionThatGivesIt) {
  const auto output = dac();
  ASSERT_NE(output, nullptr) << error_;
  for (int code = 0; code <= 254; ++code) {
    files_.put("iio:device3/out_voltage1_raw", std::to_string(code));
    AxisTravel held;
    ASSERT_EQ(output->read_back(0, held), HalFault::kNone);
    ASSERT_EQ(output->write_correction(0, held), HalFault::kNone);
    ASSERT_EQ(raw(), std::to_string(code));
  }
}

TEST_F(Analogue, PulseWidthIsSetUpAndWritten) {
  const auto output = pwm();
  ASSERT_NE(output, nullptr) << error_;
  EXPECT_EQ(files_.get("pwm0/period"), "50000");
  EXPECT_EQ(files_.get("pwm0/duty_cycle"), "25000");
  EXPECT_EQ(files_.get("pwm0/enable"), "1");
  ASSERT_EQ(output->write_correction(0, AxisTravel(-5)), HalFault::kNone);
  EXPECT_EQ(files_.get("pwm0/duty_cycle"), "24999");
  ASSERT_EQ(output->write_correction(0, AxisTravel(1'000'000)), HalFault::kNone);
  EXPECT_EQ(files_.get("pwm0/duty_cycle"), "50000");
  EXPECT_EQ(output->write_correction(1, AxisTravel{}), HalFault::kNoDevice);
}

TEST_F(Analogue, RunningPulseKeepsItsWidthAtSetUp) {
  files_.put("pwm0/period", "50000"), files_.put("pwm0/enable", "1"), files_.put("pwm0/duty_cycle", "30000");
  const auto output = pwm();
  ASSERT_NE(output, nullptr) << error_;
  AxisTravel held;
  ASSERT_EQ(output->read_back(0, held), HalFault::kNone);
  EXPECT_EQ(held, AxisTravel(25'000));
  ASSERT_EQ(output->rewrite(), HalFault::kNone);
  EXPECT_EQ(files_.get("pwm0/duty_cycle"), "30000");
}

TEST_F(Analogue, RefusedWriteIsAFault) {
  files_.break_writes("iio:device3/out_voltage1_raw");
  const auto output = dac();
  ASSERT_NE(output, nullptr) << error_;
  EXPECT_EQ(output->write_correction(0, AxisTravel(1000)), HalFault::kRefused);
  files_.break_writes("pwm0/duty_cycle");
  EXPECT_EQ(pwm(), nullptr);
  EXPECT_NE(error_.find("/pwm0: duty_cycle is refused"), std::string::npos) << error_;
}

TEST_F(Analogue, WhatIsMissingIsNamed) {
  EXPECT_EQ(AnalogueOutput::iio_dac(files_.path() + "/iio:device3", 2, kEightBits, error_), nullptr);
  EXPECT_NE(error_.find("iio:device3/out_voltage2_raw: No such file or directory"), std::string::npos)
      << error_;
  EXPECT_EQ(AnalogueOutput::pwm(files_.path() + "/pwm1", kPeriod, kPulse, error_), nullptr);
  EXPECT_NE(error_.find("pwm1/period: No such file or directory"), std::string::npos) << error_;
  EXPECT_EQ(AnalogueOutput::pwm("", kPeriod, kPulse, error_), nullptr);
  EXPECT_NE(error_.find("empty"), std::string::npos) << error_;
  EXPECT_EQ(AnalogueOutput::iio_dac("", 0, kEightBits, error_), nullptr);
  EXPECT_NE(error_.find("empty"), std::string::npos) << error_;
  EXPECT_EQ(AnalogueOutput::pwm(files_.path() + "/pwm0", kPeriod - 1, kPulse, error_), nullptr)
      << "the range is longer than the period";
}

TEST_F(Analogue, DeviceIsFoundByItsName) {
  EXPECT_EQ(find_iio_device(files_.path(), "mcp4922", error_), files_.path() + "/iio:device3");
  EXPECT_EQ(find_iio_device(files_.path(), "/sys/x", error_), "/sys/x");
  EXPECT_EQ(find_iio_device(files_.path(), "ad5064", error_), "");
  EXPECT_NE(error_.find("no IIO device ad5064"), std::string::npos) << error_;
  EXPECT_EQ(find_iio_device(files_.path(), "", error_), "");
  EXPECT_EQ(find_iio_device(files_.path() + "/none", "mcp4922", error_), "");
  EXPECT_NE(error_.find("No such file or directory"), std::string::npos) << error_;
  files_.put("iio:device5/name", "mcp4922"), files_.put("iio:device5/label", "second");
  EXPECT_EQ(find_iio_device(files_.path(), "mcp4922", error_), "");
  EXPECT_NE(error_.find("several IIO devices"), std::string::npos) << error_;
  EXPECT_EQ(find_iio_device(files_.path(), "second", error_), files_.path() + "/iio:device5");
}

TEST_F(Analogue, SensorGivesItsUnit) {
  const std::string path = files_.path() + "/iio:device4/in_temp_input";
  const auto sensor = IioInput::open(path, {0, 0.001}, 3, error_);
  ASSERT_NE(sensor, nullptr) << error_;
  InputMicro value(5);
  EXPECT_EQ(sensor->read_input(0, value), HalFault::kNoReading) << "no sample yet";
  ASSERT_EQ(sensor->sample(), HalFault::kNone);
  ASSERT_EQ(sensor->read_input(0, value), HalFault::kNone);
  EXPECT_EQ(value, InputMicro(21'500'000));
  EXPECT_EQ(sensor->read_input(1, value), HalFault::kNoDevice);
  files_.put("iio:device4/in_temp_input", "-2031.25");
  ASSERT_EQ(sensor->sample(), HalFault::kNone);
  ASSERT_EQ(sensor->read_input(0, value), HalFault::kNone);
  EXPECT_EQ(value, InputMicro(-2'031'250));
  const auto raw = IioInput::open(path, {-31.25, 0.5}, 3, error_);
  ASSERT_EQ(raw->sample(), HalFault::kNone);
  ASSERT_EQ(raw->read_input(0, value), HalFault::kNone);
  EXPECT_EQ(value, InputMicro(-1'031'250'000));
}

TEST_F(Analogue, SilentSensorIsNoReading) {
  const auto sensor = IioInput::open(files_.path() + "/iio:device4/in_temp_input", {0, 0.001}, 3, error_);
  ASSERT_NE(sensor, nullptr) << error_;
  InputMicro value;
  ASSERT_EQ(sensor->sample(), HalFault::kNone);
  for (int read = 0; read < 3; ++read) EXPECT_EQ(sensor->read_input(0, value), HalFault::kNone) << read;
  EXPECT_EQ(sensor->read_input(0, value), HalFault::kNoReading) << "no new sample for three reads";
  EXPECT_EQ(value, InputMicro(21'500'000)) << "a failed read leaves its result untouched";
  ASSERT_EQ(sensor->sample(), HalFault::kNone);
  EXPECT_EQ(sensor->read_input(0, value), HalFault::kNone);
  files_.put("iio:device4/in_temp_input", "error");
  EXPECT_EQ(sensor->sample(), HalFault::kNoReading);
  EXPECT_EQ(sensor->read_input(0, value), HalFault::kNoReading);
  std::filesystem::resize_file(files_.path() + "/iio:device4/in_temp_input", 0);
  EXPECT_EQ(sensor->sample(), HalFault::kNoReading);
}

TEST(SysfsAttribute, ReadsDecimalNumbersAndNothingElse) {
  const auto parse = [](const std::string& text) {
    std::int64_t micro = -7;
    return parse_micro(text.data(), text.size(), micro) ? micro : INT64_MIN;
  };
  EXPECT_EQ(parse("0\n"), 0);
  EXPECT_EQ(parse("-12.345678\n"), -12'345'678);
  EXPECT_EQ(parse("-0.5"), -500'000);
  EXPECT_EQ(parse("3.123456789\n"), 3'123'456);
  EXPECT_EQ(parse("1000000000000\n"), 1'000'000'000'000'000'000);
  for (const char* bad :
       {"", "-", "\n", ".5", "1.", "1,5", "0x10", "+1", " 1", "1 mV", "1000000000001", "nan", "1e3"})
    EXPECT_EQ(parse(bad), INT64_MIN) << bad;
}

}  // namespace
}  // namespace vernier::analogue_test
