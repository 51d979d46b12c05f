// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <chrono>
#include <cstddef>

namespace vernier::http {

/// Limits of an HTTP server. The times are for local networks, in which the transmission of a header of a few
/// kilobytes takes milliseconds.
struct ServerLimits {
  std::size_t threads = 8;  // number of requests that are answered at the same time
  /// Largest number of connections whose request (header and body) is incomplete. The HTTP library cannot
  /// serve sockets above 1023.
  std::size_t most_waiting = 200;
  std::chrono::milliseconds header{5000};  // longest time from the first byte of a header to its last byte
  std::chrono::milliseconds idle{30'000};  // longest time without a byte
  /// Longest time from the last byte of a header to the last byte of its body
  std::chrono::milliseconds body{20'000};
  std::chrono::milliseconds request{60'000};  // longest time to write the answer
  std::chrono::milliseconds pause{5000};      // longest time between two bytes of an answer
  /// Largest body for which the server waits. A request with a larger body is passed on and then refused.
  std::size_t most_body = std::size_t{64} << 20;
  /// Largest total size of the incomplete requests, bytes; above this size the server closes the largest
  /// request.
  std::size_t most_bytes = std::size_t{256} << 20;
};

}  // namespace vernier::http
