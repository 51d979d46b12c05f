// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/upload/open_transport.h"

#include <fmt/format.h>
#include <modbus.h>
#include <netdb.h>
#include <sys/socket.h>

#include <array>
#include <cerrno>
#include <chrono>
#include <cstring>

#include "hal/linux/can/isotp_link.h"
#include "tables/link_format.h"
#include "tools/text/error.h"
#include "tools/upload/serial_transport.h"

namespace vernier::upload {
namespace {

class ModbusTransport : public Transport {
 public:
  ModbusTransport(modbus_t* context, std::string name, std::chrono::milliseconds wait)
      : context_(context), name_(std::move(name)) {
    if (context_ == nullptr) throw text::InputError(name_ + ": " + modbus_strerror(errno));
    modbus_set_response_timeout(context_, static_cast<std::uint32_t>(wait.count() / 1000),
                                static_cast<std::uint32_t>(wait.count() % 1000 * 1000));
    // No time of its own for each byte: an answer is complete in time or not at all.
    modbus_set_byte_timeout(context_, 0, 0);
    if (modbus_connect(context_) == 0) return;
    const std::string why = modbus_strerror(errno);
    modbus_free(context_);
    throw text::InputError(name_ + ": no board answers: " + why);
  }
  ~ModbusTransport() override {
    modbus_close(context_);
    modbus_free(context_);
  }
  ModbusTransport(const ModbusTransport&) = delete;
  ModbusTransport& operator=(const ModbusTransport&) = delete;

  std::vector<std::uint8_t> ask(const std::vector<std::uint8_t>& request) override {
    std::array<std::uint16_t, kMailboxRegisters> words{};
    words[0] = static_cast<std::uint16_t>(request.size());
    for (std::size_t i = 0; i < request.size(); ++i)
      words[1 + i / 2] = static_cast<std::uint16_t>(words[1 + i / 2] | request[i] << (i % 2 == 0 ? 8 : 0));
    const int registers = 1 + static_cast<int>((request.size() + 1) / 2);
    if (modbus_write_registers(context_, kMailboxRegister, std::max(registers, 2), words.data()) < 0) fail();
    words.fill(0);
    if (modbus_read_input_registers(context_, kMailboxRegister, kMailboxRegisters, words.data()) < 0) fail();
    if (words[0] > 2 * (kMailboxRegisters - 1))
      throw text::InputError(fmt::format("{}: the board's reply has an impossible length", name_));
    std::vector<std::uint8_t> reply(words[0]);
    for (std::size_t i = 0; i < reply.size(); ++i)
      reply[i] = static_cast<std::uint8_t>(i % 2 == 0 ? words[1 + i / 2] >> 8 : words[1 + i / 2] & 0xff);
    return reply;
  }

 private:
  [[noreturn]] void fail() {
    const std::string why = modbus_strerror(errno);
    modbus_flush(context_);
    throw text::InputError(name_ + ": " + why);
  }

  modbus_t* context_;
  std::string name_;
};

class IsotpTransport : public Transport {
 public:
  IsotpTransport(const BoardUrl& url, std::chrono::milliseconds wait)
      : name_("can://" + url.place), wait_(wait) {
    std::string error;
    link_ = IsotpLink::open(url.place, url.number("receive", 0x601), url.number("send", 0x600), error);
    if (!link_) throw text::InputError(error);
  }
  std::vector<std::uint8_t> ask(const std::vector<std::uint8_t>& request) override {
    std::vector<std::uint8_t> reply(kMaxReplyBytes);
    const int size = link_->ask(request.data(), static_cast<std::uint32_t>(request.size()), reply.data(),
                                kMaxReplyBytes, TimeUs(1000 * std::int64_t{wait_.count()}));
    if (size < 0) throw text::InputError(name_ + ": no reply: " + std::strerror(errno));
    reply.resize(static_cast<std::size_t>(size));
    return reply;
  }

 private:
  std::unique_ptr<IsotpLink> link_;
  std::string name_;
  std::chrono::milliseconds wait_;
};

// libmodbus wants a numeric address.
std::string numeric(const std::string& host) {
  addrinfo hints{};
  hints.ai_family = AF_INET;
  hints.ai_socktype = SOCK_STREAM;
  addrinfo* found = nullptr;
  if (const int error = getaddrinfo(host.c_str(), nullptr, &hints, &found); error != 0)
    throw text::InputError(host + ": " + gai_strerror(error));
  char text[NI_MAXHOST] = {};
  const int error =
      getnameinfo(found->ai_addr, found->ai_addrlen, text, sizeof(text), nullptr, 0, NI_NUMERICHOST);
  freeaddrinfo(found);
  if (error != 0) throw text::InputError(host + ": " + gai_strerror(error));
  return text;
}

}  // namespace

std::unique_ptr<Transport> open_transport(const BoardUrl& url,
                                          std::optional<std::chrono::milliseconds> wait) {
  if (url.scheme == "serial") return open_serial_transport(url, wait.value_or(kSerialReplyDeadline));
  const std::chrono::milliseconds deadline = wait.value_or(kReplyDeadline);
  if (url.scheme == "can") return std::make_unique<IsotpTransport>(url, deadline);
  if (url.scheme == "tcp")
    return std::make_unique<ModbusTransport>(modbus_new_tcp(numeric(url.place).c_str(), url.port),
                                             "tcp://" + url.place + ":" + std::to_string(url.port), deadline);
  const auto parity = url.options.find("parity");
  modbus_t* const context =
      modbus_new_rtu(url.place.c_str(), static_cast<int>(url.number("baud", 115200)),
                     parity == url.options.end() || parity->second.empty() ? 'E' : parity->second[0], 8, 1);
  if (context != nullptr) modbus_set_slave(context, static_cast<int>(url.number("unit", 1)));
  return std::make_unique<ModbusTransport>(context, "rtu://" + url.place, deadline);
}

}  // namespace vernier::upload
