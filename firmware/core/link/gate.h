// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <array>
#include <cstdint>

#include "firmware/core/link/identity.h"
#include "hal/identity_key.h"
#include "tables/link_format.h"

namespace vernier {

using Nonce = std::array<std::uint8_t, sizeof(ChallengeReply::nonce)>;
using ChallengeBytes = std::array<std::uint8_t, sizeof(ChallengeReply::challenge)>;
/// Random bytes of one start of a board, from which challenges are made; these bytes never leave the board.
using ChallengeSeed = std::array<std::uint8_t, 32>;

/// Sender of a request. link: any value that differs between the links of a board; connection: a number that
/// the link uses once (hal/command_link.h), 0 for a link without connections.
struct Caller {
  std::uintptr_t link = 0;
  std::uint64_t connection = 0;
  friend bool operator==(const Caller&, const Caller&) = default;
};

/// Decides which requests of a link are executed. The request is checked against the rights of the link. If
/// the board has keys, only requests signed with one of them are executed. A signed request is accepted once:
/// the request contains the nonce of this start of the board, and a challenge of 128 random bits that the
/// board gave over the same connection in the last seconds. A request that was delayed on its way, or
/// repeated over another connection, is not valid.
class Gate {
 public:
  /// identity, own_key: outlive this object; own_key null: the board has no key; nonce, seed: new
  /// with each start, from a source of random numbers; the seed must stay secret. Not real-time safe.
  Gate(const BoardIdentity& identity, const Nonce& nonce, const ChallengeSeed& seed,
       IdentityKey* own_key = nullptr) noexcept
      : identity_(identity), nonce_(nonce), seed_(seed), own_key_(own_key) {}

  /// The request that may be executed, or the reason of a refusal. The pointer is valid until the next call.
  struct Opened {
    LinkStatus status;
    const std::uint8_t* request;
    std::uint32_t size;
    bool is_signed = false;  // with a valid signature
  };
  /// Checks a request. from: the sender of the request; now: time of the clock that challenge() uses. Not
  /// real-time safe.
  Opened open(const std::uint8_t* request, std::uint32_t size, LinkAccess access, const Caller& from,
              TimeUs now) noexcept;
  /// True for a request for a challenge. A challenge can be used once.
  static bool is_challenge(const std::uint8_t* request, std::uint32_t size) noexcept;
  /// Gives the challenge of one connection. The challenge replaces the previous one of the connection. If the
  /// table is full, the oldest challenge of the same link is removed. If the table has
  /// no challenge of the same link, the oldest challenge of any link is removed. Not real-time safe.
  ChallengeReply challenge(LinkAccess access, const Caller& from, TimeUs now) noexcept;
  /// Removes the challenge of a connection that has ended. Not real-time safe.
  void forget(const Caller& from) noexcept;
  /// True for the request to prove the identity of the board. Every caller may send an identify request.
  static bool is_identify(const std::uint8_t* request, std::uint32_t size) noexcept;
  /// Signs the asker's nonce, the nonce of this start and the board's name with the key of the board.
  /// kUnknownOp: the board has no key; kBadLength: the request has no nonce; kNotReady: the library failed.
  /// `reply` is filled only with kDone. Not real-time safe.
  LinkStatus identify(const std::uint8_t* request, std::uint32_t size, IdentifyReply& reply) noexcept;
  /// True if a master that uses registers only may give commands over this link.
  bool lets_plain_commands(LinkAccess access, bool trusted_line) const noexcept {
    return access >= LinkAccess::kCommand && (identity_.keys.empty() || trusted_line);
  }

 private:
  /// Open challenges: one for each connection of two TCP links and of links without connections.
  static constexpr std::uint32_t kMostOpen = 48;
  static constexpr TimeUs kOpenFor{10'000'000};
  struct Challenge {
    bool open = false;
    Caller from;
    ChallengeBytes bytes{};
    TimeUs given;
  };
  ChallengeBytes fresh() noexcept;
  Challenge* of(const Caller& from) noexcept;
  Challenge& place_for(const Caller& from) noexcept;
  LinkStatus check(const std::uint8_t* request, std::uint32_t size, const Caller& from, TimeUs now) noexcept;

  const BoardIdentity& identity_;
  Nonce nonce_;
  ChallengeSeed seed_;
  IdentityKey* own_key_;
  std::uint64_t counter_ = 0;  // of the newest challenge
  Challenge open_[kMostOpen];
  std::uint8_t inner_[kMaxRequestBytes] = {};
};

/// Requirements of a request: the access that its link must have, and whether it must be signed.
LinkAccess access_needed(LinkOp op) noexcept;
bool signature_needed(LinkOp op) noexcept;

}  // namespace vernier
