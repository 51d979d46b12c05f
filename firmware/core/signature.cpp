// SPDX-License-Identifier: Apache-2.0
// The signature check of targets without a cryptographic library.
#include "firmware/core/signature.h"
#include "firmware/core/ed25519.h"

namespace vernier {

bool signature_fits(const UploadHeader& header, std::span<const std::uint8_t> image, const PublicKey& key) {
  return ed25519ph_fits(reinterpret_cast<const std::uint8_t*>(&header), kSignedHeaderBytes, image.data(),
                        static_cast<std::uint32_t>(image.size()), header.signature, key.data());
}

}  // namespace vernier
