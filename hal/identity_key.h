// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>

#include "hal/fault.h"

namespace vernier {

/// The key pair of the board (Ed25519). The key pair is created on the board. The private key never leaves
/// the board.
class IdentityKey {
 public:
  static constexpr std::uint32_t kPublicBytes = 32, kSignatureBytes = 64;
  virtual ~IdentityKey() = default;
  /// Returns the public key, kPublicBytes bytes. Not real-time safe.
  virtual const std::uint8_t* public_half() const noexcept = 0;
  /// Signs a message (Ed25519ph, RFC 8032). `message`: `size` bytes; `signature`: memory for kSignatureBytes
  /// bytes. If the result is kRefused, the cryptographic library failed and `signature` is not valid. Not
  /// real-time safe.
  virtual HalFault sign(const std::uint8_t* message, std::uint32_t size,
                        std::uint8_t* signature) noexcept = 0;
};

}  // namespace vernier
