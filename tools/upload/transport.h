// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <chrono>
#include <cstdint>
#include <thread>
#include <vector>

namespace vernier::upload {

/// Connection that sends one request at a time to a board and returns the board's reply
/// (tables/link_format.h).
class Transport {
 public:
  virtual ~Transport() = default;
  /// request: at most kMaxRequestBytes bytes. Throws InputError if the board does not reply; later requests
  /// over the same connection are possible.
  virtual std::vector<std::uint8_t> ask(const std::vector<std::uint8_t>& request) = 0;
  /// Waits for `time` before a request is sent again to a busy board.
  virtual void pause(std::chrono::milliseconds time) { std::this_thread::sleep_for(time); }
};

}  // namespace vernier::upload
