// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <initializer_list>
#include <string_view>

#include "comp/equation.h"
#include "tables/image_format.h"

namespace vernier {

/// A name with the length limit of images: at most kImageNameBytes - 1 characters. Longer names are
/// truncated.
class Name {
 public:
  constexpr Name() = default;
  constexpr Name(const char* text) noexcept : Name(std::string_view(text)) {}
  constexpr Name(std::string_view text) noexcept {
    for (const char letter : text) add(letter);
  }
  constexpr const char* c_str() const noexcept { return text_; }
  constexpr bool empty() const noexcept { return size_ == 0; }
  constexpr std::uint32_t size() const noexcept { return size_; }
  constexpr operator std::string_view() const noexcept { return {text_, size_}; }
  /// Appends a digit or a letter. If the name has its largest length, the character is omitted. Not real-time
  /// safe.
  constexpr void add(char letter) noexcept {
    if (size_ + 1 < sizeof(text_)) text_[size_++] = letter;
  }
  friend constexpr bool operator==(const Name& a, std::string_view b) noexcept {
    return std::string_view(a) == b;
  }
  friend constexpr bool operator==(const Name& a, const char* b) noexcept {
    return std::string_view(a) == std::string_view(b);
  }
  friend constexpr bool operator==(const Name& a, const Name& b) noexcept {
    return std::string_view(a) == std::string_view(b);
  }

 private:
  char text_[kImageNameBytes] = {};
  std::uint32_t size_ = 0;
};

/// A list of at most kMost values, without heap memory. Values beyond kMost are ignored; therefore the caller
/// must check the number of values before.
template <class T, std::uint32_t kMost>
class FixedList {
 public:
  constexpr FixedList() = default;
  constexpr FixedList(std::initializer_list<T> values) {
    for (const T& value : values) push_back(value);
  }
  constexpr void push_back(const T& value) noexcept {
    if (size_ < kMost) values_[size_++] = value;
  }
  constexpr std::uint32_t size() const noexcept { return size_; }
  constexpr bool empty() const noexcept { return size_ == 0; }
  constexpr const T& operator[](std::size_t i) const noexcept { return values_[i]; }
  constexpr const T* begin() const noexcept { return values_; }
  constexpr const T* end() const noexcept { return values_ + size_; }

 private:
  T values_[kMost] = {};
  std::uint32_t size_ = 0;
};

/// Names of the devices of a board, in the order of the devices. Images refer to axes and inputs by name. The
/// wiring gives the device of each name.
struct Wiring {
  struct Axis {
    Name name;
    bool rotary = false, rollover = false;
    // true: the controller counts whole turns without a reset, so that an image fits with and without
    // rollover of its axis
    bool continuous = false;
  };
  FixedList<Axis, kMaxAxes> axes;
  FixedList<Name, kMaxInputs> inputs;
};

}  // namespace vernier
