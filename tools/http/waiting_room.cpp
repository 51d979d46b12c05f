// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/http/waiting_room.h"

#include <poll.h>
#include <sys/eventfd.h>
#include <sys/socket.h>
#include <unistd.h>

#include <algorithm>
#include <map>
#include <string_view>

namespace vernier::http {
namespace {

/// Longest request header. The library itself refuses lines above 8 KiB with their own status.
constexpr std::size_t kMostHeaderBytes = 65536;

void refuse_late(const Connection& connection) {
  constexpr std::string_view kLate = "HTTP/1.1 408 Request Timeout\r\nConnection: close\r\n\r\n";
  (void)!::send(connection.fd, kLate.data(), kLate.size(), MSG_NOSIGNAL | MSG_DONTWAIT);
}

}  // namespace

WaitingRoom::WaitingRoom(const ServerLimits& limits, Answer answer)
    : limits_(limits), answer_(std::move(answer)), wake_(::eventfd(0, EFD_CLOEXEC | EFD_NONBLOCK)) {
  threads_.emplace_back([this] { watch(); });
  for (std::size_t i = 0; i < limits_.threads; ++i) threads_.emplace_back([this] { answer_requests(); });
}

void WaitingRoom::shutdown() {
  {
    const std::scoped_lock lock(guard_);
    if (ended_) return;
    ended_ = true;
    // A thread that reads a body ends its wait; an answer is still written.
    for (const int fd : answered_) ::shutdown(fd, SHUT_RD);
  }
  wake();
  something_ready_.notify_all();
  for (std::thread& one : threads_) one.join();
  ::close(wake_);
}

void WaitingRoom::wake() const {
  const std::uint64_t one = 1;
  (void)!::write(wake_, &one, sizeof one);
}

void WaitingRoom::enter(int socket) {
  auto connection = std::make_unique<Connection>(socket);
  connection->due = Clock::now() + limits_.header;  // a client that connects has something to ask
  {
    const std::scoped_lock lock(guard_);
    entered_.push_back(std::move(connection));
  }
  wake();
}

void WaitingRoom::hand_over(Kept connection) {
  {
    const std::scoped_lock lock(guard_);
    if (ready_.size() >= limits_.most_waiting) return;  // closes the connection
    ready_.push_back(std::move(connection));
  }
  something_ready_.notify_one();
}

void WaitingRoom::make_room(std::list<Kept>& waiting) const {
  while (waiting.size() > limits_.most_waiting) {
    std::map<std::string_view, std::size_t> count;
    for (const Kept& one : waiting) ++count[one->peer];
    const auto most = std::max_element(count.begin(), count.end(),
                                       [](const auto& a, const auto& b) { return a.second < b.second; });
    waiting.erase(std::find_if(waiting.begin(), waiting.end(),
                               [&](const Kept& one) { return one->peer == most->first; }));
  }
  const auto bytes = [&] {
    std::size_t sum = 0;
    for (const Kept& one : waiting) sum += one->bytes.size();
    return sum;
  };
  while (bytes() > limits_.most_bytes)
    waiting.erase(std::max_element(waiting.begin(), waiting.end(), [](const Kept& a, const Kept& b) {
      return a->bytes.size() < b->bytes.size();
    }));
}

void WaitingRoom::read(std::list<Kept>& waiting, std::list<Kept>::iterator one) {
  Connection& connection = **one;
  const bool was_empty = connection.bytes.empty();
  const bool open = connection.take_bytes();
  const bool had_header = connection.header_bytes > 0;
  if (was_empty && !connection.bytes.empty()) connection.due = Clock::now() + limits_.header;
  if (connection.has_header() && !had_header) connection.due = Clock::now() + limits_.body;
  // The library answers a request that ends too early; it does not wait, because the connection has ended.
  if (connection.has_request(limits_.most_body) || (!open && !connection.bytes.empty()))
    hand_over(std::move(*one));
  else if (open && (connection.has_header() || connection.bytes.size() <= kMostHeaderBytes))
    return;
  waiting.erase(one);
}

void WaitingRoom::admit(std::list<Kept>& waiting) {
  std::deque<Kept> entered;
  {
    const std::scoped_lock lock(guard_);
    entered.swap(entered_);
  }
  // A request that came with its connection is answered without a place in the room.
  for (Kept& one : entered) {
    waiting.push_back(std::move(one));
    if (waiting.back()->has_request(limits_.most_body)) {
      hand_over(std::move(waiting.back()));
      waiting.pop_back();
    } else {
      read(waiting, std::prev(waiting.end()));
    }
    make_room(waiting);
  }
}

void WaitingRoom::watch() {
  std::list<Kept> waiting;  // the oldest first
  std::vector<pollfd> polled;
  while (true) {
    {
      const std::scoped_lock lock(guard_);
      if (ended_) return;
    }
    polled.assign(1, {wake_, POLLIN, 0});
    Clock::time_point next = Clock::now() + limits_.idle;
    for (const Kept& one : waiting) {
      polled.push_back({one->fd, POLLIN, 0});
      next = std::min(next, one->due);
    }
    const auto left = std::chrono::ceil<std::chrono::milliseconds>(next - Clock::now()).count();
    ::poll(polled.data(), polled.size(), static_cast<int>(std::max<long>(left, 0)));
    std::uint64_t calls = 0;
    (void)!::read(wake_, &calls, sizeof calls);
    std::size_t k = 1;
    for (auto one = waiting.begin(); one != waiting.end(); ++k) {
      const auto now = one++;
      const bool late = (*now)->due <= Clock::now();
      if (polled[k].revents != 0 && !late) {
        read(waiting, now);
      } else if (late) {
        if (!(*now)->bytes.empty()) refuse_late(**now);
        waiting.erase(now);
      }
    }
    admit(waiting);
    make_room(waiting);
  }
}

void WaitingRoom::answer_requests() {
  while (true) {
    Kept connection;
    bool last = false;
    {
      std::unique_lock lock(guard_);
      something_ready_.wait(lock, [&] { return ended_ || !ready_.empty(); });
      if (ready_.empty()) return;
      connection = std::move(ready_.front());
      ready_.pop_front();
      last = ended_;
      answered_.insert(connection->fd);
      if (ended_) ::shutdown(connection->fd, SHUT_RD);
    }
    bool again = false;
    {
      RequestStream stream(*connection, limits_.pause, Clock::now() + limits_.request);
      again = answer_(stream, last) && !last;
    }
    {
      const std::scoped_lock lock(guard_);
      answered_.erase(connection->fd);
      if (!again || ended_) continue;
      connection->due = Clock::now() + (connection->bytes.empty() ? limits_.idle : limits_.header);
      entered_.push_back(std::move(connection));
    }
    wake();
  }
}

}  // namespace vernier::http
