// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <httplib.h>

#include "tools/http/types.h"

namespace vernier::http {

class WaitingRoom;

/// An HTTP server that assigns a thread to a connection only when a complete request header has arrived.
/// Connections without a complete header wait together. If more than `most_waiting` wait, the server closes
/// the oldest connection of the peer (address) that has the most. Therefore half-open connections cannot keep
/// out a new request. Handlers and addresses are set as in httplib::Server.
class GatedServer : public httplib::Server {
 public:
  explicit GatedServer(const ServerLimits& limits = {});

 private:
  bool process_and_close_socket(socket_t socket) override;

  WaitingRoom* room_ = nullptr;  // owned by the library while it listens; used by the listening thread
};

}  // namespace vernier::http
