// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstddef>
#include <cstdint>

namespace vernier {

constexpr std::uint32_t kBoardNameBytes = 24;

/// Content of an upload and of a slot: UploadHeader (little-endian, 152 bytes), and then the correction image
/// (image_format.h). The signature (Ed25519 in its pre-hashed form, Ed25519ph, RFC 8032) covers the header up
/// to the signature and the whole image.
struct UploadHeader {
  std::uint8_t magic[8];       // kUploadMagic
  std::uint32_t header_bytes;  // 152
  std::uint32_t image_bytes;
  std::uint64_t issued;  // signing time, microseconds since 1970; it must be later than that of all images
                         // that were ever on trial
  std::uint64_t fingerprint;  // fingerprint of the equation in the image
  std::uint32_t security;  // security number; it must be at least the highest number that was ever on trial.
                           // The security number is increased to exclude older images permanently
  std::uint32_t reserved;  // 0
  char board[kBoardNameBytes];  // name of the board (or of the board class) for which the image is; zeros: a
                                // board without a name
  std::uint8_t key[24];         // first bytes of the public key that verifies the signature
  std::uint8_t signature[64];
};
static_assert(sizeof(UploadHeader) == 152);
static_assert(offsetof(UploadHeader, magic) == 0 && offsetof(UploadHeader, header_bytes) == 8 &&
              offsetof(UploadHeader, image_bytes) == 12 && offsetof(UploadHeader, issued) == 16 &&
              offsetof(UploadHeader, fingerprint) == 24 && offsetof(UploadHeader, security) == 32 &&
              offsetof(UploadHeader, reserved) == 36 && offsetof(UploadHeader, board) == 40 &&
              offsetof(UploadHeader, key) == 64 && offsetof(UploadHeader, signature) == 88);
/// Version of this header layout. The version is not sent. A new layout requires a new kUploadMagic and a new
/// number here.
constexpr std::uint32_t kUploadFormatVersion = 2;
constexpr std::uint8_t kUploadMagic[8] = {'V', 'E', 'R', 'N', 'U', 'P', '2', '\n'};
constexpr std::uint32_t kSignedHeaderBytes = 88;  // number of bytes of the header that the signature covers
/// Latest accepted time of signing (the year 2200). A later signing time is caused by a wrong clock, and
/// would block all later uploads.
constexpr std::uint64_t kLatestIssued = 7'258'118'400'000'000;

/// Upload header of version 1, which contains no board name. An image that was confirmed with a header of
/// version 1 still runs. A new upload with a header of version 1 is refused.
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

/// First part of a signed request. The signature (Ed25519ph) covers the first part, the operation code and
/// the payload of the request.
struct SignedRequestHead {
  std::uint8_t magic[8];       // kRequestMagic
  std::uint8_t nonce[16];      // nonce of the board, which is new for each start
  std::uint8_t challenge[16];  // challenge of the last ten seconds over this connection; it can be used only
                               // once
  char board[kBoardNameBytes];
};
static_assert(sizeof(SignedRequestHead) == 64);
static_assert(offsetof(SignedRequestHead, magic) == 0 && offsetof(SignedRequestHead, nonce) == 8 &&
              offsetof(SignedRequestHead, challenge) == 24 && offsetof(SignedRequestHead, board) == 40);
constexpr std::uint8_t kRequestMagic[8] = {'V', 'E', 'R', 'N', 'C', 'M', 'D', '2'};

constexpr std::uint32_t kPublicKeyBytes = 32;

/// Data (80 bytes) that a board signs with its key, by Ed25519ph, to prove its identity.
struct IdentityHead {
  std::uint8_t magic[8];         // kIdentityMagic
  std::uint8_t asked_nonce[32];  // nonce of the client, which is new for each request
  std::uint8_t start_nonce[16];  // nonce of this start of the board; signed requests contain the same nonce
  char board[kBoardNameBytes];   // name of the board in its board file
};
static_assert(sizeof(IdentityHead) == 80);
static_assert(offsetof(IdentityHead, magic) == 0 && offsetof(IdentityHead, asked_nonce) == 8 &&
              offsetof(IdentityHead, start_nonce) == 40 && offsetof(IdentityHead, board) == 56);
constexpr std::uint8_t kIdentityMagic[8] = {'V', 'E', 'R', 'N', 'I', 'D', '1', '\n'};

}  // namespace vernier
