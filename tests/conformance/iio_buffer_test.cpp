// SPDX-License-Identifier: GPL-3.0-or-later
// Buffered IIO sensors: scans as the kernel lays them out, on a directory laid out as sysfs is with a pipe in
// the place of the character device.
#include "hal/linux/iio/iio_buffer.h"

#include <fcntl.h>
#include <gtest/gtest.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cmath>
#include <thread>

#include "firmware/core/cycle/feature_inputs.h"
#include "hal/linux/iio/iio_device.h"
#include "tests/conformance/linux_devices.h"

namespace vernier::iio_buffer_test {
namespace {

TEST(IioScan, ReadsTheKernelsTypes) {
  IioElement element;
  ASSERT_TRUE(parse_iio_element("le:s12/16>>4\n", element));
  EXPECT_TRUE(!element.big_endian && element.is_signed);
  EXPECT_EQ(element.bits, 12u);
  EXPECT_EQ(element.shift, 4u);
  EXPECT_EQ(element.bytes(), 2u);
  ASSERT_TRUE(parse_iio_element("be:u20/32X2>>12", element));
  EXPECT_TRUE(element.big_endian && !element.is_signed);
  EXPECT_EQ(element.bytes(), 8u);
  for (const char* wrong : {"", "le:s16", "le:s16/16", "le:s16/16>>1", "xe:s16/16>>0", "le:f32/32>>0",
                            "le:s0/16>>0", "le:s16/12>>0", "le:s16/16X0>>0", "le:s16/16>>0 x", "le:s-1/16>>0",
                            "le:s65/64>>0", "le:s99999999999/16>>0"})
    EXPECT_FALSE(parse_iio_element(wrong, element)) << wrong;
}

TEST(IioScan, TurnsShiftsAndSigns) {
  const unsigned char bytes[] = {0x12, 0x34, 0x56, 0x78, 0x9a, 0xbc, 0xde, 0xf0};
  const auto value = [&](const char* type) {
    IioElement element;
    EXPECT_TRUE(parse_iio_element(type, element)) << type;
    return iio_value(bytes, element);
  };
  EXPECT_EQ(value("be:u16/16>>0"), 0x1234);
  EXPECT_EQ(value("le:u16/16>>0"), 0x3412);
  EXPECT_EQ(value("be:s12/16>>4"), 0x123);
  EXPECT_EQ(value("be:u4/16>>0"), 0x4);
  EXPECT_EQ(value("le:s20/32>>12"), 0x78563);
  EXPECT_EQ(value("be:u64/64>>0"), 0x123456789abcdef0);
  const unsigned char low[] = {0xff, 0xff, 0xff, 0xff, 0xff, 0xff, 0xff, 0xff}, least[] = {0x00, 0x80};
  IioElement element;
  parse_iio_element("le:s16/16>>0", element);
  EXPECT_EQ(iio_value(low, element), -1);
  EXPECT_EQ(iio_value(least, element), -32768);
  parse_iio_element("le:u64/64>>0", element);
  EXPECT_EQ(iio_value(low, element), INT64_MAX);
  parse_iio_element("le:s8/8>>0", element);
  EXPECT_EQ(iio_value(low, element), -1);
}

/// A device with two accelerations and a time stamp, whose character device is a pipe.
class IioBufferTest : public testing::Test {
 protected:
  IioBufferTest() {
    put("name", "adxl355"), put("buffer/enable", "1"), put("buffer/length", "2"),
        put("buffer/watermark", "64");
    put("trigger/current_trigger", ""), put("sampling_frequency", "100");
    element("in_accel_x", "0", "le:s16/16>>0"), element("in_accel_y", "1", "be:s12/16>>4");
    element("in_accel_z", "2", "le:s20/32>>12"), element("in_timestamp", "3", "le:s64/64>>0");
    put("scan_elements/in_timestamp_en", "1");
    std::filesystem::create_directories(files_.path() + "/dev");
    ::mkfifo(device().c_str(), 0600);
    pipe_ = ::open(device().c_str(), O_RDWR | O_NONBLOCK | O_CLOEXEC);
  }
  ~IioBufferTest() override { ::close(pipe_); }
  void put(const std::string& name, const std::string& text) const {
    files_.put("iio:device5/" + name, text);
  }
  std::string get(const std::string& name) const { return files_.get("iio:device5/" + name); }
  void element(const std::string& name, const std::string& index, const std::string& type) const {
    put("scan_elements/" + name + "_en", "0"), put("scan_elements/" + name + "_index", index);
    put("scan_elements/" + name + "_type", type);
  }
  std::string device() const { return files_.path() + "/dev/iio:device5"; }
  IioBufferSettings settings() const {
    return {files_.path() + "/iio:device5", device(), {{"accel_x", {0, 0.001}}}, "", ""};
  }
  void send(const std::vector<unsigned char>& bytes) const {
    ASSERT_EQ(::write(pipe_, bytes.data(), bytes.size()), static_cast<ssize_t>(bytes.size()));
  }
  void send_x(int value) const {
    send({static_cast<unsigned char>(value & 0xff), static_cast<unsigned char>(value >> 8 & 0xff)});
  }
  static std::int64_t read(IioBuffer& buffer, std::uint32_t input = 0) {
    InputMicro value;
    return buffer.read_input(input, value) == HalFault::kNone ? value.count : INT64_MIN;
  }
  const SysfsDirectory files_{testing::TempDir() + "iio_" + std::to_string(getpid()) + "_" +
                              testing::UnitTest::GetInstance()->current_test_info()->name()};
  std::string error_;
  int pipe_ = -1;
};

TEST_F(IioBufferTest, SetsTheDeviceUpAndStopsIt) {
  IioBufferSettings wanted = settings();
  wanted.trigger = "hrtimer0", wanted.frequency = "1000";
  auto buffer = IioBuffer::open(wanted, error_);
  ASSERT_NE(buffer, nullptr) << error_;
  EXPECT_EQ(get("buffer/enable"), "1");
  EXPECT_EQ(get("buffer/length"), "256");
  EXPECT_EQ(get("buffer/watermark").front(), '1');
  EXPECT_EQ(get("trigger/current_trigger"), "hrtimer0");
  EXPECT_EQ(get("sampling_frequency"), "1000");
  EXPECT_EQ(get("scan_elements/in_accel_x_en"), "1");
  EXPECT_EQ(get("scan_elements/in_accel_y_en"), "0");
  EXPECT_EQ(get("scan_elements/in_timestamp_en"), "0");
  buffer.reset();
  EXPECT_EQ(get("buffer/enable"), "0");
}

TEST_F(IioBufferTest, EveryTickHasTheNextScanOnce) {
  const auto buffer = IioBuffer::open(settings(), error_);
  ASSERT_NE(buffer, nullptr) << error_;
  send_x(7);  // from before the first tick
  buffer->begin_tick();
  EXPECT_EQ(read(*buffer), INT64_MIN);
  EXPECT_EQ(buffer->counts().missing, 0u);
  for (const int value : {100, -200, 300}) {
    send_x(value);
    buffer->begin_tick();
    EXPECT_EQ(read(*buffer), 1000 * value);
  }
  // WHEN a tick comes late THEN scans wait for theirs
  send_x(1), send_x(2), send_x(3);
  for (const int value : {1, 2, 3}) {
    buffer->begin_tick();
    EXPECT_EQ(read(*buffer), 1000 * value);
  }
  buffer->begin_tick();
  EXPECT_EQ(read(*buffer), INT64_MIN);
  EXPECT_EQ(buffer->counts().missing, 1u);
  EXPECT_EQ(buffer->counts().skipped, 0u);
  // WHEN more come than wait THEN the oldest are left out and counted
  for (int value = 1; value <= 6; ++value) send_x(value);
  for (const int value : {3, 4, 5, 6}) {
    buffer->begin_tick();
    EXPECT_EQ(read(*buffer), 1000 * value);
  }
  EXPECT_EQ(buffer->counts().skipped, 2u);
  EXPECT_EQ(buffer->counts().scans, 13u);
  send({1, 2, 3});
  buffer->begin_tick();
  EXPECT_EQ(buffer->counts().malformed, 1u);
}

TEST_F(IioBufferTest, ChannelsStandWhereTheirIndexAndSizePutThem) {
  IioBufferSettings wanted = settings();
  // z before x before y in the file of the board; in the scan x (2 bytes), y (2), z (4).
  wanted.channels = {{"accel_z", {0, 1}}, {"accel_x", {10, 0.5}}, {"accel_y", {0, 2}}};
  const auto buffer = IioBuffer::open(wanted, error_);
  ASSERT_NE(buffer, nullptr) << error_;
  buffer->begin_tick();
  send({0x05, 0x00, 0xff, 0xe0, 0x00, 0xd0, 0xff, 0xff});
  buffer->begin_tick();
  EXPECT_EQ(read(*buffer, 0), -3'000'000);
  EXPECT_EQ(read(*buffer, 1), 7'500'000);
  EXPECT_EQ(read(*buffer, 2), -4'000'000);
  InputMicro value;
  EXPECT_EQ(buffer->read_input(3, value), HalFault::kNoDevice);
  // x and z alone: two bytes are left free before the four of z.
  wanted.channels.pop_back();
  const auto two = IioBuffer::open(wanted, error_);
  ASSERT_NE(two, nullptr) << error_;
  two->begin_tick();
  send({0x05, 0x00, 0xaa, 0xaa, 0x00, 0x20, 0x00, 0x00});
  two->begin_tick();
  EXPECT_EQ(read(*two, 0), 2'000'000);
  EXPECT_EQ(read(*two, 1), 7'500'000);
}

TEST_F(IioBufferTest, WhatIsMissingOrNotUnderstoodIsNamed) {
  IioBufferSettings wanted = settings();
  wanted.channels = {{"accel_q", {0, 1}}};
  EXPECT_EQ(IioBuffer::open(wanted, error_), nullptr);
  EXPECT_NE(error_.find("scan_elements/in_accel_q_en: No such file"), std::string::npos) << error_;
  put("scan_elements/in_accel_x_type", "le:f32/32>>0");
  EXPECT_EQ(IioBuffer::open(settings(), error_), nullptr);
  EXPECT_NE(error_.find("in_accel_x_type: not understood: \"le:f32/32>>0\""), std::string::npos) << error_;
  put("scan_elements/in_accel_x_type", "le:s16/16>>0"), put("scan_elements/in_accel_x_index", "first");
  EXPECT_EQ(IioBuffer::open(settings(), error_), nullptr);
  EXPECT_NE(error_.find("in_accel_x_index: no number"), std::string::npos) << error_;
  put("scan_elements/in_accel_x_index", "0");
  wanted = settings();
  wanted.trigger = "none there";
  std::filesystem::remove(files_.path() + "/iio:device5/trigger/current_trigger");
  std::filesystem::create_symlink("/dev/null", files_.path() + "/iio:device5/trigger/current_trigger");
  EXPECT_EQ(IioBuffer::open(wanted, error_), nullptr);
  EXPECT_NE(error_.find("current_trigger: no IIO trigger none there"), std::string::npos) << error_;
  wanted = settings();
  wanted.device += "9";
  EXPECT_EQ(IioBuffer::open(wanted, error_), nullptr);
  EXPECT_NE(error_.find("iio:device59: No such file"), std::string::npos) << error_;
  files_.break_writes("iio:device5/buffer/length");
  EXPECT_EQ(IioBuffer::open(settings(), error_), nullptr);
  EXPECT_NE(error_.find("buffer/length: the driver refuses 256"), std::string::npos) << error_;
  std::filesystem::remove_all(files_.path() + "/iio:device5/scan_elements");
  EXPECT_EQ(IioBuffer::open(settings(), error_), nullptr);
  EXPECT_NE(error_.find("scan_elements"), std::string::npos) << error_;
}

TEST_F(IioBufferTest, AFeatureTakesEverySampleOfTheSensor) {
  // GIVEN 80 Hz at 1 kHz, which a sensor that is asked every 10 ms would show as 20 Hz, and a tick that is
  // late now and then
  const auto buffer = IioBuffer::open(settings(), error_);
  ASSERT_NE(buffer, nullptr) << error_;
  const FeatureRequest rms{.input = 1, .of = 0, .feature = Feature::kRms, .window = 500};
  const FeatureRequest frequency{.input = 2, .of = 0, .feature = Feature::kFrequency, .window = 500};
  FeatureInputs features(*buffer, 3, {rms, frequency}, TimeUs(1000));
  ASSERT_EQ(features.refused(), kNoInput);
  features.begin_tick();
  int sent = 0;
  const auto send_next = [&] {
    send_x(static_cast<int>(std::lround(1000 * std::sin(2 * M_PI * 80 * sent / 1000.0))));
    ++sent;
  };
  for (int tick = 0; tick < 1500; ++tick) {
    const int late = tick % 50;
    // Three scans in the tick after two without one, as a scan waits two ticks to begin with.
    if (tick < 2) send_next();
    for (int scan = 0; scan < (late == 20 || late == 21 ? 0 : late == 22 ? 3 : 1); ++scan) send_next();
    features.begin_tick();
  }
  EXPECT_EQ(buffer->counts().missing, 0u);
  EXPECT_EQ(buffer->counts().skipped, 0u);
  InputMicro value;
  ASSERT_EQ(features.read_input(1, value), HalFault::kNone);
  EXPECT_NEAR(static_cast<double>(value.count), 1e6 / std::sqrt(2), 1e3);  // samples of 0.001, whole periods
  ASSERT_EQ(features.read_input(2, value), HalFault::kNone);
  EXPECT_NEAR(static_cast<double>(value.count), 80e6, 0.5e6);
}

TEST(IioBuffer, OfThisMachinesOwnDevices) {
  std::error_code none;
  std::string found;
  for (const auto& entry : std::filesystem::directory_iterator(kIioRoot, none))
    if (std::filesystem::exists(entry.path() / "buffer" / "enable")) found = entry.path().string();
  if (found.empty()) GTEST_SKIP() << "no IIO device with a buffer on this machine";
  IioBufferSettings settings{found, "/dev/" + std::filesystem::path(found).filename().string(), {}, "", ""};
  for (const auto& entry : std::filesystem::directory_iterator(found + "/scan_elements", none)) {
    const std::string name = entry.path().filename().string();
    if (settings.channels.empty() && name.starts_with("in_") && name.ends_with("_type") &&
        name != "in_timestamp_type")
      settings.channels.push_back({name.substr(3, name.size() - 8), {}});
  }
  std::string error;
  const auto buffer = IioBuffer::open(settings, error);
  if (buffer == nullptr) GTEST_SKIP() << "it cannot be started: " << error;
  for (int i = 0; i < 2000 && buffer->counts().scans == 0; ++i) {
    buffer->begin_tick();
    std::this_thread::sleep_for(std::chrono::milliseconds(1));
  }
  if (buffer->counts().scans == 0) GTEST_SKIP() << "nothing triggers it";
  EXPECT_EQ(buffer->counts().malformed + buffer->counts().broken, 0u);
}

}  // namespace
}  // namespace vernier::iio_buffer_test
