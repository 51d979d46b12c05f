// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <array>
#include <atomic>
#include <memory>
#include <string>
#include <thread>
#include <vector>

#include "hal/axis_reader.h"
#include "hal/linux/modbus/modbus_input.h"
#include "hal/support/wrapped_count.h"

namespace vernier {

/// Registers of a controller that hold positions: a sequence number, and two registers for each axis, a
/// signed 32-bit number, high word first. All are read in one request.
struct ModbusAxesSettings {
  static constexpr int kMostAxes = 16, kMostRegisters = 125;

  struct Axis {
    int address = 0;
    PositionScale scale;
  };
  int unit = 1;
  ModbusLine::Registers kind = ModbusLine::Registers::kHolding;
  int sequence = 0;      // register that changes with each new position
  TimeUs period{5'000};  // from one request to the next
  std::vector<Axis> axes;

  /// First register, and number of registers, of the request.
  int first() const;
  int count() const;
};

/// Positions of axes in the registers of a controller (PLC). A separate thread reads; a tick takes the newest
/// positions and never waits. Positions whose sequence number is that of the positions before are no reading:
/// the program of the controller stands still.
class ModbusAxes : public PositionReader {
 public:
  /// line: used by these axes only. Not real-time safe.
  ModbusAxes(std::shared_ptr<ModbusLine> line, const ModbusAxesSettings& settings);
  ~ModbusAxes() override;
  ModbusAxes(const ModbusAxes&) = delete;
  ModbusAxes& operator=(const ModbusAxes&) = delete;

  void begin_tick() noexcept override;
  /// kNoReading: no new positions since the previous tick. Real-time safe.
  HalFault read_axis(std::uint32_t index, AxisReading& reading) noexcept override;

  /// What was read, for the end of the daemon. Not real-time safe.
  std::string account() const;

 private:
  void run();
  void take();

  const std::shared_ptr<ModbusLine> line_;
  const ModbusAxesSettings settings_;
  std::vector<PositionConverter> converters_;
  // The thread writes the numbers while `version_` is odd; the tick takes them if it was even and the same.
  std::array<std::atomic<std::int32_t>, ModbusAxesSettings::kMostAxes> numbers_{};
  std::atomic<std::uint32_t> version_{0};
  std::atomic<std::uint64_t> reads_{0}, failed_{0}, repeated_{0};
  std::atomic<bool> stop_{false};
  bool known_ = false;          // of the thread: a sequence number has come
  std::uint16_t sequence_ = 0;  // the newest
  std::array<std::int32_t, ModbusAxesSettings::kMostAxes> taken_{};  // of the tick
  std::uint32_t seen_ = 0;
  bool fresh_ = false;
  std::thread thread_;
};

}  // namespace vernier
