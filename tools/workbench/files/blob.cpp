// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/workbench/files/blob.h"

#include <bit>
#include <cstring>

namespace vernier::workbench {

static_assert(std::endian::native == std::endian::little,
              "arrays are written in the byte order of the memory, which must be little-endian");

nlohmann::ordered_json Blob::add(const char* type, const void* data, std::size_t count, std::size_t size) {
  const std::size_t offset = arrays_.size();
  if (count > 0) arrays_.append(static_cast<const char*>(data), count * size);
  arrays_.resize((arrays_.size() + 3) / 4 * 4, '\0');
  return {{type, {offset, count}}};
}

nlohmann::ordered_json Blob::f32(const std::vector<float>& values) {
  return add("f32", values.data(), values.size(), sizeof(float));
}

nlohmann::ordered_json Blob::f32(const Eigen::ArrayXd& values) {
  const Eigen::ArrayXf narrow = values.cast<float>();
  return add("f32", narrow.data(), static_cast<std::size_t>(narrow.size()), sizeof(float));
}

nlohmann::ordered_json Blob::u32(const std::vector<std::uint32_t>& values) {
  return add("u32", values.data(), values.size(), sizeof(std::uint32_t));
}

nlohmann::ordered_json Blob::u8(const std::vector<std::uint8_t>& values) {
  return add("u8", values.data(), values.size(), 1);
}

std::string Blob::bytes(const nlohmann::ordered_json& header) const {
  std::string text = header.dump(-1, ' ', false, nlohmann::ordered_json::error_handler_t::replace);
  text.resize((text.size() + 3) / 4 * 4, ' ');
  const auto length = static_cast<std::uint32_t>(text.size());
  std::string all(sizeof length, '\0');
  std::memcpy(all.data(), &length, sizeof length);
  return all + text + arrays_;
}

}  // namespace vernier::workbench
