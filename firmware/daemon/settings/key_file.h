// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <string>

#include "firmware/core/link/signature.h"

namespace vernier {

/// An error in a board file, or in a file that the board file names. Example: "board.toml:12: axis.X: kind:
/// 'lineal' is neither linear nor rotary".
struct BoardError {
  std::string what;
};

/// Returns the 32 bytes of a public key from a key file (base64 after a header line). Throws BoardError if
/// the file is not a public key. Not real-time safe.
PublicKey read_public_key(const std::string& path);

}  // namespace vernier
