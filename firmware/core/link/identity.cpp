// SPDX-License-Identifier: Apache-2.0
#include "firmware/core/link/identity.h"

#include <cstring>

namespace vernier {

const TrustedKey* BoardIdentity::find(const std::uint8_t* first_bytes, std::uint32_t size) const noexcept {
  for (const TrustedKey& key : keys)
    if (std::memcmp(key.key.data(), first_bytes, size) == 0) return &key;
  return nullptr;
}

}  // namespace vernier
