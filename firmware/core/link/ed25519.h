// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>

namespace vernier {

/// Verifies a signature by Ed25519 in its pre-hashed form (RFC 8032 section 5.1, Ed25519ph, empty context).
/// This implementation of Ed25519 is for targets without a cryptographic library. This implementation of
/// Ed25519 uses only integers, no heap, and 7 KB of stack. The signed message is given in two parts, one
/// after the other. `key`: 32 bytes; `signature`: 64 bytes. The function refuses a key or R of small order
/// and an encoding that is not canonical, as libsodium does. The computing time is not constant, because the
/// function handles no secret data. Not real-time safe.
bool ed25519ph_fits(const std::uint8_t* first, std::uint32_t first_bytes, const std::uint8_t* second,
                    std::uint32_t second_bytes, const std::uint8_t* signature,
                    const std::uint8_t* key) noexcept;

}  // namespace vernier
