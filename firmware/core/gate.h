// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <array>
#include <cstdint>

#include "firmware/core/identity.h"
#include "tables/link_format.h"

namespace vernier {

using Nonce = std::array<std::uint8_t, sizeof(ChallengeReply::nonce)>;

/// Decides which requests of a link are carried out: what the link may be used for, and where the board has
/// keys, only what one of them has signed. A signed request is taken once: it names the nonce of this start
/// of the board and a counter above that of all before it.
class Gate {
 public:
  /// identity: outlives this; nonce: nobody can foretell it. setup.
  Gate(const BoardIdentity& identity, const Nonce& nonce) noexcept : identity_(identity), nonce_(nonce) {}

  /// The request that may be carried out, or why none may. It lives until the next call.
  struct Opened {
    LinkStatus status;
    const std::uint8_t* request;
    std::uint32_t size;
  };
  Opened open(const std::uint8_t* request, std::uint32_t size, LinkAccess access) noexcept;
  /// Is it the request for a challenge? Its payload then.
  static bool is_challenge(const std::uint8_t* request, std::uint32_t size) noexcept;
  ChallengeReply challenge(LinkAccess access) const noexcept;
  /// May a master that knows nothing but registers give commands over this link?
  bool lets_plain_commands(LinkAccess access, bool trusted_line) const noexcept {
    return access >= LinkAccess::kCommand && (identity_.keys.empty() || trusted_line);
  }

 private:
  LinkStatus check(const std::uint8_t* request, std::uint32_t size) noexcept;

  const BoardIdentity& identity_;
  Nonce nonce_;
  std::uint32_t counter_ = 0;  // of the last one that was taken
  std::uint8_t inner_[kMaxRequestBytes] = {};
};

/// What a request needs: access of its link, and a signature at all.
LinkAccess access_needed(LinkOp op) noexcept;
bool signature_needed(LinkOp op) noexcept;

}  // namespace vernier
