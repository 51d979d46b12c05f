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
/// block the server, because the server reads and writes only what is possible without waiting. The server
/// closes a connection if a request is not complete within half a second after its first byte, or if a reply
/// is not read within a second. Up to sixteen clients keep their connections while they send requests. An
/// additional client without a valid signature is disconnected after half a second if another client wants to
/// connect. A client that has sent a valid signature stays connected. If one peer has more clients than
/// another peer, a client of the first peer is disconnected for a client of the second peer.
class ModbusServer : public CommandLink {
 public:
  /// `address`: numeric, for example "127.0.0.1"; `port`: 0 selects any free port. Returns null and the
  /// reason in `error` if the server cannot listen. Not real-time safe.
  static std::unique_ptr<ModbusServer> tcp(const std::string& address, int port, const ModbusLayout& layout,
                                           std::string& error);
  /// `device`: for example "/dev/ttyS1", with 8 data bits, `parity` N, E or O, and one stop bit; `unit`:
  /// 1..247. Not real-time safe.
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
  _modbus* line_ = nullptr;  // serial line, which is then the only client
  int listening_ = -1, port_ = 0;
  std::vector<Client> clients_;    // in the order of their connection
  std::vector<Arrival> arrivals_;  // connected clients that are not yet served
  std::uint64_t connections_ = 0;  // number of connections since the start
};

}  // namespace vernier
