// SPDX-License-Identifier: Apache-2.0
#include "firmware/daemon/settings/key_file.h"

#include <sodium.h>

#include <fstream>

namespace vernier {

PublicKey read_public_key(const std::string& path) {
  std::ifstream file(path);
  std::string title, text;
  if (!std::getline(file, title) || !std::getline(file, text))
    throw BoardError{path + ": cannot be read as a public key"};
  PublicKey key{};
  std::size_t size = 0;
  if (title != "vernier board public key" ||
      sodium_base642bin(key.data(), key.size(), text.c_str(), text.size(), nullptr, &size, nullptr,
                        sodium_base64_VARIANT_ORIGINAL) != 0 ||
      size != key.size())
    throw BoardError{path + ": not a public key of vernier keys"};
  return key;
}

}  // namespace vernier
