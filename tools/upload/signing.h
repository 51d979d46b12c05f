// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "tables/link_format.h"
#include "tables/upload_format.h"

namespace vernier::upload {

/// A key pair: the secret half signs uploads, the public half is given to boards.
struct SigningKey {
  std::array<std::uint8_t, 64> secret;  // libsodium's form, the public half included
  std::array<std::uint8_t, kPublicKeyBytes> public_part() const;
};

/// Public key of the board (vernierd has the key pair in its store).
using BoardPublicKey = std::array<std::uint8_t, kPublicKeyBytes>;
/// Returns a key as 64 hexadecimal digits, as `vernierd` and `vernier board identify` print it.
std::string board_key_text(const BoardPublicKey& key);
/// The key in a text: 64 hexadecimal digits, or the name of a file `identity.pub` of a board's store. Throws
/// InputError if the text is neither a key nor such a file.
BoardPublicKey parse_board_key(const std::string& text);
/// 32 bytes from the system's random numbers.
std::array<std::uint8_t, 32> fresh_nonce();

/// A fresh key from the system's random numbers.
SigningKey new_key();
/// The texts of the key files.
std::string secret_key_text(const SigningKey& key);
std::string public_key_text(const SigningKey& key);
/// Reads a secret key file; throws InputError if the file is not a key, or if other users may read it.
SigningKey read_secret_key(const std::string& path);

/// Returns the key of a file, else that of VERNIER_KEY, else nullopt.
std::optional<SigningKey> given_key(const std::string& path);

/// The upload of an image: header and image, signed. issued: microseconds since 1970; security, board: see
/// UploadHeader. image: a whole image.
std::vector<std::uint8_t> make_upload(const std::vector<std::uint8_t>& image, const SigningKey& key,
                                      std::uint64_t issued, std::uint32_t security,
                                      const std::string& board = {});

/// Returns the correction image in a stored upload of this version or of the previous version. Throws
/// InputError.
std::vector<std::uint8_t> image_in(const std::vector<std::uint8_t>& upload);

/// Signs a request (op, then payload) over the board's nonce.
SignedRequest sign_request(const SigningKey& key, const SignedRequestHead& head,
                           const std::vector<std::uint8_t>& rest);

}  // namespace vernier::upload
