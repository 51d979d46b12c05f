// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>

#include "hal/fault.h"

namespace vernier {

/// The board's own key pair (Ed25519). The key pair is made on the board; the secret half never leaves the
/// board.
class IdentityKey {
 public:
  static constexpr std::uint32_t kPublicBytes = 32, kSignatureBytes = 64;
  virtual ~IdentityKey() = default;
  /// The public half, kPublicBytes. Not real-time safe.
  virtual const std::uint8_t* public_half() const noexcept = 0;
  /// Signs a message (Ed25519ph, RFC 8032). message: size bytes; signature: room for kSignatureBytes.
  /// kRefused: the library failed and `signature` is not valid. Not real-time safe.
  virtual HalFault sign(const std::uint8_t* message, std::uint32_t size,
                        std::uint8_t* signature) noexcept = 0;
};

}  // namespace vernier
