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

/// A channel in the buffer of a device. The name of a channel is that of its files in scan_elements, without
/// "in_" ("accel_x").
struct IioChannel {
  std::string name;
  IioScale scale;
};

struct IioBufferSettings {
  std::string directory;  // directory of the device in sysfs
  std::string device;     // "/dev/iio:device0"
  std::vector<IioChannel> channels;
  std::string trigger;    // written to trigger/current_trigger; empty: not changed
  std::string frequency;  // written to sampling_frequency; empty: not changed
};

/// Counters of the scans from the buffer. The counters never decrease.
struct IioBufferCounts {
  std::uint64_t scans = 0;
  std::uint64_t skipped = 0;    // scans that were removed because more than kMostWaiting scans were waiting;
                                // the oldest scans are removed
  std::uint64_t missing = 0;    // ticks without a scan, after the first scan
  std::uint64_t malformed = 0;  // reads whose length was not a whole number of scans
  std::uint64_t broken = 0;     // ticks in which the device failed
};

/// A sensor (for example an accelerometer) that writes its scans to a buffer of the kernel's industrial I/O
/// class. The clock of the sensor or a trigger starts each scan of the channels. Each tick uses the next scan
/// in order; each scan is used once. Input i of the board is the i-th channel. A scan waits in a queue until
/// a tick uses it. If the clock of the sensor is faster than the ticks, the queue grows to kMostWaiting
/// scans. If the queue has kMostWaiting scans and the clock of the sensor is faster than the ticks, a scan is
/// removed from time to time. If the clock of the sensor is slower than the ticks, some ticks have no scan
/// (kNoReading). In a tick without a scan, the window of a feature repeats a sample.
class IioBuffer : public InputReader {
 public:
  static constexpr std::uint32_t kMostWaiting = 4;  // number of ticks by which a tick may be late without
                                                    // loss of a scan

  /// Sets up the device (channels, trigger, rate) and starts it. If the device cannot be set up, open()
  /// returns null and sets `error`. Not real-time safe.
  static std::unique_ptr<IioBuffer> open(const IioBufferSettings& settings, std::string& error);
  /// The destructor stops the device.
  ~IioBuffer() override;
  IioBuffer(const IioBuffer&) = delete;
  IioBuffer& operator=(const IioBuffer&) = delete;

  /// Reads the received scans without waiting, and goes to the next scan. The function is real-time safe: one
  /// or two system calls.
  void begin_tick() noexcept override;
  /// The function read_input() returns kNoReading if this tick has no scan. Real-time safe.
  HalFault read_input(std::uint32_t input, InputMicro& value) noexcept override;
  const IioBufferCounts& counts() const noexcept { return counts_; }

 private:
  struct Element {
    IioElement type;
    std::size_t at = 0;  // offset of the channel in a scan
    IioScale scale;
  };
  static constexpr std::size_t kMostBytes = 8192;  // largest number of bytes that one call reads

  explicit IioBuffer(const IioBufferSettings& settings) : settings_(settings) {}
  bool choose_channels(std::string& error);
  bool place_channels(std::string& error);
  bool start(std::string& error);
  void take(std::size_t bytes) noexcept;

  IioBufferSettings settings_;
  int fd_ = -1;
  bool started_ = false;
  std::size_t scan_bytes_ = 0;
  std::vector<Element> elements_;  // one element for each input
  std::vector<unsigned char> read_, waiting_, now_;
  std::uint32_t first_ = 0, count_ = 0;  // position and number of the waiting scans in the ring
  bool drained_ = false, fresh_ = false, known_ = false;
  IioBufferCounts counts_;
};

}  // namespace vernier
