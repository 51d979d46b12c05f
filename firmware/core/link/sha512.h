// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>

namespace vernier {

/// Computes the hash SHA-512 (FIPS 180-4) of data that are added part by part. Not real-time safe.
class Sha512 {
 public:
  static constexpr std::uint32_t kBytes = 64;

  void add(const std::uint8_t* bytes, std::uint32_t size) noexcept;
  /// Ends the computation and writes the hash value. `digest`: memory for kBytes bytes.
  void finish(std::uint8_t* digest) noexcept;

 private:
  void take_block() noexcept;

  std::uint64_t state_[8] = {0x6a09e667f3bcc908, 0xbb67ae8584caa73b, 0x3c6ef372fe94f82b, 0xa54ff53a5f1d36f1,
                             0x510e527fade682d1, 0x9b05688c2b3e6c1f, 0x1f83d9abfb41bd6b, 0x5be0cd19137e2179};
  std::uint8_t block_[128];
  std::uint32_t held_ = 0;   // number of bytes in block_
  std::uint64_t bytes_ = 0;  // number of bytes that were added
};

}  // namespace vernier
