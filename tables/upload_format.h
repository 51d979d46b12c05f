// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstddef>
#include <cstdint>

namespace vernier {

constexpr std::uint32_t kBoardNameBytes = 24;

/// Contents of an upload and of a slot: UploadHeader (little-endian, 152 bytes), then the correction image
/// (image_format.h). The signature, Ed25519 in its pre-hashed form (RFC 8032, Ed25519ph), covers the header
/// up to the signature and the whole image.
struct UploadHeader {
  std::uint8_t magic[8];       // kUploadMagic
  std::uint32_t header_bytes;  // 152
  std::uint32_t image_bytes;
  std::uint64_t issued;  // when it was signed, microseconds since 1970: higher than all that were ever tried
  std::uint64_t fingerprint;  // of the image's equation
  std::uint32_t
      security;  // at least the highest that was ever tried: raised to shut older images out for good
  std::uint32_t reserved;  // 0
  char
      board[kBoardNameBytes];  // name of the board that it is for, or of its class; zeros: one without a name
  std::uint8_t key[24];        // first bytes of the public key that checks the signature
  std::uint8_t signature[64];
};
static_assert(sizeof(UploadHeader) == 152);
static_assert(offsetof(UploadHeader, magic) == 0 && offsetof(UploadHeader, header_bytes) == 8 &&
              offsetof(UploadHeader, image_bytes) == 12 && offsetof(UploadHeader, issued) == 16 &&
              offsetof(UploadHeader, fingerprint) == 24 && offsetof(UploadHeader, security) == 32 &&
              offsetof(UploadHeader, reserved) == 36 && offsetof(UploadHeader, board) == 40 &&
              offsetof(UploadHeader, key) == 64 && offsetof(UploadHeader, signature) == 88);
/// Version of the upload header; the version is not sent. A new layout requires a new kUploadMagic and a new
/// number here.
constexpr std::uint32_t kUploadFormatVersion = 2;
constexpr std::uint8_t kUploadMagic[8] = {'V', 'E', 'R', 'N', 'U', 'P', '2', '\n'};
constexpr std::uint32_t kSignedHeaderBytes = 88;  // of the header, those under the signature
/// Latest accepted time of signing (the year 2200). A later time is due to a wrong clock, and would block all
/// later uploads.
constexpr std::uint64_t kLatestIssued = 7'258'118'400'000'000;

/// Header of version 1, which names no board. A slot that was confirmed with it still runs; a new upload with
/// it is refused.
struct UploadHeaderV1 {
  std::uint8_t magic[8];       // kUploadMagicV1
  std::uint32_t header_bytes;  // 128
  std::uint32_t image_bytes;
  std::uint64_t issued, replaces, fingerprint;
  std::uint8_t key[24];
  std::uint8_t signature[64];
};
static_assert(sizeof(UploadHeaderV1) == 128);
static_assert(offsetof(UploadHeaderV1, magic) == 0 && offsetof(UploadHeaderV1, header_bytes) == 8 &&
              offsetof(UploadHeaderV1, image_bytes) == 12 && offsetof(UploadHeaderV1, issued) == 16 &&
              offsetof(UploadHeaderV1, replaces) == 24 && offsetof(UploadHeaderV1, fingerprint) == 32 &&
              offsetof(UploadHeaderV1, key) == 40 && offsetof(UploadHeaderV1, signature) == 64);
constexpr std::uint8_t kUploadMagicV1[8] = {'V', 'E', 'R', 'N', 'U', 'P', 'L', '\n'};
constexpr std::uint32_t kSignedHeaderBytesV1 = 64;

/// Head of a signed request. The signature (Ed25519ph) covers this head, the op and the payload.
struct SignedRequestHead {
  std::uint8_t magic[8];       // kRequestMagic
  std::uint8_t nonce[16];      // of the board, new with each start
  std::uint8_t challenge[16];  // of the last ten seconds over this connection, which is used up by it
  char board[kBoardNameBytes];
};
static_assert(sizeof(SignedRequestHead) == 64);
static_assert(offsetof(SignedRequestHead, magic) == 0 && offsetof(SignedRequestHead, nonce) == 8 &&
              offsetof(SignedRequestHead, challenge) == 24 && offsetof(SignedRequestHead, board) == 40);
constexpr std::uint8_t kRequestMagic[8] = {'V', 'E', 'R', 'N', 'C', 'M', 'D', '2'};

constexpr std::uint32_t kPublicKeyBytes = 32;

/// Data that a board signs with its key to prove its identity: Ed25519ph of these 80 bytes.
struct IdentityHead {
  std::uint8_t magic[8];         // kIdentityMagic
  std::uint8_t asked_nonce[32];  // of the client, new with each request
  std::uint8_t start_nonce[16];  // of this start of the board: signed requests name the same one
  char board[kBoardNameBytes];   // name in its board file
};
static_assert(sizeof(IdentityHead) == 80);
static_assert(offsetof(IdentityHead, magic) == 0 && offsetof(IdentityHead, asked_nonce) == 8 &&
              offsetof(IdentityHead, start_nonce) == 40 && offsetof(IdentityHead, board) == 56);
constexpr std::uint8_t kIdentityMagic[8] = {'V', 'E', 'R', 'N', 'I', 'D', '1', '\n'};

}  // namespace vernier
