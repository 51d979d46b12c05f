// SPDX-License-Identifier: Apache-2.0
#include "firmware/core/signature.h"

#include <sodium.h>

#include <cstddef>

namespace vernier {

static_assert(kPublicKeyBytes == crypto_sign_PUBLICKEYBYTES);
static_assert(sizeof(UploadHeader::signature) == crypto_sign_BYTES);

bool signature_fits(const std::vector<std::uint8_t>& upload, const PublicKey& key) {
  if (sodium_init() < 0 || upload.size() < sizeof(UploadHeader)) return false;
  crypto_sign_state state;
  crypto_sign_init(&state);
  crypto_sign_update(&state, upload.data(), kSignedHeaderBytes);
  crypto_sign_update(&state, upload.data() + sizeof(UploadHeader), upload.size() - sizeof(UploadHeader));
  // The library's interface is not const-correct; it does not write.
  return crypto_sign_final_verify(
             &state, const_cast<std::uint8_t*>(upload.data()) + offsetof(UploadHeader, signature),
             key.data()) == 0;
}

}  // namespace vernier
