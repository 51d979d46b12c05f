// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>

namespace vernier {

/// Access to `size` values that another object owns. The access is not checked, because the ranges are
/// validated before the first tick. Real-time safe.
template <class T>
struct View {
  const T* data = nullptr;
  std::uint32_t size = 0;

  constexpr const T& operator[](std::uint32_t i) const noexcept { return data[i]; }
  constexpr const T* begin() const noexcept { return data; }
  constexpr const T* end() const noexcept { return data + size; }
};

}  // namespace vernier
