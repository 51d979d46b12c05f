// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <algorithm>
#include <cmath>

namespace vernier::compile {

/// Interval of the values of a quantity over the declared ranges; low <= high.
struct Interval {
  double low = 0, high = 0;

  double magnitude() const { return std::max(std::abs(low), std::abs(high)); }
  bool contains(double x) const { return low <= x && x <= high; }
};

inline Interval operator+(const Interval& a, const Interval& b) { return {a.low + b.low, a.high + b.high}; }
inline Interval operator*(double k, const Interval& a) {
  return k < 0 ? Interval{k * a.high, k * a.low} : Interval{k * a.low, k * a.high};
}
inline Interval operator*(const Interval& a, const Interval& b) {
  const auto [low, high] = std::minmax({a.low * b.low, a.low * b.high, a.high * b.low, a.high * b.high});
  return {low, high};
}
inline Interval square(const Interval& a) {
  const double far = a.magnitude(), near = a.contains(0) ? 0 : std::min(std::abs(a.low), std::abs(a.high));
  return {near * near, far * far};
}
inline Interval hull(const Interval& a, const Interval& b) {
  return {std::min(a.low, b.low), std::max(a.high, b.high)};
}

}  // namespace vernier::compile
