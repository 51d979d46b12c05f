// SPDX-License-Identifier: Apache-2.0
#include "hal/linux/analogue_output.h"

#include <optional>

namespace vernier {
namespace {

using Use = SysfsAttribute::Use;

/// The attributes of a PWM channel that are set once.
struct PwmChannel {
  std::optional<SysfsAttribute> period, duty, enable;

  PwmChannel(const std::string& path, std::string& error) {
    period = SysfsAttribute::open(path + "/period", Use::kBoth, error);
    if (period) duty = SysfsAttribute::open(path + "/duty_cycle", Use::kBoth, error);
    if (duty) enable = SysfsAttribute::open(path + "/enable", Use::kBoth, error);
  }
  bool complete() const { return period && duty && enable; }

  /// What stopped the set-up, or null. The kernel refuses an on-time above the period at every moment.
  const char* run(std::int64_t period_ns, std::int64_t zero_ns) {
    std::int64_t now_ns = 0, on = 0;
    if (period->read(now_ns) != HalFault::kNone) return "period cannot be read";
    if (enable->read(on) != HalFault::kNone) return "enable cannot be read";
    if (now_ns == period_ns && on == 1) return nullptr;
    // A channel that was never used has a period of 0 and takes no on-time before it has one.
    if (now_ns != 0 && duty->write(0) != HalFault::kNone) return "duty_cycle cannot be set to 0";
    if (period->write(period_ns) != HalFault::kNone) return "period is refused";
    if (duty->write(zero_ns) != HalFault::kNone) return "duty_cycle is refused";
    return enable->write(1) == HalFault::kNone ? nullptr : "enable is refused";
  }
};

}  // namespace

std::unique_ptr<AnalogueOutput> AnalogueOutput::pwm(const std::string& channel, std::int64_t period_ns,
                                                    const AnalogueScale& scale, std::string& error) {
  if (channel.empty() || !scale.valid() || scale.high > period_ns) {
    error = channel.empty() ? "the path of the PWM channel is empty"
                            : channel + ": the codes low, high and zero do not fit the period of the PWM";
    return nullptr;
  }
  PwmChannel pwm(channel, error);
  if (!pwm.complete()) return nullptr;
  if (const char* const stopped = pwm.run(period_ns, scale.zero); stopped != nullptr) {
    error = channel + ": " + stopped;
    return nullptr;
  }
  return std::unique_ptr<AnalogueOutput>(new AnalogueOutput(std::move(*pwm.duty), scale));
}

std::unique_ptr<AnalogueOutput> AnalogueOutput::iio_dac(const std::string& device, unsigned channel,
                                                        const AnalogueScale& scale, std::string& error) {
  if (device.empty() || !scale.valid()) {
    error = device.empty() ? "the path of the IIO device is empty"
                           : device + ": the settings low, high, zero, codes and span are inconsistent";
    return nullptr;
  }
  const std::string path = device + "/out_voltage" + std::to_string(channel) + "_raw";
  auto attribute = SysfsAttribute::open(path, Use::kBoth, error);
  // Some drivers let their converter be written only.
  if (!attribute) attribute = SysfsAttribute::open(path, Use::kWrite, error);
  if (!attribute) return nullptr;
  error.clear();
  return std::unique_ptr<AnalogueOutput>(new AnalogueOutput(std::move(*attribute), scale));
}

HalFault AnalogueOutput::write_correction(std::uint32_t axis, AxisTravel correction) noexcept {
  if (axis != 0) return HalFault::kNoDevice;
  const std::int64_t wanted = converter_.wanted_code(correction), code = converter_.code_for(correction);
  held_at_end_ += wanted != code ? 1 : 0;
  return attribute_.write(code);
}

AxisTravel AnalogueOutput::within_range(std::uint32_t, AxisTravel correction) const noexcept {
  return AxisTravel(clamp(correction.count, lowest_.count, highest_.count));
}

HalFault AnalogueOutput::read_back(std::uint32_t, AxisTravel& correction) noexcept {
  std::int64_t code = 0;
  if (attribute_.read(code) != HalFault::kNone || code < 0 || code > INT32_MAX) return HalFault::kNoReading;
  correction = converter_.scale().correction_of(code);
  return HalFault::kNone;
}

HalFault AnalogueOutput::rewrite() noexcept {
  std::int64_t code = 0;
  if (attribute_.read(code) != HalFault::kNone) return HalFault::kNoReading;
  return attribute_.write(code);
}

std::string AnalogueOutput::attempt(std::uint32_t) {
  const HalFault fault = rewrite();
  if (fault == HalFault::kRefused) return "the device refused a write of its present value";
  return fault == HalFault::kNone ? "" : "the present value of the device cannot be read";
}

}  // namespace vernier
