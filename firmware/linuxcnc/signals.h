// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include "firmware/core/cycle/runner.h"
#include "firmware/linuxcnc/joints.h"
#include "hal/digital_line.h"
#include "hal/input_reader.h"
#include "hal/probe_line.h"

namespace vernier {

/// Sensors of the board, as pins of LinuxCNC's HAL. If the value of a pin is not a finite number, the reading
/// of the sensor is missing.
class PinInputs : public InputReader {
 public:
  PinInputs(const Pins& pins, std::uint32_t count) noexcept : pins_(pins), count_(count) {}
  HalFault read_input(std::uint32_t input, InputMicro& value) noexcept override;

 private:
  const Pins& pins_;
  std::uint32_t count_;
};

/// Enable signal of the board: on if the pin `enable` is on and every joint is homed.
class EnablePin : public DigitalInput {
 public:
  EnablePin(const Pins& pins, const Joints& joints) noexcept : pins_(pins), joints_(joints) {}
  HalFault read_line(bool& on) noexcept override {
    on = *pins_.enable && joints_.all_homed();
    return HalFault::kNone;
  }

 private:
  const Pins& pins_;
  const Joints& joints_;
};

/// Probe signal from the pin `probe-in`, which is read once per tick. An edge of the probe signal is
/// therefore half a tick old on average.
class PinProbe : public ProbeLine {
 public:
  PinProbe(const Pins& pins, TimeUs tick) noexcept : pins_(pins), tick_(instant_ns(tick)) {}
  /// Sets the runner whose ticks define the times of the edges. Not real-time safe.
  void follow(const Runner& runner) noexcept { runner_ = &runner; }
  HalFault read_edge(ProbeEdge& edge) noexcept override;
  InstantNs resolution() const noexcept override { return tick_; }

 private:
  const Pins& pins_;
  InstantNs tick_;
  const Runner* runner_ = nullptr;
  bool made_ = false;
};

}  // namespace vernier
