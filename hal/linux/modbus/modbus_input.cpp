// SPDX-License-Identifier: Apache-2.0
#include "hal/linux/modbus/modbus_input.h"

#include <modbus.h>
#include <sys/socket.h>
#include <unistd.h>

#include <bit>
#include <cerrno>
#include <cmath>
#include <cstring>

namespace vernier {
namespace {

constexpr std::int64_t kUsPerS = 1'000'000;
constexpr std::uint8_t kAskHolding = 3, kAskInput = 4, kWriteHolding = 16, kException = 0x80;
constexpr int kMbap = 7;  // transaction, protocol, length: two bytes each; unit

bool is_exception(int error) { return error >= EMBXILFUN && error <= EMBXGTAR; }
std::uint8_t upper(int word) { return static_cast<std::uint8_t>(word >> 8); }
std::uint8_t lower(int word) { return static_cast<std::uint8_t>(word); }

}  // namespace

ModbusLine::ModbusLine(_modbus* context, bool serial, TimeUs wait)
    : context_(context), serial_(serial), wait_(wait) {
  modbus_set_response_timeout(context_, static_cast<std::uint32_t>(wait.count / kUsPerS),
                              static_cast<std::uint32_t>(wait.count % kUsPerS));
  // No time of its own for each byte: the answer has to be complete within `wait`, however its bytes come.
  modbus_set_byte_timeout(context_, 0, 0);
}

ModbusLine::~ModbusLine() {
  if (open_) modbus_close(context_);
  modbus_free(context_);
}

std::shared_ptr<ModbusLine> ModbusLine::rtu(const std::string& device, int baud, char parity, TimeUs wait,
                                            std::string& error) {
  modbus_t* const context = modbus_new_rtu(device.c_str(), baud, parity, 8, 1);
  if (context == nullptr) return error = device + ": " + modbus_strerror(errno), nullptr;
  std::shared_ptr<ModbusLine> line(new ModbusLine(context, true, wait));
  if (!line->connected())
    return error = device + ": " + (errno == ENOTTY ? "is no serial line" : modbus_strerror(errno)), nullptr;
  return line;
}

std::shared_ptr<ModbusLine> ModbusLine::tcp(const std::string& address, int port, TimeUs wait,
                                            std::string& error) {
  modbus_t* const context = modbus_new_tcp(address.c_str(), port);
  if (context == nullptr) return error = address + ": " + modbus_strerror(errno), nullptr;
  return std::shared_ptr<ModbusLine>(new ModbusLine(context, false, wait));
}

bool ModbusLine::connected() noexcept {
  if (!open_ && !(open_ = modbus_connect(context_) == 0)) error_ = errno;
  return open_;
}

std::string ModbusLine::why() const { return modbus_strerror(error_); }

// libmodbus compares the unit of an answer on serial lines only, so a request over TCP and the comparison are
// made here (Modbus Messaging on TCP/IP V1.0b, 4.2). request: function and data. Null with errno of
// libmodbus: no valid answer; else the answer of answer_size bytes from its function on.
const std::uint8_t* ModbusLine::ask_over_tcp(int unit, const std::uint8_t* request, int size,
                                             int answer_size) noexcept {
  ++transaction_;
  std::uint8_t frame[MODBUS_TCP_MAX_ADU_LENGTH] = {upper(transaction_), lower(transaction_), 0,          0,
                                                   upper(size + 1),     lower(size + 1),     lower(unit)};
  std::memcpy(frame + kMbap, request, static_cast<std::size_t>(size));
  const std::size_t bytes = std::size_t{kMbap} + static_cast<std::size_t>(size);
  if (::send(modbus_get_socket(context_), frame, bytes, MSG_NOSIGNAL) != static_cast<ssize_t>(bytes))
    return nullptr;
  static_assert(sizeof(answer_) >= MODBUS_TCP_MAX_ADU_LENGTH);
  const int got = modbus_receive_confirmation(context_, answer_);
  if (got < 0) return nullptr;
  errno = EMBBADDATA;
  if (got < kMbap + 2 || std::memcmp(answer_, frame, 4) != 0) return nullptr;
  if ((answer_[4] << 8 | answer_[5]) != got - (kMbap - 1)) return nullptr;
  if (answer_[6] != frame[6]) return errno = EMBBADSLAVE, nullptr;
  const std::uint8_t* const body = answer_ + kMbap;
  if (got == kMbap + 2 && body[0] == (request[0] | kException)) {
    if (is_exception(MODBUS_ENOBASE + body[1])) errno = MODBUS_ENOBASE + body[1];
    return nullptr;
  }
  return body[0] == request[0] && got == kMbap + answer_size ? body : nullptr;
}

void ModbusLine::prepare(int unit) noexcept {
  if (after_silence_) ::usleep(static_cast<useconds_t>(wait_.count));
  after_silence_ = false;
  modbus_flush(context_);
  modbus_set_slave(context_, unit);
}

/// An exception is a valid answer. After any other error the line must become quiet, and a connection is
/// opened again. (So is a serial device that was removed.)
bool ModbusLine::finish(bool done) noexcept {
  if (done) return true;
  error_ = errno;
  const bool exception = is_exception(errno);
  if (errno == EMBBADDATA || errno == EMBBADSLAVE || errno == EMBBADCRC) ++wrong_answers_;
  after_silence_ = serial_ && !exception;
  if (exception || (serial_ && errno != EBADF && errno != EIO)) return false;
  // Without a reset the system would send an unanswered request again when the network is back.
  const linger reset{.l_onoff = 1, .l_linger = 0};
  if (!serial_) ::setsockopt(modbus_get_socket(context_), SOL_SOCKET, SO_LINGER, &reset, sizeof(reset));
  modbus_close(context_);
  open_ = false;
  return false;
}

bool ModbusLine::read(int unit, Registers kind, int address, int count, std::uint16_t* values) noexcept {
  if (!connected()) return false;
  prepare(unit);
  if (serial_)
    return finish(count == (kind == Registers::kInput
                                ? modbus_read_input_registers(context_, address, count, values)
                                : modbus_read_registers(context_, address, count, values)));
  const std::uint8_t request[] = {kind == Registers::kInput ? kAskInput : kAskHolding, upper(address),
                                  lower(address), upper(count), lower(count)};
  const std::uint8_t* const body = ask_over_tcp(unit, request, sizeof(request), 2 + 2 * count);
  const bool fits = body != nullptr && body[1] == 2 * count;
  for (int i = 0; fits && i < count; ++i)
    values[i] = static_cast<std::uint16_t>(body[2 + 2 * i] << 8 | body[3 + 2 * i]);
  return finish(fits);
}

bool ModbusLine::write(int unit, int address, int count, const std::uint16_t* values) noexcept {
  if (count < 1 || count > MODBUS_MAX_WRITE_REGISTERS || !connected()) return false;
  prepare(unit);
  if (serial_) return finish(modbus_write_registers(context_, address, count, values) == count);
  constexpr int kHead = 6;  // function, address, number of registers, number of bytes
  std::uint8_t request[kHead + 2 * MODBUS_MAX_WRITE_REGISTERS] = {
      kWriteHolding, upper(address), lower(address), upper(count), lower(count), lower(2 * count)};
  for (int i = 0; i < count; ++i) {
    request[kHead + 2 * i] = upper(values[i]);
    request[kHead + 2 * i + 1] = lower(values[i]);
  }
  // The answer repeats address and number.
  const std::uint8_t* const body = ask_over_tcp(unit, request, kHead + 2 * count, kHead - 1);
  return finish(body != nullptr && std::memcmp(body, request, kHead - 1) == 0);
}

HalFault ModbusInput::take(std::int64_t& micro) noexcept {
  using Type = ModbusValue::Type;
  const bool wide = value_.type == Type::kInt32 || value_.type == Type::kFloat32;
  std::uint16_t words[2] = {};
  if (!line_->read(value_.unit, value_.kind, value_.address, wide ? 2 : 1, words))
    return HalFault::kNoReading;
  const std::uint32_t both = std::uint32_t{words[0]} << 16 | words[1];
  const double number = value_.type == Type::kInt16    ? static_cast<std::int16_t>(words[0])
                        : value_.type == Type::kUint16 ? words[0]
                        : value_.type == Type::kInt32  ? static_cast<std::int32_t>(both)
                                                       : static_cast<double>(std::bit_cast<float>(both));
  return scaled(number * kPerUnit, value_.offset, value_.scale, micro) ? HalFault::kNone
                                                                       : HalFault::kNoReading;
}

}  // namespace vernier
