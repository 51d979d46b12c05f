// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "hal/input_reader.h"
#include "hal/linux/iio/iio_input.h"
#include "hal/linux/iio/iio_scan.h"

namespace vernier {

/// A channel of the buffer of a device: the name of its files in scan_elements without "in_" ("accel_x").
struct IioChannel {
  std::string name;
  IioScale scale;
};

struct IioBufferSettings {
  std::string directory;  // of the device in sysfs
  std::string device;     // "/dev/iio:device0"
  std::vector<IioChannel> channels;
  std::string trigger;    // written to trigger/current_trigger; empty: not changed
  std::string frequency;  // written to sampling_frequency; empty: not changed
};

/// Counters of the scans from the buffer; each counter only increases.
struct IioBufferCounts {
  std::uint64_t scans = 0;
  std::uint64_t skipped = 0;    // scans that came too quickly: beyond kMostWaiting the oldest are left out
  std::uint64_t missing = 0;    // ticks without a scan after the first one
  std::uint64_t malformed = 0;  // reads that were no whole number of scans
  std::uint64_t broken = 0;     // ticks in which the device failed
};

/// A sensor (for example an accelerometer) that fills a buffer of the kernel's industrial I/O class. The
/// sensor's clock or a trigger starts each scan. Every tick gets the next scan, in order; each scan is used
/// once. Input i is the i-th channel. A scan waits in a queue until its tick. If the sensor's clock is faster
/// than the ticks, the queue grows to kMostWaiting; then a scan is skipped now and then. If the sensor's
/// clock is slower than the ticks, some ticks have no scan (kNoReading): the window of a feature then repeats
/// a sample.
class IioBuffer : public InputReader {
 public:
  static constexpr std::uint32_t kMostWaiting = 4;  // ticks that a tick may be late without a scan lost

  /// Sets up the device (channels, trigger, rate) and starts it. Returns null with `error` set if that fails.
  /// Not real-time safe.
  static std::unique_ptr<IioBuffer> open(const IioBufferSettings& settings, std::string& error);
  /// Stops the device.
  ~IioBuffer() override;
  IioBuffer(const IioBuffer&) = delete;
  IioBuffer& operator=(const IioBuffer&) = delete;

  /// Takes the received scans without waiting, and steps to the next scan. realtime: one or two system calls.
  void begin_tick() noexcept override;
  /// kNoReading: this tick has no scan. Real-time safe.
  HalFault read_input(std::uint32_t input, InputMicro& value) noexcept override;
  const IioBufferCounts& counts() const noexcept { return counts_; }

 private:
  struct Element {
    IioElement type;
    std::size_t at = 0;  // in a scan
    IioScale scale;
  };
  static constexpr std::size_t kMostBytes = 8192;  // read in one call

  explicit IioBuffer(const IioBufferSettings& settings) : settings_(settings) {}
  bool choose_channels(std::string& error);
  bool place_channels(std::string& error);
  bool start(std::string& error);
  void take(std::size_t bytes) noexcept;

  IioBufferSettings settings_;
  int fd_ = -1;
  bool started_ = false;
  std::size_t scan_bytes_ = 0;
  std::vector<Element> elements_;  // by input
  std::vector<unsigned char> read_, waiting_, now_;
  std::uint32_t first_ = 0, count_ = 0;  // of the ring of waiting scans
  bool drained_ = false, fresh_ = false, known_ = false;
  IioBufferCounts counts_;
};

}  // namespace vernier
