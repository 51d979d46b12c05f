// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <cstdint>
#include <vector>

#include "tables/image_view.h"
#include "tools/upload/signing.h"

namespace vernier::golden {

using namespace vernier::upload;

/// The image of a small machine with every kind of channel, operation and table, as the compiler writes it
/// now.
std::vector<std::uint8_t> golden_image();

/// A key from a fixed seed.
SigningKey golden_key();

/// An image in aligned memory, opened.
struct AlignedImage {
  explicit AlignedImage(const std::vector<std::uint8_t>& bytes);
  std::vector<std::uint64_t> words;
  ImageView view;
  ImageFault fault = ImageFault::kNone;
};

}  // namespace vernier::golden
