// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "hal/command_link.h"

struct _modbus;
struct _modbus_mapping_t;

namespace vernier {

/// Where things stand in the register map. The mailbox: a request is written (function 16) to the holding
/// registers from `mailbox` on, its length in bytes, then the bytes, high byte first; the reply stands in the
/// input registers there, for each client its own. Input registers from 0: live state; holding register 0:
/// command (function 6).
struct ModbusLayout {
  int mailbox = 0, mailbox_registers = 0, live_registers = 0;
};

/// A Modbus server (libmodbus) over TCP for a few clients at a time, or over a serial line. Functions 3, 4, 6
/// and 16; everything else is refused with the exceptions of the standard.
class ModbusServer : public CommandLink {
 public:
  /// address: numeric, "127.0.0.1"; port 0 takes any free one. Null with `error` set where it cannot listen.
  /// setup.
  static std::unique_ptr<ModbusServer> tcp(const std::string& address, int port, const ModbusLayout& layout,
                                           std::string& error);
  /// device: "/dev/ttyS1"; 8 data bits, `parity` N, E or O, one stop bit; unit: 1..247. setup.
  static std::unique_ptr<ModbusServer> rtu(const std::string& device, int baud, char parity, int unit,
                                           const ModbusLayout& layout, std::string& error);
  ~ModbusServer() override;
  ModbusServer(const ModbusServer&) = delete;
  ModbusServer& operator=(const ModbusServer&) = delete;

  HalFault serve(CommandHandler& handler, TimeUs wait) noexcept override;
  std::uint32_t handles(int* handles, std::uint32_t room) const noexcept override;
  /// The port that it listens on; 0 on a serial line.
  int port() const noexcept { return port_; }

 private:
  /// The serial line, or a connection, with the reply that stands in its mailbox.
  struct Client {
    int fd;
    std::vector<std::uint16_t> reply;
  };

  ModbusServer(_modbus* context, const ModbusLayout& layout);
  void accept_client() noexcept;
  bool serve_client(Client& client, CommandHandler& handler) noexcept;
  bool respond(Client& client, CommandHandler& handler, const std::uint8_t* query, int size) noexcept;
  void open_mailbox(Client& client, CommandHandler& handler, int registers) noexcept;

  _modbus* context_;
  _modbus_mapping_t* mapping_;
  ModbusLayout layout_;
  int listening_ = -1, port_ = 0;
  std::vector<Client> clients_;
};

}  // namespace vernier
