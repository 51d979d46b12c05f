// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <string>
#include <vector>

#include "tables/image_view.h"

namespace vernier {

/// An image with its bytes: a view of a file needs them.
class ImageFile {
 public:
  /// Takes the bytes (aligned by copying) and validates them. setup.
  ImageFault open(const std::vector<std::uint8_t>& bytes);
  /// Valid after open() returned kNone.
  const ImageView& view() const noexcept { return view_; }

 private:
  std::vector<std::uint64_t> words_;
  ImageView view_;
};

/// The bytes of a file; false if it cannot be read. setup.
bool read_bytes(const std::string& path, std::vector<std::uint8_t>& bytes);

}  // namespace vernier
