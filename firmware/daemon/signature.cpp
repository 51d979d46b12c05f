// SPDX-License-Identifier: Apache-2.0
#include "firmware/core/link/signature.h"

#include <sodium.h>

namespace vernier {

static_assert(kPublicKeyBytes == crypto_sign_PUBLICKEYBYTES);
static_assert(sizeof(UploadHeader::signature) == crypto_sign_BYTES);

bool signature_fits(std::span<const std::uint8_t> head, std::span<const std::uint8_t> rest,
                    const std::uint8_t* signature, const PublicKey& key) {
  if (sodium_init() < 0) return false;
  crypto_sign_state state;
  crypto_sign_init(&state);
  crypto_sign_update(&state, head.data(), head.size());
  crypto_sign_update(&state, rest.data(), rest.size());
  // The library's interface is not const-correct; it does not write.
  return crypto_sign_final_verify(&state, const_cast<std::uint8_t*>(signature), key.data()) == 0;
}

}  // namespace vernier
