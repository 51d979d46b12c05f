// SPDX-License-Identifier: GPL-3.0-or-later
#include "firmware/core/link/ed25519.h"

#include <gtest/gtest.h>
#include <sodium.h>

#include <cstdio>
#include <random>
#include <vector>

#include "firmware/core/link/sha512.h"

namespace vernier {
namespace {

using Bytes = std::vector<std::uint8_t>;

Bytes from_hex(const std::string& text) {
  Bytes bytes;
  for (std::size_t i = 0; i < text.size(); i += 2)
    bytes.push_back(static_cast<std::uint8_t>(std::stoul(text.substr(i, 2), nullptr, 16)));
  return bytes;
}

// FIPS 180-4, example "abc".
TEST(Sha512, GivesThePublishedDigest) {
  Sha512 hash;
  const std::uint8_t text[] = {'a', 'b', 'c'};
  hash.add(text, 2), hash.add(text + 2, 1);
  Bytes digest(Sha512::kBytes);
  hash.finish(digest.data());
  EXPECT_EQ(digest, from_hex("ddaf35a193617abacc417349ae20413112e6fa4e89a97ea20a9eeee64b55d39a"
                             "2192992a274fc1a836ba3c23a3feebbd454d4423643ce80e2a9ac94fa54ca49f"));
}

TEST(Sha512, AgreesWithTheLibraryAtEveryLength) {
  Bytes message;
  for (int size = 0; size < 300; ++size) {
    Bytes mine(64), theirs(64);
    Sha512 hash;
    const auto first = static_cast<std::uint32_t>(size / 3);
    hash.add(message.data(), first);
    hash.add(message.data() + first, static_cast<std::uint32_t>(size) - first);
    hash.finish(mine.data());
    crypto_hash_sha512(theirs.data(), message.data(), message.size());
    ASSERT_EQ(mine, theirs) << size;
    message.push_back(static_cast<std::uint8_t>(31 * size));
  }
}

// RFC 8032 section 7.3: message "abc".
TEST(Ed25519ph, TakesThePublishedSignature) {
  const Bytes key = from_hex("ec172b93ad5e563bf4932c70e1245034c35467ef2efd4d64ebf819683467e2bf");
  Bytes signature = from_hex(
      "98a70222f0b8121aa9d30f813d683f809e462b469c7ff87639499bb94e6dae41"
      "31f85042463c2a355a2003d062adf5aaa10b8c61e636062aaad11c2a26083406");
  const std::uint8_t text[] = {'a', 'b', 'c'};
  EXPECT_TRUE(ed25519ph_fits(text, 1, text + 1, 2, signature.data(), key.data()));
  signature[40] ^= 1;
  EXPECT_FALSE(ed25519ph_fits(text, 1, text + 1, 2, signature.data(), key.data()));
}

TEST(Ed25519ph, SaysWhatTheLibrarySaysOfGoodAndChangedOnes) {
  ASSERT_GE(sodium_init(), 0);
  constexpr unsigned kSeed = 8032;
  std::printf("seed %u\n", kSeed);
  std::mt19937 random(kSeed);
  int good = 0, bad = 0;
  for (int i = 0; i < 60; ++i) {
    std::uint8_t seed[32], key[32], secret[64], signature[64];
    for (std::uint8_t& byte : seed) byte = static_cast<std::uint8_t>(random());
    crypto_sign_seed_keypair(key, secret, seed);
    Bytes message(1 + random() % 300);
    for (std::uint8_t& byte : message) byte = static_cast<std::uint8_t>(random());
    crypto_sign_state state;
    crypto_sign_init(&state);
    crypto_sign_update(&state, message.data(), message.size());
    crypto_sign_final_create(&state, signature, nullptr, secret);
    const auto agree = [&] {
      crypto_sign_init(&state);
      crypto_sign_update(&state, message.data(), message.size());
      const bool theirs = crypto_sign_final_verify(&state, signature, key) == 0;
      const auto half = static_cast<std::uint32_t>(message.size() / 2);
      ++(theirs ? good : bad);
      return theirs == ed25519ph_fits(message.data(), half, message.data() + half,
                                      static_cast<std::uint32_t>(message.size()) - half, signature, key);
    };
    ASSERT_TRUE(agree());
    std::uint8_t* const parts[3] = {signature, key, message.data()};
    const std::size_t sizes[3] = {64, 32, message.size()};
    for (int part = 0; part < 3; ++part) {
      std::uint8_t& byte = parts[part][random() % sizes[part]];
      const std::uint8_t before = byte;
      byte = static_cast<std::uint8_t>(byte ^ (1u << random() % 8));
      ASSERT_TRUE(agree()) << part;
      byte = before;
    }
  }
  EXPECT_EQ(good, 60);
  EXPECT_EQ(bad, 180);
}

// S and S + L give the same point: only the smaller one is a signature (section 5.1.7).
TEST(Ed25519ph, RefusesAScalarAboveTheOrder) {
  const Bytes order = from_hex("edd3f55c1a631258d69cf7a2def9de1400000000000000000000000000000010");
  const Bytes key = from_hex("ec172b93ad5e563bf4932c70e1245034c35467ef2efd4d64ebf819683467e2bf");
  Bytes signature = from_hex(
      "98a70222f0b8121aa9d30f813d683f809e462b469c7ff87639499bb94e6dae41"
      "31f85042463c2a355a2003d062adf5aaa10b8c61e636062aaad11c2a26083406");
  unsigned over = 0;
  for (std::size_t i = 0; i < 32; ++i) {
    over += signature[32 + i] + unsigned{order[i]};
    signature[32 + i] = static_cast<std::uint8_t>(over);
    over >>= 8;
  }
  const std::uint8_t text[] = {'a', 'b', 'c'};
  EXPECT_FALSE(ed25519ph_fits(text, 3, text, 0, signature.data(), key.data()));
}

}  // namespace
}  // namespace vernier
