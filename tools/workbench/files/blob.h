// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <Eigen/Core>
#include <cstdint>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

namespace vernier::workbench {

/// JSON followed by long rows of numbers, for the page: a 4-byte length, the JSON padded with blanks to a
/// multiple of 4, then the arrays, little-endian, each on a multiple of 4. In the JSON an array is {"f32":
/// [offset, count]}, {"u32": ...} or {"u8": ...}; the offset is from the first byte after the JSON.
class Blob {
 public:
  /// Adds numbers and returns their JSON placeholder; values that are not finite stay unchanged.
  nlohmann::ordered_json f32(const std::vector<float>& values);
  nlohmann::ordered_json f32(const Eigen::ArrayXd& values);
  nlohmann::ordered_json u32(const std::vector<std::uint32_t>& values);
  nlohmann::ordered_json u8(const std::vector<std::uint8_t>& values);
  /// The whole.
  std::string bytes(const nlohmann::ordered_json& header) const;

 private:
  nlohmann::ordered_json add(const char* type, const void* data, std::size_t count, std::size_t size);

  std::string arrays_;
};

}  // namespace vernier::workbench
