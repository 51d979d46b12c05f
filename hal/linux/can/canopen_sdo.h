// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <string>
#include <vector>

#include "hal/linux/can/canopen_drive.h"

namespace vernier {

/// An entry of an object dictionary.
struct CanopenObject {
  std::uint16_t index = 0x60b0;
  std::uint8_t subindex = 0;
};

/// Reads entries of the object dictionary of a node (SDO upload, expedited). Source: CiA 301, 7.2.4.3. The
/// board only reads, and only before the first tick: a node has one SDO server for one client at a time.
class CanopenSdo {
 public:
  /// interface: as for open_can(). node: 1 .. 127. Null socket with `error` set. Not real-time safe.
  CanopenSdo(const std::string& interface, std::uint32_t node, std::string& error);
  /// Takes ownership of the socket. Any socket is possible that preserves the boundaries of frames and does
  /// not block. Not real-time safe.
  CanopenSdo(int socket, std::uint32_t node) : socket_(socket), node_(node) {}
  ~CanopenSdo();
  CanopenSdo(const CanopenSdo&) = delete;
  CanopenSdo& operator=(const CanopenSdo&) = delete;

  /// Reads a value of 1 to 4 bytes. Returns empty, or the reason. Waits at most kWait. Not real-time safe.
  std::string read(CanopenObject object, std::uint32_t& value);
  /// Finds the RPDO with this identifier. Empty, or how its mapping differs from one value of 32 bits of
  /// `object` that the drive uses with the next SYNC, or which other RPDO also writes `object`.
  /// Not real-time safe.
  std::string check_offset(std::uint32_t rpdo, CanopenObject object);
  /// As check_offset() for the TPDO: statusword, then position actual value, with each SYNC.
  /// Not real-time safe.
  std::string check_position(std::uint32_t tpdo);

  static constexpr int kWaitMs = 300;

 private:
  /// What the board needs of a PDO.
  struct Pdo {
    const char* name;
    std::uint16_t communication;  // index of the parameters of the first one
    std::uint32_t id;
    std::vector<std::uint32_t> mapped;
    std::uint32_t first_type, last_type;  // transmission types
    bool is_alone;                        // no other PDO may have its objects
  };
  std::string check_mapping(const Pdo& pdo);
  std::string check_contents(const Pdo& pdo, std::uint16_t at);
  std::string check_other(const Pdo& pdo, std::uint16_t at);

  int socket_;
  std::uint32_t node_;
  bool silent_ = false;  // the last request had no answer
};

}  // namespace vernier
