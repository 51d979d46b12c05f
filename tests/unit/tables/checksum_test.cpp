// SPDX-License-Identifier: GPL-3.0-or-later
#include "tables/checksum.h"

#include <gtest/gtest.h>

#include <cstring>
#include <vector>

namespace vernier::checksum_test {
namespace {

TEST(Crc32c, GivesThePublishedCheckValues) {
  const char* const digits = "123456789";
  EXPECT_EQ(crc32c(reinterpret_cast<const std::uint8_t*>(digits), 9), 0xe3069283u);
  // RFC 3720, appendix B.4: 32 bytes of zeros, of ones, and ascending.
  std::vector<std::uint8_t> bytes(32, 0);
  EXPECT_EQ(crc32c(bytes.data(), 32), 0x8a9136aau);
  bytes.assign(32, 0xff);
  EXPECT_EQ(crc32c(bytes.data(), 32), 0x62a8ab43u);
  for (std::uint8_t i = 0; i < 32; ++i) bytes[i] = i;
  EXPECT_EQ(crc32c(bytes.data(), 32), 0x46dd794eu);
}

TEST(Fnv1a, ChainsStretches) {
  const std::uint8_t text[] = {'a', 'b'};
  EXPECT_EQ(fnv1a(text, 1), 0xaf63dc4c8601ec8cu);
  EXPECT_EQ(fnv1a(text + 1, 1, fnv1a(text, 1)), fnv1a(text, 2));
}

}  // namespace
}  // namespace vernier::checksum_test
