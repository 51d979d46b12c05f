// SPDX-License-Identifier: Apache-2.0
#pragma once
#include "firmware/core/cycle/wiring.h"
#include "firmware/core/link/signature.h"

namespace vernier {

/// A public key and the rights of its owner.
struct TrustedKey {
  PublicKey key{};
  Name name;  // name of the owner, for people
  bool command = true, upload = true;
  bool retired = false;  // true: images that were confirmed with this key still run, but no new image is
                         // accepted
};

/// Identity of a board, and the keys that the board trusts.
struct BoardIdentity {
  static constexpr std::uint32_t kMostKeys = 8;
  Name board, board_class;  // name and class of the board for which an image may be signed
  FixedList<TrustedKey, kMostKeys> keys;

  BoardIdentity() = default;
  /// Constructs a board without a name that trusts one key with all rights.
  BoardIdentity(const PublicKey& key) { keys.push_back(TrustedKey{key, {}}); }  // NOLINT: one is the other

  /// Returns the trusted key that begins with the given bytes; null if there is no such key.
  const TrustedKey* find(const std::uint8_t* first_bytes, std::uint32_t size) const noexcept;
};

}  // namespace vernier
