// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/http/gated_server.h"

#include <sys/socket.h>

#include "tools/http/waiting_room.h"

namespace vernier::http {

GatedServer::GatedServer(const ServerLimits& limits) {
  // Not the library's default, which lets another process of this user listen on the same port.
  set_socket_options([](socket_t socket) {
    const int yes = 1;
    ::setsockopt(socket, SOL_SOCKET, SO_REUSEADDR, &yes, sizeof yes);
  });
  new_task_queue = [this, limits]() -> httplib::TaskQueue* {
    // The library lets five connections wait for the accepting thread; the kernel drops others for a second.
    ::listen(svr_sock_, SOMAXCONN);
    room_ = new WaitingRoom(limits, [this](httplib::Stream& stream, bool last) {
      bool closed = false;
      return process_request(stream, last, closed, nullptr) && !closed;
    });
    return room_;
  };
}

bool GatedServer::process_and_close_socket(socket_t socket) {
  room_->enter(socket);
  return true;
}

}  // namespace vernier::http
