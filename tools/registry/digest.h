// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <string>

namespace vernier::registry {

/// Returns the hash BLAKE2b-256 of a text as hexadecimal digits.
std::string digest_of(const std::string& text);
/// Returns a random id of 32 hexadecimal digits, from the random numbers of the operating system.
std::string fresh_id();

}  // namespace vernier::registry
