// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <memory>
#include <string>

#include "hal/clock.h"
#include "hal/linux/sampled_input.h"

struct _modbus;

namespace vernier {

/// The asking side of a Modbus line (libmodbus): a serial line that several sensors share, or a connection. A
/// ModbusLine is never used in the tick.
class ModbusLine {
 public:
  /// device: "/dev/ttyS1"; 8 data bits, `parity` N, E or O, one stop bit; wait: longest time for an answer.
  /// Returns null with `error` set if the device cannot be used. Not real-time safe.
  static std::shared_ptr<ModbusLine> rtu(const std::string& device, int baud, char parity, TimeUs wait,
                                         std::string& error);
  /// address: numeric. A peer that does not answer is no error: each reading tries it again.
  /// Not real-time safe.
  static std::shared_ptr<ModbusLine> tcp(const std::string& address, int port, TimeUs wait,
                                         std::string& error);
  ~ModbusLine();
  ModbusLine(const ModbusLine&) = delete;
  ModbusLine& operator=(const ModbusLine&) = delete;

  enum class Registers { kInput, kHolding };
  /// Reads `count` registers (1 to 125). False: no answer in time, an exception, or an answer of another
  /// unit, transaction, function or length. After a missing answer the line is not used for the same time
  /// again: a late answer is then not taken for the answer to the next request. Not real-time safe.
  bool read(int unit, Registers kind, int address, int count, std::uint16_t* values) noexcept;
  /// Writes `count` holding registers (1 to 123) in one request. False as for read(): the peer may have taken
  /// the values. Not real-time safe.
  bool write(int unit, int address, int count, const std::uint16_t* values) noexcept;
  /// Answers so far that did not belong to their request or were damaged. For the thread that reads.
  /// Not real-time safe.
  std::uint64_t wrong_answers() const noexcept { return wrong_answers_; }
  /// Why the last request failed, in the words of libmodbus. Not real-time safe.
  std::string why() const;

 private:
  ModbusLine(_modbus* context, bool serial, TimeUs wait);
  bool connected() noexcept;
  void prepare(int unit) noexcept;
  bool finish(bool done) noexcept;
  const std::uint8_t* ask_over_tcp(int unit, const std::uint8_t* request, int size, int answer_size) noexcept;

  _modbus* context_;
  bool serial_, open_ = false, after_silence_ = false;
  std::uint16_t transaction_ = 0;  // of the newest request over TCP
  std::uint8_t answer_[260] = {};  // to this request (Modbus Messaging on TCP/IP V1.0b, 4.1)
  std::uint64_t wrong_answers_ = 0;
  int error_ = 0;  // errno of the last request that failed
  TimeUs wait_;
};

/// Register of a value and its scale: value = (number + offset) * scale in the input's unit.
struct ModbusValue {
  /// 32 bits: high word first.
  enum class Type { kInt16, kUint16, kInt32, kFloat32 };
  int unit = 1, address = 0;
  ModbusLine::Registers kind = ModbusLine::Registers::kInput;
  Type type = Type::kInt16;
  double offset = 0, scale = 1;
};

/// A value of a Modbus device as a sensor.
class ModbusInput : public SampledInput {
 public:
  ModbusInput(std::shared_ptr<ModbusLine> line, const ModbusValue& value, std::uint32_t stale_reads)
      : SampledInput(stale_reads), line_(std::move(line)), value_(value) {}

 private:
  HalFault take(std::int64_t& micro) noexcept override;

  std::shared_ptr<ModbusLine> line_;
  ModbusValue value_;
};

}  // namespace vernier
