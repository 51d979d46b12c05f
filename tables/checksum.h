// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>

namespace vernier {

/// Computes CRC-32C (Castagnoli, polynomial 0x1EDC6F41 reflected, RFC 3720 appendix B.4). `bytes`: array of
/// `size` bytes. Not real-time safe.
std::uint32_t crc32c(const std::uint8_t* bytes, std::uint32_t size) noexcept;

/// Computes the hash FNV-1a, 64 bit. With `seed`, several parts of a text give one hash. The hash FNV-1a
/// distinguishes versions. The hash FNV-1a gives no protection against manipulation. Not real-time safe.
constexpr std::uint64_t kFnvSeed = 0xcbf29ce484222325u;
constexpr std::uint64_t fnv1a(const std::uint8_t* bytes, std::uint32_t size,
                              std::uint64_t seed = kFnvSeed) noexcept {
  for (std::uint32_t i = 0; i < size; ++i) seed = (seed ^ bytes[i]) * 0x100000001b3u;
  return seed;
}

}  // namespace vernier
