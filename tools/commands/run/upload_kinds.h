// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <cstdint>
#include <string>
#include <vector>

namespace vernier::commands::upload_cli {

/// The image of a directory that `vernier compile` wrote, after a further test of the sheet "safe to run?".
/// Throws InputError if the file is not an image, LimitNotMet if the image may not run.
std::vector<std::uint8_t> safe_image(const std::string& directory);

}  // namespace vernier::commands::upload_cli
