// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <cstdint>
#include <memory>
#include <string>

#include "tools/workbench/api.h"

namespace vernier::workbench {

/// Largest permitted body of a request, bytes.
inline constexpr std::size_t kMostBodyBytes = std::size_t{64} << 20;

/// Returns an access token: 32 random bytes from the operating system, as hexadecimal digits.
std::string new_token();

/// HTTP server of the workbench page and its API, at the address 127.0.0.1. The workbench server answers a
/// request only if the request meets three conditions. The request must name the host and port of this
/// server (protection against DNS rebinding), have no other origin, and contain the session token as a
/// cookie. When the user opens the printed address, the browser stores the session token as a cookie. A
/// request that writes data must also have the header X-Vernier.
class WorkbenchServer {
 public:
  /// `port`: 0 selects any free port. Throws InputError if another program uses the port.
  WorkbenchServer(Api& api, std::uint16_t port);
  ~WorkbenchServer();
  WorkbenchServer(const WorkbenchServer&) = delete;
  WorkbenchServer& operator=(const WorkbenchServer&) = delete;

  std::uint16_t port() const;
  const std::string& token() const;
  /// Returns the address of the page, with the token.
  std::string url() const;
  /// Serves requests until stop() is called. Any thread may call stop().
  void serve();
  void stop();

 private:
  struct Inside;
  std::unique_ptr<Inside> inside_;
};

}  // namespace vernier::workbench
