// SPDX-License-Identifier: Apache-2.0
#pragma once
#include "firmware/core/cycle/wiring.h"
#include "firmware/core/link/signature.h"

namespace vernier {

/// A public key and the rights of its owner.
struct TrustedKey {
  PublicKey key{};
  Name name;  // for people: whose it is
  bool command = true, upload = true;
  bool retired = false;  // images confirmed with it still run; no new image is accepted
};

/// Identity of a board, and the keys that the board trusts.
struct BoardIdentity {
  static constexpr std::uint32_t kMostKeys = 8;
  Name board, board_class;  // what an image may be signed for
  FixedList<TrustedKey, kMostKeys> keys;

  BoardIdentity() = default;
  /// Constructs a board without a name that trusts one key with all rights.
  BoardIdentity(const PublicKey& key) { keys.push_back(TrustedKey{key, {}}); }  // NOLINT: one is the other

  /// Returns the key that begins with these bytes; null: no such key.
  const TrustedKey* find(const std::uint8_t* first_bytes, std::uint32_t size) const noexcept;
};

}  // namespace vernier
