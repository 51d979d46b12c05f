// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <array>
#include <cstdint>
#include <vector>

#include "tables/upload_format.h"

namespace vernier {

using PublicKey = std::array<std::uint8_t, kPublicKeyBytes>;

/// Does the signature of an upload (tables/upload_format.h) fit its bytes and this key? upload: header and
/// image. Ed25519ph, RFC 8032. setup.
bool signature_fits(const std::vector<std::uint8_t>& upload, const PublicKey& key);

}  // namespace vernier
