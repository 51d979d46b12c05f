// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <array>
#include <cstdint>
#include <span>

#include "tables/upload_format.h"

namespace vernier {

using PublicKey = std::array<std::uint8_t, kPublicKeyBytes>;

/// Does a signature of 64 bytes fit a head, what follows it, and this key? Ed25519ph, RFC 8032. A port
/// defines it, with the library that it has; where it has none, firmware/core/signature.cpp does. setup.
bool signature_fits(std::span<const std::uint8_t> head, std::span<const std::uint8_t> rest,
                    const std::uint8_t* signature, const PublicKey& key);

/// The first `size` bytes of a head that is laid out in memory as it is signed.
template <class Head>
std::span<const std::uint8_t> bytes_of_head(const Head& head, std::uint32_t size = sizeof(Head)) {
  return {reinterpret_cast<const std::uint8_t*>(&head), size};
}

}  // namespace vernier
