// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <string>

namespace vernier::registry {

/// BLAKE2b-256 of a text, in hexadecimal digits.
std::string digest_of(const std::string& text);
/// 32 hexadecimal digits from the system's random numbers.
std::string fresh_id();

}  // namespace vernier::registry
