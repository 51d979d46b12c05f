// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <string>
#include <vector>

#include "hal/linux/can/canopen_drive.h"

namespace vernier {

/// Address of an entry in an object dictionary.
struct CanopenObject {
  std::uint16_t index = 0x60b0;
  std::uint8_t subindex = 0;
};

/// Reads entries of the object dictionary of a node (SDO upload, expedited). Source: CiA 301, 7.2.4.3. The
/// board only reads, and only before the first tick, because the SDO server of a node serves one client at a
/// time.
class CanopenSdo {
 public:
  /// `interface`: as for open_can(). `node`: 1 to 127. If the socket cannot be opened, the constructor sets
  /// `error`. Not real-time safe.
  CanopenSdo(const std::string& interface, std::uint32_t node, std::string& error);
  /// Takes ownership of the socket. The socket must preserve the boundaries of frames and must not block. Not
  /// real-time safe.
  CanopenSdo(int socket, std::uint32_t node) : socket_(socket), node_(node) {}
  ~CanopenSdo();
  CanopenSdo(const CanopenSdo&) = delete;
  CanopenSdo& operator=(const CanopenSdo&) = delete;

  /// Reads a value of 1 to 4 bytes. read() returns an empty text, or the reason of a failure. read() waits
  /// for at most kWaitMs. Not real-time safe.
  std::string read(CanopenObject object, std::uint32_t& value);
  /// Tests the RPDO with the identifier `rpdo`. The result of check_offset() is empty if the RPDO is mapped
  /// to one 32-bit value of `object` that the drive uses with the next SYNC. If the RPDO is not suitable, the
  /// result describes the difference, or names another RPDO that also writes `object`. Not real-time safe.
  std::string check_offset(std::uint32_t rpdo, CanopenObject object);
  /// Tests the TPDO like check_offset(). The TPDO must contain the statusword and then the position actual
  /// value, with each SYNC. Not real-time safe.
  std::string check_position(std::uint32_t tpdo);

  static constexpr int kWaitMs = 300;

 private:
  /// Properties of a PDO that the board requires.
  struct Pdo {
    const char* name;
    std::uint16_t communication;  // index of the communication parameters of the first PDO
    std::uint32_t id;
    std::vector<std::uint32_t> mapped;
    std::uint32_t first_type, last_type;  // range of the transmission types
    bool is_alone;                        // true: no other PDO may contain its objects
  };
  std::string check_mapping(const Pdo& pdo);
  std::string check_contents(const Pdo& pdo, std::uint16_t at);
  std::string check_other(const Pdo& pdo, std::uint16_t at);

  int socket_;
  std::uint32_t node_;
  bool silent_ = false;  // true: the last request was not answered
};

}  // namespace vernier
