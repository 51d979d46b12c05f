// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <array>
#include <cstdint>

#include "firmware/core/link/identity.h"
#include "hal/identity_key.h"
#include "tables/link_format.h"

namespace vernier {

using Nonce = std::array<std::uint8_t, sizeof(ChallengeReply::nonce)>;

/// Decides which requests of a link are executed. The rights of the link count. If the board has keys, only
/// requests signed with one of them are executed. A signed request is accepted once: the request contains the
/// nonce of this start of the board and the number of a challenge from the last seconds. A request that was
/// delayed on its way is therefore not valid later.
class Gate {
 public:
  /// identity, own_key: outlive this object; own_key null: the board has no key; nonce: must not be
  /// predictable. setup.
  Gate(const BoardIdentity& identity, const Nonce& nonce, IdentityKey* own_key = nullptr) noexcept
      : identity_(identity), nonce_(nonce), own_key_(own_key) {}

  /// The request that may be executed, or the reason of a refusal. It lives until the next call.
  struct Opened {
    LinkStatus status;
    const std::uint8_t* request;
    std::uint32_t size;
  };
  /// Checks a request. now: of the clock that challenge() uses.
  Opened open(const std::uint8_t* request, std::uint32_t size, LinkAccess access, TimeUs now) noexcept;
  /// True for a request for a challenge. A challenge can be used once.
  static bool is_challenge(const std::uint8_t* request, std::uint32_t size) noexcept;
  ChallengeReply challenge(LinkAccess access, TimeUs now) noexcept;
  /// True for the request to prove the identity of the board. Every caller may send an identify request.
  static bool is_identify(const std::uint8_t* request, std::uint32_t size) noexcept;
  /// Signs the asker's nonce, the nonce of this start and the board's name with the key of the board.
  /// kUnknownOp: the board has no key; kBadLength: the request has no nonce; kNotReady: the library failed.
  /// `reply` is filled only with kDone. setup.
  LinkStatus identify(const std::uint8_t* request, std::uint32_t size, IdentifyReply& reply) noexcept;
  /// True if a master that uses registers only may give commands over this link.
  bool lets_plain_commands(LinkAccess access, bool trusted_line) const noexcept {
    return access >= LinkAccess::kCommand && (identity_.keys.empty() || trusted_line);
  }

 private:
  /// Largest number of open challenges; a further challenge removes the oldest, whose client must sign again.
  static constexpr std::uint32_t kMostOpen = 32;
  static constexpr TimeUs kOpenFor{10'000'000};
  struct Challenge {
    std::uint32_t counter = 0;  // 0: no challenge
    TimeUs given;
  };
  Challenge* find(std::uint32_t counter, TimeUs now) noexcept;
  LinkStatus check(const std::uint8_t* request, std::uint32_t size, TimeUs now) noexcept;

  const BoardIdentity& identity_;
  Nonce nonce_;
  IdentityKey* own_key_;
  std::uint32_t counter_ = 0;  // of the newest challenge
  Challenge open_[kMostOpen];
  std::uint8_t inner_[kMaxRequestBytes] = {};
};

/// Requirements of a request: the access that its link must have, and whether it must be signed.
LinkAccess access_needed(LinkOp op) noexcept;
bool signature_needed(LinkOp op) noexcept;

}  // namespace vernier
