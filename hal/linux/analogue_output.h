// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <memory>
#include <string>

#include "hal/linux/output_device.h"
#include "hal/linux/sysfs_attribute.h"

namespace vernier {

/// The correction of one axis as an analogue output: the pulse width of a PWM channel, or a channel of a D/A
/// converter. An AnalogueOutput has only one axis, with index 0. Opening an output does not change the value
/// of a running channel. A correction of an earlier process can therefore be read back and removed.
class AnalogueOutput : public OutputDevice {
 public:
  /// `channel`: directory of an exported channel of the PWM class (/sys/class/pwm/pwmchip0/pwm0); `scale`: in
  /// ns of on-time; `period_ns`: >= scale.high. If the channel is off or has another period, it is set to the
  /// zero of its scale and switched on. Returns null, and the reason in `error`, if the channel cannot be set
  /// up. Not real-time safe.
  static std::unique_ptr<AnalogueOutput> pwm(const std::string& channel, std::int64_t period_ns,
                                             const AnalogueScale& scale, std::string& error);
  /// `device`: directory of an IIO device; `channel`: the number N in out_voltageN_raw; `scale`: in codes.
  /// Not real-time safe.
  static std::unique_ptr<AnalogueOutput> iio_dac(const std::string& device, unsigned channel,
                                                 const AnalogueScale& scale, std::string& error);

  /// A correction beyond the range of the output is limited to the end of the range, and such a
  /// write is counted. The function write_correction() returns kRefused if the driver refused the
  /// value. Real-time safe if the bus of the device is fast: a write to an SPI converter takes some
  /// ten microseconds.
  HalFault write_correction(std::uint32_t axis, AxisTravel correction) noexcept override;

  AxisTravel within_range(std::uint32_t axis, AxisTravel correction) const noexcept override;

  bool lock() noexcept override { return attribute_.lock(); }
  HalFault read_back(std::uint32_t axis, AxisTravel& correction) noexcept override;
  std::string attempt(std::uint32_t axis) override;
  std::string trial() const override { return "only the value that it has was written again"; }
  std::uint64_t held_at_end(std::uint32_t) const noexcept override { return held_at_end_; }
  const AnalogueScale& scale(std::uint32_t) const noexcept override { return converter_.scale(); }

  /// Reads the code of the device and writes the same code again, so that the axis does not move.
  /// If the driver does not give the present code of the device, the result is kNoReading and no
  /// code is written. Not real-time safe.
  HalFault rewrite() noexcept;

 private:
  AnalogueOutput(SysfsAttribute attribute, const AnalogueScale& scale)
      : attribute_(std::move(attribute)), converter_(scale) {
    const AxisTravel low = scale.correction_of(scale.low), high = scale.correction_of(scale.high);
    lowest_ = scale.inverted ? high : low, highest_ = scale.inverted ? low : high;
  }

  SysfsAttribute attribute_;
  AnalogueConverter converter_;
  AxisTravel lowest_, highest_;  // corrections at the ends of the range
  std::uint64_t held_at_end_ = 0;
};

}  // namespace vernier
