// SPDX-License-Identifier: Apache-2.0
#include "hal/linux/iio/iio_scan.h"

#include <charconv>

namespace vernier {
namespace {

/// Takes a number off the front of a text.
bool take_number(std::string_view& text, std::uint32_t& value) noexcept {
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (error != std::errc()) return false;
  text.remove_prefix(static_cast<std::size_t>(end - text.data()));
  return true;
}

bool take(std::string_view& text, std::string_view word) noexcept {
  if (!text.starts_with(word)) return false;
  text.remove_prefix(word.size());
  return true;
}

}  // namespace

bool parse_iio_element(std::string_view text, IioElement& element) noexcept {
  IioElement read;
  constexpr std::uint32_t kMostRepeats = 64, kMostBits = 64;
  read.big_endian = text.starts_with("be:");
  if (!take(text, "le:") && !take(text, "be:")) return false;
  read.is_signed = text.starts_with("s");
  if (!take(text, "s") && !take(text, "u")) return false;
  if (!take_number(text, read.bits) || !take(text, "/") || !take_number(text, read.storage_bits))
    return false;
  if (take(text, "X") && !take_number(text, read.repeat)) return false;
  if (!take(text, ">>") || !take_number(text, read.shift)) return false;
  while (!text.empty() && (text.back() == '\n' || text.back() == ' ')) text.remove_suffix(1);
  const bool storable = read.storage_bits == 8 || read.storage_bits == 16 || read.storage_bits == 32 ||
                        read.storage_bits == kMostBits;
  const bool fits = read.bits >= 1 && read.bits <= kMostBits && read.shift <= kMostBits &&
                    read.bits + read.shift <= read.storage_bits;
  if (!text.empty() || !storable || !fits || read.repeat < 1 || read.repeat > kMostRepeats) return false;
  element = read;
  return true;
}

std::int64_t iio_value(const unsigned char* storage, const IioElement& element) noexcept {
  const std::uint32_t bytes = element.storage_bits / 8;
  std::uint64_t value = 0;
  for (std::uint32_t i = 0; i < bytes; ++i)
    value = value << 8 | storage[element.big_endian ? i : bytes - 1 - i];
  // Shift up and down again: this removes the other bits beside the value and extends its sign.
  const std::uint32_t unused = 64 - element.bits;
  value = value >> element.shift << unused;
  if (element.is_signed) return static_cast<std::int64_t>(value) >> unused;
  value >>= unused;
  return value > static_cast<std::uint64_t>(INT64_MAX) ? INT64_MAX : static_cast<std::int64_t>(value);
}

}  // namespace vernier
