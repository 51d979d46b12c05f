// SPDX-License-Identifier: Apache-2.0
#include "hal/linux/modbus_server.h"

#include <arpa/inet.h>
#include <modbus.h>
#include <netinet/in.h>
#include <poll.h>
#include <sys/socket.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstring>

namespace vernier {
namespace {

constexpr std::size_t kMostClients = 8;
// A peer that stops in the middle of a request holds the others up for so long, once: it is disconnected.
constexpr std::uint32_t kByteTimeoutUs = 100'000;
constexpr int kReadHolding = 3, kReadInput = 4, kWriteOne = 6, kWriteMany = 16;

int word_at(const std::uint8_t* bytes) { return bytes[0] << 8 | bytes[1]; }

std::string last_error(const std::string& what) { return what + ": " + modbus_strerror(errno); }

}  // namespace

ModbusServer::ModbusServer(_modbus* context, const ModbusLayout& layout)
    : context_(context),
      mapping_(modbus_mapping_new(0, 0, layout.mailbox + layout.mailbox_registers,
                                  layout.mailbox + layout.mailbox_registers)),
      layout_(layout) {
  modbus_set_byte_timeout(context_, 0, kByteTimeoutUs);
  modbus_set_response_timeout(context_, 0, kByteTimeoutUs);
}

ModbusServer::~ModbusServer() {
  for (const Client& client : clients_) ::close(client.fd);
  if (listening_ >= 0) ::close(listening_);
  modbus_set_socket(context_, -1);
  if (mapping_ != nullptr) modbus_mapping_free(mapping_);
  modbus_free(context_);
}

std::unique_ptr<ModbusServer> ModbusServer::tcp(const std::string& address, int port,
                                                const ModbusLayout& layout, std::string& error) {
  in_addr numeric{};
  if (inet_pton(AF_INET, address.c_str(), &numeric) != 1) {
    error = address + ": not a numeric address";
    return nullptr;
  }
  // libmodbus takes port 0 for the standard one, so it is bound here.
  const int fd = ::socket(AF_INET, SOCK_STREAM | SOCK_CLOEXEC, 0);
  const int yes = 1;
  sockaddr_in name{};
  name.sin_family = AF_INET;
  name.sin_addr = numeric;
  name.sin_port = htons(static_cast<std::uint16_t>(port));
  socklen_t length = sizeof(name);
  if (fd < 0 || ::setsockopt(fd, SOL_SOCKET, SO_REUSEADDR, &yes, sizeof(yes)) != 0 ||
      ::bind(fd, reinterpret_cast<const sockaddr*>(&name), sizeof(name)) != 0 || ::listen(fd, 4) != 0 ||
      ::getsockname(fd, reinterpret_cast<sockaddr*>(&name), &length) != 0) {
    error = last_error(address + ":" + std::to_string(port));
    if (fd >= 0) ::close(fd);
    return nullptr;
  }
  modbus_t* const context = modbus_new_tcp(address.c_str(), ntohs(name.sin_port));
  if (context == nullptr) {
    error = last_error(address);
    ::close(fd);
    return nullptr;
  }
  std::unique_ptr<ModbusServer> server(new ModbusServer(context, layout));
  server->listening_ = fd;
  server->port_ = ntohs(name.sin_port);
  return server;
}

std::unique_ptr<ModbusServer> ModbusServer::rtu(const std::string& device, int baud, char parity, int unit,
                                                const ModbusLayout& layout, std::string& error) {
  modbus_t* const context = modbus_new_rtu(device.c_str(), baud, parity, 8, 1);
  if (context == nullptr || modbus_set_slave(context, unit) != 0 || modbus_connect(context) != 0) {
    error = last_error(device);
    if (context != nullptr) modbus_free(context);
    return nullptr;
  }
  std::unique_ptr<ModbusServer> server(new ModbusServer(context, layout));
  const auto registers = static_cast<std::size_t>(layout.mailbox_registers);
  server->clients_.push_back({modbus_get_socket(context), std::vector<std::uint16_t>(registers)});
  return server;
}

void ModbusServer::accept_client() noexcept {
  const int fd = ::accept4(listening_, nullptr, nullptr, SOCK_CLOEXEC);
  if (fd < 0) return;
  // The oldest connection gives way: a tool that died without a word does not lock the others out.
  if (clients_.size() >= kMostClients) {
    ::close(clients_.front().fd);
    clients_.erase(clients_.begin());
  }
  clients_.push_back({fd, std::vector<std::uint16_t>(static_cast<std::size_t>(layout_.mailbox_registers))});
}

void ModbusServer::open_mailbox(Client& client, CommandHandler& handler, int registers) noexcept {
  const std::uint16_t* const box = mapping_->tab_registers + layout_.mailbox;
  std::vector<std::uint8_t> request(static_cast<std::size_t>(2 * (registers - 1)));
  for (std::size_t i = 0; i < request.size(); ++i)
    request[i] = static_cast<std::uint8_t>(i % 2 == 0 ? box[1 + i / 2] >> 8 : box[1 + i / 2] & 0xff);
  std::uint8_t reply[256] = {};
  std::uint32_t size = 0;
  if (box[0] <= request.size()) size = handler.answer(request.data(), box[0], reply);
  const auto room = static_cast<std::uint32_t>(2 * (layout_.mailbox_registers - 1));
  size = std::min(size, room);
  client.reply.assign(client.reply.size(), 0);
  client.reply[0] = static_cast<std::uint16_t>(size);
  for (std::uint32_t i = 0; i < size; ++i) {
    const unsigned shift = i % 2 == 0 ? 8 : 0;
    client.reply[1 + i / 2] = static_cast<std::uint16_t>(client.reply[1 + i / 2] | reply[i] << shift);
  }
}

bool ModbusServer::respond(Client& client, CommandHandler& handler, const std::uint8_t* query,
                           int size) noexcept {
  const int header = modbus_get_header_length(context_);
  if (size < header + 5) return false;
  const int function = query[header], address = word_at(query + header + 1),
            count = word_at(query + header + 3);
  const auto refuse = [&](unsigned code) { return modbus_reply_exception(context_, query, code) >= 0; };
  const int mailbox_end = layout_.mailbox + layout_.mailbox_registers;
  const bool in_mailbox = address >= layout_.mailbox && address + count <= mailbox_end;
  if (function == kReadInput) {
    if (address + count <= layout_.live_registers) handler.fill_registers(mapping_->tab_input_registers);
    std::copy(client.reply.begin(), client.reply.end(), mapping_->tab_input_registers + layout_.mailbox);
  } else if (function == kWriteOne) {
    if (address != 0) return refuse(MODBUS_EXCEPTION_ILLEGAL_DATA_ADDRESS);
    if (!handler.give(static_cast<std::uint16_t>(count))) return refuse(MODBUS_EXCEPTION_ILLEGAL_DATA_VALUE);
  } else if (function == kWriteMany) {
    if (!in_mailbox || address != layout_.mailbox || count < 2)
      return refuse(MODBUS_EXCEPTION_ILLEGAL_DATA_ADDRESS);
    if (size < header + 6 + 2 * count) return refuse(MODBUS_EXCEPTION_ILLEGAL_DATA_VALUE);
  } else if (function != kReadHolding) {
    return refuse(MODBUS_EXCEPTION_ILLEGAL_FUNCTION);
  }
  const bool sent = modbus_reply(context_, query, size, mapping_) >= 0;
  if (function == kWriteMany) open_mailbox(client, handler, count);
  return sent;
}

bool ModbusServer::serve_client(Client& client, CommandHandler& handler) noexcept {
  std::uint8_t query[MODBUS_MAX_ADU_LENGTH] = {};
  modbus_set_socket(context_, client.fd);
  const int size = modbus_receive(context_, query);
  if (size == 0) return true;  // a request to another unit on the line
  const bool serial = listening_ < 0;
  if (size < 0) {
    // Noise on a line is thrown away; a connection that broke, or whose peer lies about lengths, is closed.
    if (serial) modbus_flush(context_);
    return serial;
  }
  return respond(client, handler, query, size) || serial;
}

std::uint32_t ModbusServer::handles(int* handles, std::uint32_t room) const noexcept {
  std::uint32_t count = 0;
  if (listening_ >= 0 && room > 0) handles[count++] = listening_;
  for (const Client& client : clients_)
    if (count < room) handles[count++] = client.fd;
  return count;
}

HalFault ModbusServer::serve(CommandHandler& handler, TimeUs wait) noexcept {
  std::vector<pollfd> waiting;
  for (const Client& client : clients_) waiting.push_back({client.fd, POLLIN, 0});
  if (listening_ >= 0) waiting.push_back({listening_, POLLIN, 0});
  const int ready = ::poll(waiting.data(), waiting.size(), static_cast<int>(wait.count / 1000));
  if (ready < 0) return errno == EINTR ? HalFault::kNone : HalFault::kRefused;
  if (ready == 0) return HalFault::kNone;
  for (std::size_t i = clients_.size(); i-- > 0;) {
    if (waiting[i].revents == 0) continue;
    if (serve_client(clients_[i], handler)) continue;
    ::close(clients_[i].fd);
    clients_.erase(clients_.begin() + static_cast<std::ptrdiff_t>(i));
  }
  if (listening_ >= 0 && waiting.back().revents != 0) accept_client();
  return HalFault::kNone;
}

}  // namespace vernier
