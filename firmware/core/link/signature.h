// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <array>
#include <cstdint>
#include <span>

#include "tables/upload_format.h"

namespace vernier {

using PublicKey = std::array<std::uint8_t, kPublicKeyBytes>;

/// Verifies a signature (64 bytes) of the bytes `head` followed by `rest` with a public key. The signature
/// algorithm is Ed25519ph, RFC 8032. A port with a cryptographic library defines this function itself. A port
/// without a cryptographic library uses firmware/core/link/signature.cpp. Not real-time safe.
bool signature_fits(std::span<const std::uint8_t> head, std::span<const std::uint8_t> rest,
                    const std::uint8_t* signature, const PublicKey& key);

/// Returns the first `size` bytes of a header whose layout in memory is the signed layout.
template <class Head>
std::span<const std::uint8_t> bytes_of_head(const Head& head, std::uint32_t size = sizeof(Head)) {
  return {reinterpret_cast<const std::uint8_t*>(&head), size};
}

}  // namespace vernier
