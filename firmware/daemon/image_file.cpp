// SPDX-License-Identifier: Apache-2.0
#include "firmware/daemon/image_file.h"

#include <cstring>
#include <fstream>
#include <iterator>
#include <memory>

namespace vernier {

ImageFault ImageFile::open(const std::vector<std::uint8_t>& bytes) {
  words_.assign((bytes.size() + sizeof(std::uint64_t) - 1) / sizeof(std::uint64_t), 0);
  if (!bytes.empty()) std::memcpy(words_.data(), bytes.data(), bytes.size());
  const auto workspace = std::make_unique<ImageWorkspace>();
  return view_.open(reinterpret_cast<const std::uint8_t*>(words_.data()),
                    static_cast<std::uint32_t>(bytes.size()), *workspace);
}

bool read_bytes(const std::string& path, std::vector<std::uint8_t>& bytes) {
  std::ifstream file(path, std::ios::binary);
  if (!file) return false;
  bytes.assign(std::istreambuf_iterator<char>(file), {});
  return !file.bad();
}

}  // namespace vernier
