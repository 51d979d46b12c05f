// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <memory>
#include <string>

#include "hal/clock.h"
#include "hal/linux/sampled_input.h"

struct _modbus;

namespace vernier {

/// Client side of a Modbus line (libmodbus): a serial line that several sensors share, or a TCP connection. A
/// ModbusLine is never used in the tick of the firmware.
class ModbusLine {
 public:
  /// `device`: for example "/dev/ttyS1", with 8 data bits, `parity` N, E or O, and one stop bit; `wait`:
  /// longest time for an answer. Returns null, and the reason in `error`, if the device cannot be used. Not
  /// real-time safe.
  static std::shared_ptr<ModbusLine> rtu(const std::string& device, int baud, char parity, TimeUs wait,
                                         std::string& error);
  /// `address`: numeric IP address. If a peer does not answer, this is no error: each reading tries the
  /// connection again. Not real-time safe.
  static std::shared_ptr<ModbusLine> tcp(const std::string& address, int port, TimeUs wait,
                                         std::string& error);
  ~ModbusLine();
  ModbusLine(const ModbusLine&) = delete;
  ModbusLine& operator=(const ModbusLine&) = delete;

  enum class Registers { kInput, kHolding };
  /// Reads `count` registers (1 to 125). The function read() returns false if there is no answer in time, if
  /// the answer is an exception, or if it has another unit, transaction, function or length. After a missing
  /// answer, the line is not used for the time `wait`. Without this pause, a late answer could be taken for
  /// the answer to the next request. Not real-time safe.
  bool read(int unit, Registers kind, int address, int count, std::uint16_t* values) noexcept;
  /// Writes `count` holding registers (1 to 123) in one request. The function write() returns false for the
  /// same reasons as in read(). If write() returns false, the peer may nevertheless have received
  /// the values. Not real-time safe.
  bool write(int unit, int address, int count, const std::uint16_t* values) noexcept;
  /// Returns the number of answers that did not belong to their request or were damaged. Only the thread that
  /// reads may call wrong_answers(). Not real-time safe.
  std::uint64_t wrong_answers() const noexcept { return wrong_answers_; }
  /// Returns the reason why the last request failed, in the words of libmodbus. Not real-time safe.
  std::string why() const;

 private:
  ModbusLine(_modbus* context, bool serial, TimeUs wait);
  bool connected() noexcept;
  void prepare(int unit) noexcept;
  bool finish(bool done) noexcept;
  const std::uint8_t* ask_over_tcp(int unit, const std::uint8_t* request, int size, int answer_size) noexcept;

  _modbus* context_;
  bool serial_, open_ = false, after_silence_ = false;
  std::uint16_t transaction_ = 0;  // transaction number of the newest request over TCP
  std::uint8_t answer_[260] = {};  // answer to this request (Modbus Messaging on TCP/IP V1.0b, 4.1)
  std::uint64_t wrong_answers_ = 0;
  int error_ = 0;  // errno of the last request that failed
  TimeUs wait_;
};

/// Register of a value with its scale: value = (number + offset) * scale in the unit of the input.
struct ModbusValue {
  /// A 32-bit type has the high word first.
  enum class Type { kInt16, kUint16, kInt32, kFloat32 };
  int unit = 1, address = 0;
  ModbusLine::Registers kind = ModbusLine::Registers::kInput;
  Type type = Type::kInt16;
  double offset = 0, scale = 1;
};

/// A value of a Modbus device that is used as a sensor.
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
