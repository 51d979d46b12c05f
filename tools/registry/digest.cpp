// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/registry/digest.h"

#include <sodium.h>

#include <stdexcept>

namespace vernier::registry {

std::string digest_of(const std::string& text) {
  unsigned char bytes[32];
  char hex[2 * sizeof(bytes) + 1];
  crypto_generichash(bytes, sizeof(bytes), reinterpret_cast<const unsigned char*>(text.data()), text.size(),
                     nullptr, 0);
  return sodium_bin2hex(hex, sizeof(hex), bytes, sizeof(bytes));
}

std::string fresh_id() {
  if (sodium_init() < 0) throw std::runtime_error("no random numbers");
  unsigned char bytes[16];
  char hex[2 * sizeof(bytes) + 1];
  randombytes_buf(bytes, sizeof(bytes));
  return sodium_bin2hex(hex, sizeof(hex), bytes, sizeof(bytes));
}

}  // namespace vernier::registry
