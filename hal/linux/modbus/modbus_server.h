// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "hal/command_link.h"
#include "hal/linux/modbus/modbus_conversation.h"

struct _modbus;

namespace vernier {

/// A Modbus server over TCP for a few clients, or over a serial line (which libmodbus opens). No client can
/// block the server: the server reads and writes only what is available. The server closes a connection if a
/// request is not complete within half a second of its first byte, or a reply is not taken within a second.
/// Sixteen clients keep their places while they send requests. A further client without a valid signature
/// makes room for the next client after half a second. A client that signed keeps its place. A peer with more
/// clients than another peer makes room for the other peer.
class ModbusServer : public CommandLink {
 public:
  /// address: numeric, "127.0.0.1"; port 0: any free port. Returns null with `error` set if the server cannot
  /// listen. Not real-time safe.
  static std::unique_ptr<ModbusServer> tcp(const std::string& address, int port, const ModbusLayout& layout,
                                           std::string& error);
  /// device: "/dev/ttyS1"; 8 data bits, `parity` N, E or O, one stop bit; unit: 1..247. Not real-time safe.
  static std::unique_ptr<ModbusServer> rtu(const std::string& device, int baud, char parity, int unit,
                                           const ModbusLayout& layout, std::string& error);
  ~ModbusServer() override;
  ModbusServer(const ModbusServer&) = delete;
  ModbusServer& operator=(const ModbusServer&) = delete;

  HalFault serve(CommandHandler& handler, TimeUs wait) noexcept override;
  std::uint32_t handles(int* handles, std::uint32_t room) const noexcept override;
  /// Returns the port on which the server listens; 0 on a serial line.
  int port() const noexcept { return port_; }

 private:
  struct Client {
    int fd;
    ModbusConversation talk;
    std::uint32_t peer;  // IPv4 address
    InstantNs since;
  };
  struct Arrival {
    int fd;
    std::uint32_t peer;
  };

  ModbusServer(const ModbusLayout& layout, int unit, InstantNs frame_time)
      : layout_(layout), unit_(unit), frame_time_(frame_time) {}
  void accept_arrivals();
  void admit_arrivals(CommandHandler& handler, InstantNs now);
  void remove(std::size_t client, CommandHandler& handler) noexcept;
  std::size_t places_of(std::uint32_t peer) const noexcept;
  bool may_go(std::size_t index, std::size_t places, InstantNs now) const noexcept;
  std::size_t first_to_go(std::size_t places, InstantNs now) const noexcept;
  bool serve_client(Client& client, CommandHandler& handler, InstantNs now) noexcept;
  bool receive(Client& client, InstantNs now) noexcept;
  bool send(Client& client) noexcept;

  ModbusLayout layout_;
  int unit_;
  InstantNs frame_time_;
  _modbus* line_ = nullptr;  // of a serial line, which is the only client then
  int listening_ = -1, port_ = 0;
  std::vector<Client> clients_;    // in the order in which they came in
  std::vector<Arrival> arrivals_;  // connected, without a place
  std::uint64_t connections_ = 0;  // so far
};

}  // namespace vernier
