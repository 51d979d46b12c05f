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

bool both_accept(const Bytes& message, const Bytes& signature, const Bytes& key, bool& theirs) {
  crypto_sign_state state;
  crypto_sign_init(&state);
  crypto_sign_update(&state, message.data(), message.size());
  Bytes copy = signature;
  theirs = crypto_sign_final_verify(&state, copy.data(), key.data()) == 0;
  return ed25519ph_fits(message.data(), static_cast<std::uint32_t>(message.size()), nullptr, 0,
                        signature.data(), key.data());
}

// All encodings of points of small order, and of all y from p to 2^255 - 1, with both signs.
std::vector<Bytes> odd_points() {
  std::vector<Bytes> points;
  const auto add = [&](Bytes y) {
    points.push_back(y);
    y[31] ^= 0x80;
    points.push_back(y);
  };
  for (const char* const y : {"0000000000000000000000000000000000000000000000000000000000000000",
                              "0100000000000000000000000000000000000000000000000000000000000000",
                              "ecffffffffffffffffffffffffffffffffffffffffffffffffffffffffffff7f",
                              "26e8958fc2b227b045c3f489f2ef98f0d5dfac05d3c63339b13802886d53fc05",
                              "c7176a703d4dd84fba3c0b760d10670f2a2053fa2c39ccc64ec7fd7792ac037a"})
    add(from_hex(y));
  for (unsigned low = 0xed; low <= 0xff; ++low) {
    Bytes y(32, 0xff);
    y[0] = static_cast<std::uint8_t>(low), y[31] = 0x7f;
    add(y);
  }
  return points;
}

// With S = 0 and a key of small order one R in eight fits any message.
TEST(Ed25519ph, RefusesKeysOfSmallOrderAndEncodingsAboveThePrime) {
  ASSERT_GE(sodium_init(), 0);
  const std::vector<Bytes> points = odd_points();
  ASSERT_EQ(points.size(), 48u);
  int tried = 0, mine = 0, library = 0;
  for (const Bytes& key : points)
    for (const Bytes& r : points)
      for (std::uint8_t text = 0; text < 10; ++text)
        for (const std::uint8_t scalar : {std::uint8_t{0}, std::uint8_t{1}}) {
          Bytes signature = r;
          signature.resize(64);
          signature[32] = scalar;
          bool theirs = false;
          mine += both_accept({text}, signature, key, theirs) ? 1 : 0;
          library += theirs ? 1 : 0;
          ++tried;
        }
  std::printf("%d signatures: %d accepted here, %d by the library\n", tried, mine, library);
  EXPECT_EQ(mine, 0);
  EXPECT_EQ(library, 0);
}

// GIVEN keys whose y begins or ends like the prime 2^255 - 19, and a signature in whose check a value above
// the prime has the prime's lowest digit; the numbers of their seeds come from a search WHEN a message is
// signed THEN the comparison with the prime, digit by digit, accepts the signature
TEST(Ed25519ph, TakesValuesWithDigitsOfThePrime) {
  ASSERT_GE(sodium_init(), 0);
  for (const std::uint32_t number : {43'152u, 96'040u, 100'530u, 130'633u, 18'705u, 78'060u, 98'534u}) {
    std::uint8_t seed[32] = {static_cast<std::uint8_t>(number), static_cast<std::uint8_t>(number >> 8),
                             static_cast<std::uint8_t>(number >> 16)};
    Bytes key(32), secret(64), signature(64);
    crypto_sign_seed_keypair(key.data(), secret.data(), seed);
    const int highest = (key[31] & 0x7f) << 8 | key[30], lowest = key[1] << 8 | key[0];
    EXPECT_TRUE(number == 98'534 || highest == 0x7fff || lowest == 0xffed) << number;
    crypto_sign_state state;
    crypto_sign_init(&state);
    crypto_sign_update(&state, seed, sizeof(seed));
    crypto_sign_final_create(&state, signature.data(), nullptr, secret.data());
    EXPECT_TRUE(ed25519ph_fits(seed, sizeof(seed), nullptr, 0, signature.data(), key.data())) << number;
  }
}

/// A key pair whose secret scalar is known, and the hash of a signature's equation.
struct KnownKey {
  Bytes secret = Bytes(32), key = Bytes(32);
  KnownKey() {
    const Bytes wide(64, 7);
    crypto_core_ed25519_scalar_reduce(secret.data(), wide.data());
    crypto_scalarmult_ed25519_base_noclamp(key.data(), secret.data());
  }
  // S = k + h a, with R and key as they stand in the hash.
  Bytes signature(const Bytes& k, const Bytes& r, const Bytes& named_key, const Bytes& message) const {
    Bytes digest(64), h(32), product(32), signature = r;
    crypto_hash_sha512(digest.data(), message.data(), message.size());
    Bytes text;
    for (const char c : std::string("SigEd25519 no Ed25519 collisions"))
      text.push_back(static_cast<std::uint8_t>(c));
    text.push_back(1), text.push_back(0);
    for (const Bytes* const part : {&r, &named_key, static_cast<const Bytes*>(&digest)})
      text.insert(text.end(), part->begin(), part->end());
    crypto_hash_sha512(digest.data(), text.data(), text.size());
    crypto_core_ed25519_scalar_reduce(h.data(), digest.data());
    crypto_core_ed25519_scalar_mul(product.data(), h.data(), secret.data());
    signature.resize(64);
    crypto_core_ed25519_scalar_add(signature.data() + 32, product.data(), k.data());
    return signature;
  }
};

TEST(Ed25519ph, RefusesAnROfSmallOrderUnderAGoodKey) {
  ASSERT_GE(sodium_init(), 0);
  const KnownKey good;
  const Bytes none(32), message = {'a', 'b', 'c'};
  bool theirs = true;
  // The neutral point with S = h a fits the equation: an R of order 1.
  Bytes neutral(32);
  neutral[0] = 1;
  EXPECT_FALSE(both_accept(message, good.signature(none, neutral, good.key, message), good.key, theirs));
  EXPECT_FALSE(theirs);
  // The same arithmetic with a proper R is a signature.
  Bytes one(32), base(32);
  one[0] = 1;
  crypto_scalarmult_ed25519_base_noclamp(base.data(), one.data());
  EXPECT_TRUE(both_accept(message, good.signature(one, base, good.key, message), good.key, theirs));
  EXPECT_TRUE(theirs);
}

// A key with a part of order 8 is not of small order: the signature fits if 8 divides h.
TEST(Ed25519ph, SaysWhatTheLibrarySaysOfKeysOfMixedOrder) {
  ASSERT_GE(sodium_init(), 0);
  const KnownKey good;
  const Bytes eighth = from_hex("26e8958fc2b227b045c3f489f2ef98f0d5dfac05d3c63339b13802886d53fc05");
  Bytes mixed(32), one(32), base(32);
  one[0] = 1;
  ASSERT_EQ(crypto_core_ed25519_add(mixed.data(), good.key.data(), eighth.data()), 0);
  crypto_scalarmult_ed25519_base_noclamp(base.data(), one.data());
  int accepted = 0;
  for (std::uint8_t text = 0; text < 100; ++text) {
    bool theirs = false;
    const bool mine = both_accept({text}, good.signature(one, base, mixed, {text}), mixed, theirs);
    ASSERT_EQ(mine, theirs) << int{text};
    accepted += mine ? 1 : 0;
  }
  EXPECT_GT(accepted, 3);  // 12.5 expected
  EXPECT_LT(accepted, 30);
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
