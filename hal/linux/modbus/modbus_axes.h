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

/// Registers of a controller that contain axis positions: a sequence number, and two registers for each axis
/// with a signed 32-bit number, high word first. One request reads all these registers.
struct ModbusAxesSettings {
  static constexpr int kMostAxes = 16, kMostRegisters = 125;

  struct Axis {
    int address = 0;
    PositionScale scale;
  };
  int unit = 1;
  ModbusLine::Registers kind = ModbusLine::Registers::kHolding;
  int sequence = 0;      // register that changes with each new position
  TimeUs period{5'000};  // time from one request to the next
  std::vector<Axis> axes;

  /// Returns the first register (first()), or the number of registers (count()), of the request.
  int first() const;
  int count() const;
};

/// Reads positions of axes from the registers of a controller (PLC). A separate thread reads the registers. A
/// tick uses the newest positions and never waits. If the sequence number is the same as in the previous
/// reading, the positions count as no reading, because the program of the controller does not run.
class ModbusAxes : public PositionReader {
 public:
  /// `line`: a Modbus line that only these axes use. Not real-time safe.
  ModbusAxes(std::shared_ptr<ModbusLine> line, const ModbusAxesSettings& settings);
  ~ModbusAxes() override;
  ModbusAxes(const ModbusAxes&) = delete;
  ModbusAxes& operator=(const ModbusAxes&) = delete;

  void begin_tick() noexcept override;
  /// The function read_axis() returns kNoReading if no new positions came since the previous tick. Real-time
  /// safe.
  HalFault read_axis(std::uint32_t index, AxisReading& reading) noexcept override;

  /// Returns statistics of the reading for the end of the daemon. Not real-time safe.
  std::string account() const;

 private:
  void run();
  void take();

  const std::shared_ptr<ModbusLine> line_;
  const ModbusAxesSettings settings_;
  std::vector<PositionConverter> converters_;
  // The thread writes the numbers while `version_` is odd. The tick uses the numbers if `version_` was even
  // and did not change.
  std::array<std::atomic<std::int32_t>, ModbusAxesSettings::kMostAxes> numbers_{};
  std::atomic<std::uint32_t> version_{0};
  std::atomic<std::uint64_t> reads_{0}, failed_{0}, repeated_{0};
  std::atomic<bool> stop_{false};
  bool known_ = false;          // member of the thread; true: a sequence number has come
  std::uint16_t sequence_ = 0;  // newest sequence number
  std::array<std::int32_t, ModbusAxesSettings::kMostAxes> taken_{};  // member of the tick
  std::uint32_t seen_ = 0;
  bool fresh_ = false;
  std::thread thread_;
};

}  // namespace vernier
