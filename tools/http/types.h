// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <chrono>
#include <cstddef>

namespace vernier::http {

/// Limits of a server. The times are for local networks, in which a header of a few kilobytes takes
/// milliseconds.
struct ServerLimits {
  std::size_t threads = 8;  // requests that are answered together
  /// Connections whose request, header and body, is not complete; the library cannot serve sockets above
  /// 1023.
  std::size_t most_waiting = 200;
  std::chrono::milliseconds header{5000};     // from the first byte of a header to its last
  std::chrono::milliseconds idle{30'000};     // without a byte
  std::chrono::milliseconds body{20'000};     // from the last byte of a header to the last byte of its body
  std::chrono::milliseconds request{60'000};  // writing the answer
  std::chrono::milliseconds pause{5000};      // between two bytes of an answer
  /// Longest body that is waited for; a request with a longer one is handed over for its refusal.
  std::size_t most_body = std::size_t{64} << 20;
  /// Largest total size of the incomplete requests, bytes; above this size the server closes the largest
  /// request.
  std::size_t most_bytes = std::size_t{256} << 20;
};

}  // namespace vernier::http
