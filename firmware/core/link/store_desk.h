// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <algorithm>
#include <atomic>
#include <cstdint>

#include "hal/command_link.h"
#include "tables/link_format.h"

namespace vernier {

/// Passes a request that needs the medium (storage) from a link to the store. A link never waits for the
/// store. The store may wait for its medium without a time limit. StoreDesk accepts one request at a time.
class StoreDesk {
 public:
  // ---- functions for the links
  /// True if a link may leave a request. If a sender does not collect its reply, the request is removed after
  /// some time, because the sender is no longer connected.
  bool free() noexcept {
    const State state = state_.load(std::memory_order_acquire);
    return state == State::kFree || (state == State::kDone && ++asked_while_done_ > kPatience);
  }
  /// Leaves a request for the store. Call leave() only if free() is true. `op`: code that the reply repeats
  /// (the op of the signed cover of the request). leave() returns the ticket for collect().
  std::uint32_t leave(const std::uint8_t* request, std::uint32_t size, std::uint8_t op) noexcept {
    op_ = op;
    size_ = std::min<std::uint32_t>(size, sizeof(request_));
    std::copy_n(request, size_, request_);
    asked_while_done_ = 0;
    ticket_ = (ticket_ + 1) & INT32_MAX;  // the highest bit is the mark of a SettingTicket
    state_.store(State::kAsked, std::memory_order_release);
    return ticket_;
  }
  /// Copies the reply and returns its number of bytes. The result of collect() is CommandHandler::kLater
  /// while the request is executed, and 0 if another request replaced it.
  std::uint32_t collect(std::uint32_t ticket, std::uint8_t* reply) noexcept {
    if (ticket != ticket_) return 0;
    const State state = state_.load(std::memory_order_acquire);
    if (state != State::kDone) return state == State::kFree ? 0 : CommandHandler::kLater;
    std::copy_n(reply_, reply_size_, reply);
    state_.store(State::kFree, std::memory_order_release);
    return reply_size_;
  }

  // ---- functions for the store
  bool asked() const noexcept { return state_.load(std::memory_order_acquire) == State::kAsked; }
  const std::uint8_t* request() const noexcept { return request_; }
  std::uint32_t size() const noexcept { return size_; }
  std::uint8_t* reply() noexcept { return reply_; }
  void done(std::uint32_t reply_size) noexcept {
    reply_size_ = reply_size;
    reply_[0] = op_;
    state_.store(State::kDone, std::memory_order_release);
  }

 private:
  static constexpr std::uint32_t kPatience = 10;  // number of other requests that are refused while a reply
                                                  // is not collected
  enum class State : std::uint8_t { kFree, kAsked, kDone };
  std::atomic<State> state_{State::kFree};
  std::uint8_t request_[kMaxRequestBytes] = {}, reply_[kMaxReplyBytes] = {};
  std::uint8_t op_ = 0;
  std::uint32_t size_ = 0, reply_size_ = 0, ticket_ = 0, asked_while_done_ = 0;
};

}  // namespace vernier
