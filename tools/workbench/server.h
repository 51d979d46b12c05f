// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <cstdint>
#include <memory>
#include <string>

#include "tools/workbench/api.h"

namespace vernier::workbench {

/// Largest body of a request, bytes.
inline constexpr std::size_t kMostBodyBytes = std::size_t{64} << 20;

/// Returns 32 random bytes as hexadecimal digits, from the system's random numbers.
std::string new_token();

/// Serves the page and its API on 127.0.0.1. A request is answered only under three conditions. The request
/// names this host and port (no other name for it: DNS rebinding), comes from no other origin, and carries
/// the session's token as a cookie. The printed address sets the cookie once. A request that writes must also
/// carry the header X-Vernier.
class WorkbenchServer {
 public:
  /// port 0: any free port. Throws InputError if the port is in use.
  WorkbenchServer(Api& api, std::uint16_t port);
  ~WorkbenchServer();
  WorkbenchServer(const WorkbenchServer&) = delete;
  WorkbenchServer& operator=(const WorkbenchServer&) = delete;

  std::uint16_t port() const;
  const std::string& token() const;
  /// Returns the address to open, with the token.
  std::string url() const;
  /// Serves until stop(), which any thread may call.
  void serve();
  void stop();

 private:
  struct Inside;
  std::unique_ptr<Inside> inside_;
};

}  // namespace vernier::workbench
