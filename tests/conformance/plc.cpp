// SPDX-License-Identifier: GPL-3.0-or-later
#include "tests/conformance/plc.h"

#include <arpa/inet.h>
#include <fcntl.h>
#include <netinet/in.h>
#include <poll.h>
#include <sys/socket.h>
#include <unistd.h>

#include "tests/conformance/raw_terminal.h"

namespace vernier {
namespace {

constexpr int kRegisters = 300, kPoll_ms = 5;

bool has_input(int fd) {
  pollfd one{fd, POLLIN, 0};
  return ::poll(&one, 1, 0) > 0;
}

}  // namespace

Plc::Plc() : registers_(modbus_mapping_new(0, 0, kRegisters, 0)), context_(modbus_new_tcp("127.0.0.1", 0)) {
  listening_ = modbus_tcp_listen(context_, 4);
  sockaddr_in address{};
  socklen_t size = sizeof address;
  ::getsockname(listening_, reinterpret_cast<sockaddr*>(&address), &size);
  port_ = ntohs(address.sin_port);
  thread_ = std::thread([this] { serve(); });
}

Plc::Plc(Serial)
    : registers_(modbus_mapping_new(0, 0, kRegisters, 0)),
      context_(modbus_new_rtu("/dev/null", 115200, 'N', 8, 1)),
      line_(raw_terminal(path_)),
      nowhere_(::open("/dev/null", O_WRONLY | O_CLOEXEC)) {
  modbus_set_socket(context_, line_);
  modbus_set_slave(context_, 1);
  // A damaged request ends with the next pause of the line, as the standard asks (Modbus over serial
  // line, 2.5).
  modbus_set_byte_timeout(context_, 0, 5'000);
  modbus_set_error_recovery(context_, MODBUS_ERROR_RECOVERY_PROTOCOL);
  thread_ = std::thread([this] { serve(); });
}

Plc::~Plc() {
  stop_ = true;
  thread_.join();
  if (listening_ >= 0) ::close(listening_);
  if (line_ >= 0) ::close(line_);
  if (nowhere_ >= 0) ::close(nowhere_);
  modbus_free(context_);
  modbus_mapping_free(registers_);
}

std::vector<Plc::Block> Plc::blocks() const {
  const std::scoped_lock lock(guard_);
  return blocks_;
}

void Plc::forget() {
  const std::scoped_lock lock(guard_);
  blocks_.clear();
}

void Plc::leave(int place, std::int32_t value) {
  std::uint16_t* const block = registers_->tab_registers + kBlock;
  block[1] = static_cast<std::uint16_t>(block[1] | 1u << place);
  block[2 + 2 * place] = static_cast<std::uint16_t>(static_cast<std::uint32_t>(value) >> 16);
  block[3 + 2 * place] = static_cast<std::uint16_t>(value);
}

bool Plc::wait_for_blocks(std::size_t count) const {
  const std::size_t wanted = blocks().size() + count;
  for (int i = 0; i < 2000 && blocks().size() < wanted; ++i)
    std::this_thread::sleep_for(std::chrono::milliseconds(1));
  return blocks().size() >= wanted;
}

void Plc::answer(modbus_t* context, const std::uint8_t* query, int size) {
  std::this_thread::sleep_for(std::chrono::milliseconds(late_ms));
  const int function = query[modbus_get_header_length(context)];
  if (lost_answers > 0) {
    --lost_answers;
    modbus_set_socket(context, nowhere_);
  }
  modbus_reply(context, query, size, registers_);
  if (function != MODBUS_FC_WRITE_MULTIPLE_REGISTERS) return;
  const std::uint16_t* const block = registers_->tab_registers + kBlock;
  if (!stuck) registers_->tab_registers[kEcho] = block[0];
  Block kept{Clock::now(), block[0], block[1], {}};
  for (int place = 0; place < 3; ++place)
    kept.values.push_back(static_cast<std::int32_t>(std::uint32_t{block[2 + 2 * place]} << 16 |
                                                    std::uint32_t{block[3 + 2 * place]}));
  const std::scoped_lock lock(guard_);
  blocks_.push_back(kept);
}

void Plc::serve() {
  std::uint8_t query[MODBUS_TCP_MAX_ADU_LENGTH];
  std::vector<int> peers;
  if (line_ >= 0) peers.push_back(line_);
  while (!stop_) {
    if (gone) {
      if (forgets) std::fill_n(registers_->tab_registers, registers_->nb_registers, std::uint16_t{0});
      if (line_ >= 0 && has_input(line_)) (void)!::read(line_, query, sizeof query);
      for (const int peer : peers)
        if (peer != line_) ::close(peer);
      if (line_ < 0) peers.clear();
      std::this_thread::sleep_for(std::chrono::milliseconds(1));
      continue;
    }
    std::vector<pollfd> polled = {{listening_, POLLIN, 0}};
    for (const int peer : peers) polled.push_back({peer, POLLIN, 0});
    if (::poll(polled.data(), polled.size(), kPoll_ms) <= 0) continue;
    for (std::size_t i = 1; i < polled.size(); ++i) {
      if (polled[i].revents == 0) continue;
      modbus_set_socket(context_, polled[i].fd);
      const int size = modbus_receive(context_, query);
      if (size > 0) answer(context_, query, size);
      if (size >= 0 || polled[i].fd == line_) continue;
      ::close(polled[i].fd);
      std::erase(peers, polled[i].fd);
    }
    if (polled[0].revents != 0) peers.push_back(::accept(listening_, nullptr, nullptr));
  }
  for (const int peer : peers)
    if (peer != line_) ::close(peer);
}

}  // namespace vernier
