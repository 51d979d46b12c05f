// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <array>
#include <cstdint>
#include <string>

#include "hal/identity_key.h"

namespace vernier {

/// The private key of the board, in two files of the store: `identity.key` (64 bytes, readable only by its
/// owner) and `identity.pub` (for people and for `vernier fleet add --board-key`).
class BoardKey final : public IdentityKey {
 public:
  /// Reads the key of a store. If the store has no key, a new key is created. A new private key is on the
  /// medium before the constructor returns. `store`: a directory in which files can be written. Throws
  /// BoardError if the key cannot be read or created, is not a valid key, or is readable by other users. Not
  /// real-time safe.
  explicit BoardKey(const std::string& store);
  ~BoardKey() override;
  BoardKey(const BoardKey&) = delete;
  BoardKey& operator=(const BoardKey&) = delete;

  const std::uint8_t* public_half() const noexcept override { return public_.data(); }
  HalFault sign(const std::uint8_t* message, std::uint32_t size, std::uint8_t* signature) noexcept override;
  /// Returns the public key as 64 hexadecimal digits. Not real-time safe.
  std::string text() const;

 private:
  void read(const std::string& path);
  void make(const std::string& path);
  std::array<std::uint8_t, kPublicBytes> public_{};
  std::array<std::uint8_t, 64> secret_{};
};

}  // namespace vernier
