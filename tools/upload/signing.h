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

/// A key pair: the secret key signs uploads, and boards store the public key to check the signatures.
struct SigningKey {
  std::array<std::uint8_t, 64> secret;  // secret key in the format of libsodium, which includes the public
                                        // key
  std::array<std::uint8_t, kPublicKeyBytes> public_part() const;
};

/// Public key of a board (vernierd stores the board's key pair).
using BoardPublicKey = std::array<std::uint8_t, kPublicKeyBytes>;
/// Returns the public key of a board as 64 hexadecimal digits, as `vernierd` and `vernier board identify`
/// print it.
std::string board_key_text(const BoardPublicKey& key);
/// Reads the public key of a board from a text: 64 hexadecimal digits, or the name of a file `identity.pub`
/// from a board's store. Throws InputError if the text is neither a key nor such a file.
BoardPublicKey parse_board_key(const std::string& text);
/// Returns 32 random bytes from the operating system.
std::array<std::uint8_t, 32> fresh_nonce();

/// Returns a new key pair from the random numbers of the operating system.
SigningKey new_key();
/// Return the contents of the secret key file and of the public key file.
std::string secret_key_text(const SigningKey& key);
std::string public_key_text(const SigningKey& key);
/// Reads a secret key file. Throws InputError if the file contains no key, or if other users may read the
/// file.
SigningKey read_secret_key(const std::string& path);

/// Returns the key in the file `path`. Without `path` it returns the key in the file that the environment
/// variable VERNIER_KEY names, and without this variable nullopt.
std::optional<SigningKey> given_key(const std::string& path);

/// Returns the signed upload (header and correction image) for a board. issued: time of issue in microseconds
/// since 1970; security, board: fields of UploadHeader. image: a complete correction image.
std::vector<std::uint8_t> make_upload(const std::vector<std::uint8_t>& image, const SigningKey& key,
                                      std::uint64_t issued, std::uint32_t security,
                                      const std::string& board = {});

/// Returns the correction image of a stored upload in the present or the previous version of the format.
/// Throws InputError if the bytes are not such an upload.
std::vector<std::uint8_t> image_in(const std::vector<std::uint8_t>& upload);

/// Signs a request (operation code and payload) together with the nonce of the board.
SignedRequest sign_request(const SigningKey& key, const SignedRequestHead& head,
                           const std::vector<std::uint8_t>& rest);

}  // namespace vernier::upload
