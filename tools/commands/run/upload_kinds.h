// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <cstdint>
#include <string>
#include <vector>

namespace vernier::commands::upload_cli {

/// Returns the correction image from a directory that `vernier compile` wrote. Before the image is returned,
/// the rules of the safety sheet ("safe to run?") are tested again. Throws InputError if the file is not a
/// correction image, and LimitNotMet if the image must not run.
std::vector<std::uint8_t> safe_image(const std::string& directory);

}  // namespace vernier::commands::upload_cli
