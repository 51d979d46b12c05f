// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <httplib.h>

#include <condition_variable>
#include <deque>
#include <functional>
#include <list>
#include <memory>
#include <mutex>
#include <set>
#include <thread>
#include <vector>

#include "tools/http/connection.h"
#include "tools/http/types.h"

namespace vernier::http {

/// Function that answers one request. `last`: true if the connection is closed after this request. The
/// function returns false if the connection cannot be used again.
using Answer = std::function<bool(httplib::Stream& stream, bool last)>;

/// The connections of a GatedServer. One thread waits for headers, and several threads answer requests.
/// WaitingRoom is also the task queue of the HTTP library. The task queue executes a task immediately,
/// because a task only adds a connection (`enter`).
class WaitingRoom : public httplib::TaskQueue {
 public:
  WaitingRoom(const ServerLimits& limits, Answer answer);
  ~WaitingRoom() override { shutdown(); }
  WaitingRoom(const WaitingRoom&) = delete;
  WaitingRoom& operator=(const WaitingRoom&) = delete;

  void enqueue(std::function<void()> task) override { task(); }
  /// Closes the connections, and returns after the last handler has returned.
  void shutdown() override;
  /// Adds a connection that was just accepted.
  void enter(int socket);

 private:
  using Kept = std::unique_ptr<Connection>;
  void watch();
  void answer_requests();
  void wake() const;
  void admit(std::list<Kept>& waiting);
  void read(std::list<Kept>& waiting, std::list<Kept>::iterator one);
  void make_room(std::list<Kept>& waiting) const;
  void hand_over(Kept connection);

  const ServerLimits limits_;
  const Answer answer_;
  int wake_ = -1;  // eventfd
  std::mutex guard_;
  std::condition_variable something_ready_;
  std::deque<Kept> entered_, ready_;
  std::set<int> answered_;  // sockets whose requests are being answered
  bool ended_ = false;
  std::vector<std::thread> threads_;
};

}  // namespace vernier::http
