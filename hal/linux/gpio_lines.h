// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <memory>
#include <string>

#include "hal/digital_line.h"
#include "hal/support/edge_queue.h"

namespace vernier {

/// Address of a GPIO line: the chip and the number of the line.
struct GpioAddress {
  std::string chip;  // "gpiochip0", a path, or the label that the driver gives to the chip
  unsigned line = 0;
  bool inverted = false;  // true: the line is on at the low level
};

/// A line of the kernel's GPIO character device, by libgpiod 1.6 or 2; only gpio_lines.cpp depends on the
/// version.
class GpioLine {
 public:
  enum class Use { kInput, kOutput, kEdges };

  /// Requests a line from the kernel. An output is off at first. Returns null, and the reason in `error`, if
  /// the chip or line does not exist, or if the line is in use. Not real-time safe.
  static std::unique_ptr<GpioLine> request(const GpioAddress& address, Use use, std::string& error);
  virtual ~GpioLine() = default;

  /// Returns 1 if the line is on, 0 if it is off, and -1 with errno set after an error. Real-time safe.
  virtual int get() noexcept = 0;
  virtual bool set(bool on) noexcept = 0;
  /// Moves the edges that the kernel recorded to the queue, without waiting. Real-time safe.
  virtual void read_edges(EdgeQueue& queue) noexcept = 0;
};

/// Edges of the signal of a touch probe. The times of the edges are those of the kernel's interrupt
/// (CLOCK_MONOTONIC, from Linux 5.7 on). On an older kernel, an edge has the time of another clock and is
/// reported as lost. If two edges are closer than the latency of the interrupt, they are reported as a loss,
/// because the kernel reads the level after the interrupt.
class GpioProbeLine : public ProbeLine {
 public:
  static std::unique_ptr<GpioProbeLine> open(const GpioAddress& address, std::string& error);

  HalFault read_edge(ProbeEdge& edge) noexcept override;
  /// Returns 0: the kernel does not know the latency of its interrupt.
  InstantNs resolution() const noexcept override { return InstantNs{}; }
  /// Returns the number of gaps in the sequence of edges since the start. The number never decreases.
  std::uint64_t losses() const noexcept { return queue_.losses(); }
  /// Reads the level of the probe's line. The function level() returns 1 if the probe is in contact, 0 if it
  /// is not in contact, and -1 if the line cannot be read. Not real-time safe.
  int level() noexcept { return line_->get(); }

 private:
  explicit GpioProbeLine(std::unique_ptr<GpioLine> line) : line_(std::move(line)) {}
  std::unique_ptr<GpioLine> line_;
  EdgeQueue queue_;
};

/// A digital input on a GPIO line.
class GpioInput : public DigitalInput {
 public:
  static std::unique_ptr<GpioInput> open(const GpioAddress& address, std::string& error);
  HalFault read_line(bool& on) noexcept override;

 private:
  explicit GpioInput(std::unique_ptr<GpioLine> line) : line_(std::move(line)) {}
  std::unique_ptr<GpioLine> line_;
};

/// A digital output on a GPIO line. The output is switched off when it is opened and when it is closed. If
/// the process was killed, the output has the state that the driver of the chip gives it, often the unchanged
/// state.
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
