// SPDX-License-Identifier: Apache-2.0
#include "firmware/core/link/ed25519.h"

#include "firmware/core/link/sha512.h"

namespace vernier {
namespace {

/// A number modulo p = 2^255 - 19 in sixteen digits of 16 bits, which may be out of range between reductions:
/// a product of two sums of reduced numbers stays below 2^43 a digit.
struct Field {
  std::int64_t digit[16];
};

constexpr Field kZero = {{}};
constexpr Field kOne = {{1}};
// Curve constants, RFC 8032 section 5.1: d, 2d, the base point, and a square root of -1.
constexpr Field kD = {{0x78a3, 0x1359, 0x4dca, 0x75eb, 0xd8ab, 0x4141, 0x0a4d, 0x0070, 0xe898, 0x7779, 0x4079,
                       0x8cc7, 0xfe73, 0x2b6f, 0x6cee, 0x5203}};
constexpr Field kD2 = {{0xf159, 0x26b2, 0x9b94, 0xebd6, 0xb156, 0x8283, 0x149a, 0x00e0, 0xd130, 0xeef3,
                        0x80f2, 0x198e, 0xfce7, 0x56df, 0xd9dc, 0x2406}};
constexpr Field kBaseX = {{0xd51a, 0x8f25, 0x2d60, 0xc956, 0xa7b2, 0x9525, 0xc760, 0x692c, 0xdc5c, 0xfdd6,
                           0xe231, 0xc0a4, 0x53fe, 0xcd6e, 0x36d3, 0x2169}};
constexpr Field kBaseY = {{0x6658, 0x6666, 0x6666, 0x6666, 0x6666, 0x6666, 0x6666, 0x6666, 0x6666, 0x6666,
                           0x6666, 0x6666, 0x6666, 0x6666, 0x6666, 0x6666}};
constexpr Field kRootOfMinusOne = {{0xa0b0, 0x4a0e, 0x1b27, 0xc4ee, 0xe478, 0xad2f, 0x1806, 0x2f43, 0xd7a7,
                                    0x3dfb, 0x0099, 0x2b4d, 0xdf0b, 0x4fc1, 0x2480, 0x2b83}};
// Order of the base point, 2^252 + 27742317777372353535851937790883648493, low byte first.
constexpr std::uint8_t kOrder[32] = {0xed, 0xd3, 0xf5, 0x5c, 0x1a, 0x63, 0x12, 0x58, 0xd6, 0x9c, 0xf7,
                                     0xa2, 0xde, 0xf9, 0xde, 0x14, 0,    0,    0,    0,    0,    0,
                                     0,    0,    0,    0,    0,    0,    0,    0,    0,    0x10};

// 2^256 is 38 modulo p.
void carry(Field& a) noexcept {
  for (int i = 0; i < 16; ++i) {
    const std::int64_t over = a.digit[i] >> 16;
    a.digit[i] -= over * 65536;
    if (i < 15)
      a.digit[i + 1] += over;
    else
      a.digit[0] += 38 * over;
  }
}

Field plus(const Field& a, const Field& b) noexcept {
  Field sum;
  for (int i = 0; i < 16; ++i) sum.digit[i] = a.digit[i] + b.digit[i];
  return sum;
}

Field minus(const Field& a, const Field& b) noexcept {
  Field difference;
  for (int i = 0; i < 16; ++i) difference.digit[i] = a.digit[i] - b.digit[i];
  return difference;
}

Field times(const Field& a, const Field& b) noexcept {
  std::int64_t wide[31] = {};
  for (int i = 0; i < 16; ++i)
    for (int k = 0; k < 16; ++k) wide[i + k] += a.digit[i] * b.digit[k];
  Field product;
  for (int i = 0; i < 16; ++i) product.digit[i] = wide[i] + (i < 15 ? 38 * wide[i + 16] : 0);
  carry(product);
  carry(product);
  return product;
}

// a^(2^255 - 21) with `skip` bits 2 and 4 clear: the inverse; with bit 1: the power for a square root.
Field power(const Field& a, int from, int skip_first, int skip_second) noexcept {
  Field result = a;
  for (int i = from; i >= 0; --i) {
    result = times(result, result);
    if (i != skip_first && i != skip_second) result = times(result, a);
  }
  return result;
}
Field inverse(const Field& a) noexcept { return power(a, 253, 2, 4); }
Field power_for_root(const Field& a) noexcept { return power(a, 250, 1, 1); }

// The one representative below p, 32 bytes, low byte first.
void pack(const Field& a, std::uint8_t* bytes) noexcept {
  Field reduced = a;
  for (int i = 0; i < 3; ++i) carry(reduced);
  for (int pass = 0; pass < 2; ++pass) {
    Field less;
    less.digit[0] = reduced.digit[0] - 0xffed;
    for (int i = 1; i < 16; ++i) {
      less.digit[i] = reduced.digit[i] - (i < 15 ? 0xffff : 0x7fff) - (less.digit[i - 1] < 0 ? 1 : 0);
      less.digit[i - 1] &= 0xffff;
    }
    if (less.digit[15] >= 0) reduced = less;
  }
  for (int i = 0; i < 16; ++i) {
    bytes[2 * i] = static_cast<std::uint8_t>(reduced.digit[i]);
    bytes[2 * i + 1] = static_cast<std::uint8_t>(reduced.digit[i] >> 8);
  }
}

Field unpack(const std::uint8_t* bytes) noexcept {
  Field a;
  for (int i = 0; i < 16; ++i) a.digit[i] = bytes[2 * i] | std::int64_t{bytes[2 * i + 1]} << 8;
  a.digit[15] &= 0x7fff;
  return a;
}

bool same_bytes(const std::uint8_t* a, const std::uint8_t* b) noexcept {
  for (int i = 0; i < 32; ++i)
    if (a[i] != b[i]) return false;
  return true;
}

bool equal(const Field& a, const Field& b) noexcept {
  std::uint8_t one[32], two[32];
  pack(a, one);
  pack(b, two);
  return same_bytes(one, two);
}

bool is_odd(const Field& a) noexcept {
  std::uint8_t bytes[32];
  pack(a, bytes);
  return (bytes[0] & 1) != 0;
}

/// A point of the curve in extended coordinates: x = X/Z, y = Y/Z, T = XY/Z.
struct Point {
  Field x, y, z, t;
};

// RFC 8032 section 5.1.4: complete, so that it doubles too.
Point sum_of(const Point& p, const Point& q) noexcept {
  const Field a = times(minus(p.y, p.x), minus(q.y, q.x));
  const Field b = times(plus(p.x, p.y), plus(q.x, q.y));
  const Field c = times(times(p.t, q.t), kD2);
  const Field half = times(p.z, q.z);
  const Field d = plus(half, half);
  const Field e = minus(b, a), f = minus(d, c), g = plus(d, c), h = plus(b, a);
  return {times(e, f), times(h, g), times(g, f), times(e, h)};
}

Point multiple(const Point& p, const std::uint8_t* scalar) noexcept {
  Point result = {kZero, kOne, kOne, kZero};
  for (int i = 255; i >= 0; --i) {
    result = sum_of(result, result);
    if ((scalar[i / 8] >> (i & 7) & 1) != 0) result = sum_of(result, p);
  }
  return result;
}

void pack(const Point& p, std::uint8_t* bytes) noexcept {
  const Field z = inverse(p.z);
  pack(times(p.y, z), bytes);
  bytes[31] = static_cast<std::uint8_t>(bytes[31] ^ (is_odd(times(p.x, z)) ? 0x80 : 0));
}

// The negative of a packed point (section 5.1.3); false if the point does not exist.
bool unpack_negative(const std::uint8_t* bytes, Point& p) noexcept {
  p.y = unpack(bytes);
  p.z = kOne;
  const Field square = times(p.y, p.y);
  const Field u = minus(square, kOne), v = plus(times(square, kD), kOne);
  const Field v2 = times(v, v), v4 = times(v2, v2), v6 = times(v4, v2);
  // u / v's root: u v^3 (u v^7)^((p - 5) / 8).
  p.x = times(times(times(power_for_root(times(times(v6, v), u)), u), v2), v);
  if (!equal(times(times(p.x, p.x), v), u)) p.x = times(p.x, kRootOfMinusOne);
  if (!equal(times(times(p.x, p.x), v), u)) return false;
  if (is_odd(p.x) == (bytes[31] >> 7 != 0)) p.x = minus(kZero, p.x);
  carry(p.x);
  p.t = times(p.x, p.y);
  return true;
}

// True if eight times the point is the neutral one: with such a key or R one signature fits many messages.
bool has_small_order(const Point& p) noexcept {
  Point multiple = p;
  for (int i = 0; i < 3; ++i) multiple = sum_of(multiple, multiple);
  return equal(multiple.x, kZero) && equal(multiple.y, multiple.z);
}

// True if y is below p, as section 5.1.3 demands.
bool is_canonical(const std::uint8_t* bytes) noexcept {
  std::uint8_t reduced[32];
  pack(unpack(bytes), reduced);
  reduced[31] = static_cast<std::uint8_t>(reduced[31] | (bytes[31] & 0x80));
  return same_bytes(bytes, reduced);
}

bool below_order(const std::uint8_t* scalar) noexcept {
  for (int i = 31; i >= 0; --i)
    if (scalar[i] != kOrder[i]) return scalar[i] < kOrder[i];
  return false;
}

// 64 bytes modulo the order, bit by bit: the order is above 2^252, so twice a remainder stays below 2^254.
void reduce(const std::uint8_t* wide, std::uint8_t* scalar) noexcept {
  for (int i = 0; i < 32; ++i) scalar[i] = 0;
  for (int bit = 511; bit >= 0; --bit) {
    int over = wide[bit / 8] >> (bit & 7) & 1;
    for (int i = 0; i < 32; ++i) {
      const int twice = scalar[i] * 2 + over;
      scalar[i] = static_cast<std::uint8_t>(twice);
      over = twice >> 8;
    }
    if (below_order(scalar)) continue;
    int borrow = 0;
    for (int i = 0; i < 32; ++i) {
      const int difference = scalar[i] - kOrder[i] - borrow;
      scalar[i] = static_cast<std::uint8_t>(difference);
      borrow = difference < 0 ? 1 : 0;
    }
  }
}

}  // namespace

bool ed25519ph_fits(const std::uint8_t* first, std::uint32_t first_bytes, const std::uint8_t* second,
                    std::uint32_t second_bytes, const std::uint8_t* signature,
                    const std::uint8_t* key) noexcept {
  Point negative;
  if (!below_order(signature + 32) || !is_canonical(key) || !unpack_negative(key, negative) ||
      has_small_order(negative))
    return false;
  std::uint8_t digest[Sha512::kBytes], scalar[32], expected[32];
  Sha512 message;
  message.add(first, first_bytes);
  message.add(second, second_bytes);
  message.finish(digest);
  // dom2(1, ""), section 2: the text, the flag of the pre-hashed form, no context.
  constexpr std::uint8_t kDomain[] = "SigEd25519 no Ed25519 collisions\x01";
  Sha512 hash;
  hash.add(kDomain, sizeof(kDomain));  // the closing zero is the length of the context
  hash.add(signature, 32);
  hash.add(key, 32);
  hash.add(digest, sizeof(digest));
  hash.finish(digest);
  reduce(digest, scalar);
  // R = S B - h A.
  const Point base = {kBaseX, kBaseY, kOne, times(kBaseX, kBaseY)};
  const Point r = sum_of(multiple(negative, scalar), multiple(base, signature + 32));
  pack(r, expected);
  return same_bytes(expected, signature) && !has_small_order(r);
}

}  // namespace vernier
