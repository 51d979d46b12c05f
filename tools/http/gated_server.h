// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <httplib.h>

#include "tools/http/types.h"

namespace vernier::http {

class WaitingRoom;

/// An HTTP server that assigns a thread to a connection only after a complete request header has arrived.
/// Connections without a complete header wait together in one thread. If more than `most_waiting` connections
/// wait, the server closes the oldest connection of the IP address that has the most connections. Half-open
/// connections cannot block a new request, because the server closes the oldest of too many waiting
/// connections. Handlers and addresses are set in the same way as for httplib::Server.
class GatedServer : public httplib::Server {
 public:
  explicit GatedServer(const ServerLimits& limits = {});

 private:
  bool process_and_close_socket(socket_t socket) override;

  WaitingRoom* room_ = nullptr;  // owned by the HTTP library while the server listens; used by the listening
                                 // thread
};

}  // namespace vernier::http
