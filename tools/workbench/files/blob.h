// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <Eigen/Core>
#include <cstdint>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

namespace vernier::workbench {

/// Data format for the page: JSON followed by arrays of numbers. The data have a 4-byte length, the JSON
/// padded with blanks to a multiple of 4 bytes, and then the arrays (little-endian), each at a multiple of 4
/// bytes. In the JSON an array is written as {"f32": [offset, count]}, {"u32": ...} or {"u8": ...}. The
/// offset is counted from the first byte after the JSON.
class Blob {
 public:
  /// Adds an array of numbers and returns its JSON placeholder. Numbers that are not finite are not changed.
  nlohmann::ordered_json f32(const std::vector<float>& values);
  nlohmann::ordered_json f32(const Eigen::ArrayXd& values);
  nlohmann::ordered_json u32(const std::vector<std::uint32_t>& values);
  nlohmann::ordered_json u8(const std::vector<std::uint8_t>& values);
  /// Returns the complete data: length, JSON and arrays.
  std::string bytes(const nlohmann::ordered_json& header) const;

 private:
  nlohmann::ordered_json add(const char* type, const void* data, std::size_t count, std::size_t size);

  std::string arrays_;
};

}  // namespace vernier::workbench
