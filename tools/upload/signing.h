// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include "tables/upload_format.h"

namespace vernier {

/// A key pair: the secret half signs uploads, the public half is given to boards.
struct SigningKey {
  std::array<std::uint8_t, 64> secret;  // libsodium's form, the public half included
  std::array<std::uint8_t, kPublicKeyBytes> public_part() const;
};

/// A fresh key from the system's random numbers. tool.
SigningKey new_key();
/// The texts of the key files. tool.
std::string secret_key_text(const SigningKey& key);
std::string public_key_text(const SigningKey& key);
/// Reads a secret key file; throws InputError where it is none, or others than its owner may read it. tool.
SigningKey read_secret_key(const std::string& path);

/// The upload of an image: header and image, signed. issued: microseconds since 1970; replaces: see
/// UploadHeader. image: a whole image. tool.
std::vector<std::uint8_t> make_upload(const std::vector<std::uint8_t>& image, const SigningKey& key,
                                      std::uint64_t issued, std::uint64_t replaces);

}  // namespace vernier
