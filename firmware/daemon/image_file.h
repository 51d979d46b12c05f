// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <string>
#include <vector>

#include "tables/image_view.h"

namespace vernier {

/// A correction image and the bytes of its file. Views of the image point to these bytes.
class ImageFile {
 public:
  /// Copies the bytes of an image to aligned memory, and checks the image. Not real-time safe.
  ImageFault open(const std::vector<std::uint8_t>& bytes);
  /// Returns a view of the image. The view is valid after open() returned kNone.
  const ImageView& view() const noexcept { return view_; }

 private:
  std::vector<std::uint64_t> words_;
  ImageView view_;
};

/// Reads the bytes of a file. Returns false if the file cannot be read. Not real-time safe.
bool read_bytes(const std::string& path, std::vector<std::uint8_t>& bytes);

}  // namespace vernier
