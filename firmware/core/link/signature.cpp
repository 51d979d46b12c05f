// SPDX-License-Identifier: Apache-2.0
// The signature check of targets without a cryptographic library.
#include "firmware/core/link/signature.h"
#include "firmware/core/link/ed25519.h"

namespace vernier {

bool signature_fits(std::span<const std::uint8_t> head, std::span<const std::uint8_t> rest,
                    const std::uint8_t* signature, const PublicKey& key) {
  return ed25519ph_fits(head.data(), static_cast<std::uint32_t>(head.size()), rest.data(),
                        static_cast<std::uint32_t>(rest.size()), signature, key.data());
}

}  // namespace vernier
