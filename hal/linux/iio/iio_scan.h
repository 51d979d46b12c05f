// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstddef>
#include <cstdint>
#include <string_view>

namespace vernier {

/// Layout of a channel in the scans of an IIO buffer (scan_elements/*_type,
/// Documentation/ABI/testing/sysfs-bus-iio).
struct IioElement {
  bool big_endian = false, is_signed = false;
  std::uint32_t bits = 0, storage_bits = 0, shift = 0;
  std::uint32_t repeat = 1;  // number of successive elements, of which the first is used

  /// Returns the number of bytes of all values of a channel. The offset of a channel in a scan is a multiple
  /// of the number of bytes of its values.
  std::uint32_t bytes() const noexcept { return storage_bits / 8 * repeat; }
};

/// Parses the description of a channel: "le:s16/16>>0", "be:u24/32X2>>8" and others. Returns false for any
/// other text, or if the storage is not 8, 16, 32 or 64 bits or has fewer bits than the value. Not real-time
/// safe.
bool parse_iio_element(std::string_view text, IioElement& element) noexcept;

/// Returns the value of a channel whose storage begins at `storage`. The value is converted to the byte order
/// of the processor, shifted, limited to its bits, and extended with its sign. An unsigned value of 64 bits
/// is limited to the largest int64. Real-time safe.
std::int64_t iio_value(const unsigned char* storage, const IioElement& element) noexcept;

/// Returns the offset of an element that follows `at` bytes of a scan; elements are aligned to their size.
constexpr std::size_t iio_aligned(std::size_t at, std::size_t size) noexcept {
  return (at + size - 1) / size * size;
}

}  // namespace vernier
