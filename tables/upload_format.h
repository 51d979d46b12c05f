// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstddef>
#include <cstdint>

namespace vernier {

/// What is uploaded and stored in a slot: this header (little-endian, 128 bytes), then the image
/// (image_format.h). The signature, Ed25519 in its pre-hashed form (RFC 8032, Ed25519ph), covers the header
/// before it and the whole image.
struct UploadHeader {
  std::uint8_t magic[8];       // kUploadMagic
  std::uint32_t header_bytes;  // 128
  std::uint32_t image_bytes;
  std::uint64_t issued;    // when it was signed, microseconds since 1970: the higher, the newer
  std::uint64_t replaces;  // 0, or `issued` of the confirmed image that it may replace although it is older
  std::uint64_t fingerprint;  // of the image's equation
  std::uint8_t key[24];       // first bytes of the public key that checks the signature
  std::uint8_t signature[64];
};
static_assert(sizeof(UploadHeader) == 128);
static_assert(offsetof(UploadHeader, magic) == 0 && offsetof(UploadHeader, header_bytes) == 8 &&
              offsetof(UploadHeader, image_bytes) == 12 && offsetof(UploadHeader, issued) == 16 &&
              offsetof(UploadHeader, replaces) == 24 && offsetof(UploadHeader, fingerprint) == 32 &&
              offsetof(UploadHeader, key) == 40 && offsetof(UploadHeader, signature) == 64);
/// Not sent: another layout takes another kUploadMagic and another number here.
constexpr std::uint32_t kUploadFormatVersion = 1;
constexpr std::uint8_t kUploadMagic[8] = {'V', 'E', 'R', 'N', 'U', 'P', 'L', '\n'};
constexpr std::uint32_t kSignedHeaderBytes = 64;  // of the header, those under the signature

constexpr std::uint32_t kPublicKeyBytes = 32;

}  // namespace vernier
