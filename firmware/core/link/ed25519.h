// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>

namespace vernier {

/// Verifies a signature: Ed25519 in its pre-hashed form (RFC 8032 section 5.1, Ed25519ph, empty context). For
/// targets without a cryptographic library; integers only, no heap, 7 KB of stack. The message is given in
/// two stretches, one after the other. key: 32 bytes; signature: 64. A key or R of small order and an
/// encoding that is not canonical are refused, as libsodium does. Not constant in time: it handles no secret
/// data. setup.
bool ed25519ph_fits(const std::uint8_t* first, std::uint32_t first_bytes, const std::uint8_t* second,
                    std::uint32_t second_bytes, const std::uint8_t* signature,
                    const std::uint8_t* key) noexcept;

}  // namespace vernier
