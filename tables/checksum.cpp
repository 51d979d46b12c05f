// SPDX-License-Identifier: Apache-2.0
#include "tables/checksum.h"

namespace vernier {
namespace {

constexpr std::uint32_t kPolynomial = 0x82f63b78u;  // 0x1EDC6F41, bits reversed

struct Lookup {
  std::uint32_t of_byte[256];
};

constexpr Lookup make_lookup() {
  Lookup lookup{};
  for (std::uint32_t byte = 0; byte < 256; ++byte) {
    std::uint32_t rest = byte;
    for (int bit = 0; bit < 8; ++bit) rest = (rest >> 1) ^ ((rest & 1u) != 0 ? kPolynomial : 0);
    lookup.of_byte[byte] = rest;
  }
  return lookup;
}

constexpr Lookup kLookup = make_lookup();

}  // namespace

std::uint32_t crc32c(const std::uint8_t* bytes, std::uint32_t size) noexcept {
  std::uint32_t crc = 0xffffffffu;
  for (std::uint32_t i = 0; i < size; ++i) crc = (crc >> 8) ^ kLookup.of_byte[(crc ^ bytes[i]) & 0xffu];
  return ~crc;
}

}  // namespace vernier
