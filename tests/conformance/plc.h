// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <modbus.h>

#include <atomic>
#include <chrono>
#include <cstdint>
#include <mutex>
#include <string>
#include <thread>
#include <vector>

namespace vernier {

/// A controller whose registers libmodbus's own server serves. Its program copies the sequence number to the
/// echo after each block, and keeps each block that came.
class Plc {
 public:
  using Clock = std::chrono::steady_clock;
  static constexpr int kBlock = 100, kEcho = 50;
  struct Block {
    Clock::time_point when;
    std::uint16_t sequence = 0, valid = 0;
    std::vector<std::int32_t> values;
  };

  /// Over TCP: any free port of this computer.
  Plc();
  /// On a serial line, which is a pseudo terminal: path() is the board's end.
  struct Serial {};
  explicit Plc(Serial);
  ~Plc();
  Plc(const Plc&) = delete;
  Plc& operator=(const Plc&) = delete;

  int port() const { return port_; }
  const std::string& path() const { return path_; }
  std::vector<Block> blocks() const;
  /// Waits until `count` more blocks have come; false after two seconds.
  bool wait_for_blocks(std::size_t count) const;
  void forget();
  /// Puts a value with its valid bit into the block, as a killed board leaves it. Call before a board opens.
  void leave(int place, std::int32_t value);

  std::atomic<bool> stuck{false};    // the program stands still: no echo
  std::atomic<bool> gone{false};     // connections are closed, and none is answered
  std::atomic<bool> forgets{false};  // while it is gone, its registers become zero: a restart
  std::atomic<int> late_ms{0};       // each answer comes so late
  std::atomic<int> lost_answers{0};  // so many requests arrive and their answers do not

 private:
  void serve();
  void answer(modbus_t* context, const std::uint8_t* query, int size);

  modbus_mapping_t* const registers_;
  modbus_t* context_ = nullptr;
  std::string path_;
  int listening_ = -1, port_ = 0, line_ = -1, nowhere_ = -1;
  mutable std::mutex guard_;
  std::vector<Block> blocks_;
  std::atomic<bool> stop_{false};
  std::thread thread_;
};

}  // namespace vernier
