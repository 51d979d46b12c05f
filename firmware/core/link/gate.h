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
/// Random bytes that a board creates at each start and from which challenges are made. The random bytes of
/// the challenges never leave the board.
using ChallengeSeed = std::array<std::uint8_t, 32>;

/// Sender of a request. `link`: a value that is different for each link of a board. `connection`: a number
/// that a link uses only once (hal/command_link.h); 0 for a link without connections.
struct Caller {
  std::uintptr_t link = 0;
  std::uint64_t connection = 0;
  friend bool operator==(const Caller&, const Caller&) = default;
};

/// Decides which requests of a link the board executes. A request is checked against the access rights of its
/// link. If the board has keys, it executes only requests that are signed with one of these keys. A signed
/// request is accepted only once. A signed request contains the nonce of this start of the board, and a
/// challenge of 128 random bits that the board sent over the same connection in the last seconds. A request
/// that was delayed, or that is repeated over another connection, is not valid.
class Gate {
 public:
  /// `identity`, `own_key` must exist longer than this object (own_key null: the board has no key). `nonce`,
  /// `seed`: new random numbers for each start; the seed must stay secret. Not real-time safe.
  Gate(const BoardIdentity& identity, const Nonce& nonce, const ChallengeSeed& seed,
       IdentityKey* own_key = nullptr) noexcept
      : identity_(identity), nonce_(nonce), seed_(seed), own_key_(own_key) {}

  /// A request that may be executed, or the reason why it is refused. The pointer `request` is valid until
  /// the next call of open().
  struct Opened {
    LinkStatus status;
    const std::uint8_t* request;
    std::uint32_t size;
    bool is_signed = false;  // true: the request has a valid signature
  };
  /// Checks whether a request may be executed. `from`: the sender of the request; `now`: time of the clock
  /// that challenge() uses. Not real-time safe.
  Opened open(const std::uint8_t* request, std::uint32_t size, LinkAccess access, const Caller& from,
              TimeUs now) noexcept;
  /// True if the request asks for a challenge. A challenge can be used once.
  static bool is_challenge(const std::uint8_t* request, std::uint32_t size) noexcept;
  /// Creates a new challenge for one connection. The new challenge replaces the previous challenge of this
  /// connection. If the table is full, the oldest challenge of the same link is removed. If the table has no
  /// challenge of the same link, the oldest challenge of any link is removed. Not real-time safe.
  ChallengeReply challenge(LinkAccess access, const Caller& from, TimeUs now) noexcept;
  /// Removes the open challenge of a connection that has ended. Not real-time safe.
  void forget(const Caller& from) noexcept;
  /// True if the request asks the board to prove its identity. Every caller may send an identify request.
  static bool is_identify(const std::uint8_t* request, std::uint32_t size) noexcept;
  /// Signs the nonce of the sender, the nonce of this start and the name of the board with the key of the
  /// board. Result: kUnknownOp if the board has no key; kBadLength if the request has no nonce; kNotReady if
  /// the cryptographic library failed. `reply` is set only if the result is kDone. Not real-time safe.
  LinkStatus identify(const std::uint8_t* request, std::uint32_t size, IdentifyReply& reply) noexcept;
  /// True if a Modbus master that uses only registers may give commands over this link.
  bool lets_plain_commands(LinkAccess access, bool trusted_line) const noexcept {
    return access >= LinkAccess::kCommand && (identity_.keys.empty() || trusted_line);
  }

 private:
  /// Largest number of open challenges: one for each connection of two TCP links and of links without
  /// connections.
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
  std::uint64_t counter_ = 0;  // number of the newest challenge
  Challenge open_[kMostOpen];
  std::uint8_t inner_[kMaxRequestBytes] = {};
};

/// access_needed() returns the access that the link of a request must have. signature_needed() returns
/// whether the request must be signed.
LinkAccess access_needed(LinkOp op) noexcept;
bool signature_needed(LinkOp op) noexcept;

}  // namespace vernier
