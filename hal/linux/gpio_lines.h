// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <memory>
#include <string>

#include "hal/digital_line.h"
#include "hal/support/edge_queue.h"

namespace vernier {

/// Address of a line: chip and line.
struct GpioAddress {
  std::string chip;  // "gpiochip0", a path, or the label that the driver gives its chip
  unsigned line = 0;
  bool inverted = false;  // on is the low level
};

/// A line of the kernel's GPIO character device, by libgpiod 1.6 or 2; only gpio_lines.cpp depends on the
/// version.
class GpioLine {
 public:
  enum class Use { kInput, kOutput, kEdges };

  /// Requests the line; an output starts off. Returns null with `error` set if the chip or line does not
  /// exist, or if the line is in use. Not real-time safe.
  static std::unique_ptr<GpioLine> request(const GpioAddress& address, Use use, std::string& error);
  virtual ~GpioLine() = default;

  /// 1 on, 0 off, -1 with errno set. Real-time safe.
  virtual int get() noexcept = 0;
  virtual bool set(bool on) noexcept = 0;
  /// Moves the edges of the kernel into the queue without waiting. Real-time safe.
  virtual void read_edges(EdgeQueue& queue) noexcept = 0;
};

/// Edges of the signal of a probe, with the time of the kernel's interrupt (CLOCK_MONOTONIC, from Linux 5.7
/// on). An edge of an older kernel, with the time of another clock, is reported as lost. Two edges that are
/// closer than the latency of the interrupt are reported as a loss: the kernel reads the level after the
/// interrupt.
class GpioProbeLine : public ProbeLine {
 public:
  static std::unique_ptr<GpioProbeLine> open(const GpioAddress& address, std::string& error);

  HalFault read_edge(ProbeEdge& edge) noexcept override;
  /// Returns 0: the kernel does not know the latency of its interrupt.
  InstantNs resolution() const noexcept override { return InstantNs{}; }
  /// Number of gaps in the sequence of edges since the start; never decreases.
  std::uint64_t losses() const noexcept { return queue_.losses(); }
  /// Reads the line. 1: the probe touches, 0: the probe does not touch, -1: the line cannot be read.
  /// Not real-time safe.
  int level() noexcept { return line_->get(); }

 private:
  explicit GpioProbeLine(std::unique_ptr<GpioLine> line) : line_(std::move(line)) {}
  std::unique_ptr<GpioLine> line_;
  EdgeQueue queue_;
};

/// A digital input.
class GpioInput : public DigitalInput {
 public:
  static std::unique_ptr<GpioInput> open(const GpioAddress& address, std::string& error);
  HalFault read_line(bool& on) noexcept override;

 private:
  explicit GpioInput(std::unique_ptr<GpioLine> line) : line_(std::move(line)) {}
  std::unique_ptr<GpioLine> line_;
};

/// A digital output. The output is off when it is opened and when it is closed. After a killed process the
/// output has the state that the chip's driver leaves, often unchanged.
class GpioOutput : public DigitalOutput {
 public:
  static std::unique_ptr<GpioOutput> open(const GpioAddress& address, std::string& error);
  ~GpioOutput() override;
  HalFault write_line(bool on) noexcept override;

 private:
  explicit GpioOutput(std::unique_ptr<GpioLine> line) : line_(std::move(line)) {}
  std::unique_ptr<GpioLine> line_;
};

}  // namespace vernier
