// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <chrono>
#include <cstdint>
#include <thread>
#include <vector>

namespace vernier::upload {

/// Sends one request to a board and returns its reply (tables/link_format.h).
class Transport {
 public:
  virtual ~Transport() = default;
  /// request: at most kMaxRequestBytes. Throws InputError without a reply; the transport can be used again.
  virtual std::vector<std::uint8_t> ask(const std::vector<std::uint8_t>& request) = 0;
  /// Waits before a busy board is asked again.
  virtual void pause(std::chrono::milliseconds time) { std::this_thread::sleep_for(time); }
};

}  // namespace vernier::upload
