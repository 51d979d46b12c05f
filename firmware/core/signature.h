// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <array>
#include <cstdint>
#include <span>

#include "tables/upload_format.h"

namespace vernier {

using PublicKey = std::array<std::uint8_t, kPublicKeyBytes>;

/// Does the signature of an upload (tables/upload_format.h) fit its header, its image and this key?
/// Ed25519ph, RFC 8032. A port defines it, with the library that it has; where it has none,
/// firmware/core/signature.cpp does. setup.
bool signature_fits(const UploadHeader& header, std::span<const std::uint8_t> image, const PublicKey& key);

}  // namespace vernier
