// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/compile/symbolic/functions.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "tools/maths/factors.h"

namespace vernier::compile {
namespace {

// Sine over an interval in degrees: its ends, and the maxima and minima at 90 + 360 k and -90 +
// 360 k between them.
Interval range_of_sine(const Interval& x) {
  if (x.high - x.low >= 360) return {-1, 1};
  constexpr double kSlack = 1e-15;  // of the library's sine
  Interval range = hull({std::sin(x.low * maths::kRadPerDeg), std::sin(x.low * maths::kRadPerDeg)},
                        {std::sin(x.high * maths::kRadPerDeg), std::sin(x.high * maths::kRadPerDeg)});
  const auto reaches = [&](double angle) {
    return std::floor((x.high - angle) / 360) >= std::ceil((x.low - angle) / 360);
  };
  if (reaches(90)) range.high = 1;
  if (reaches(-90)) range.low = -1;
  return {std::max(-1.0, range.low - kSlack), std::min(1.0, range.high + kSlack)};
}

}  // namespace

double value_of(Function f, double x) {
  switch (f) {
    case Function::kSin:
      return std::sin(x * maths::kRadPerDeg);
    case Function::kCos:
      return std::cos(x * maths::kRadPerDeg);
    case Function::kExp:
      return std::exp(x);
    case Function::kLog:
      return std::log(x);
    case Function::kSqrt:
      return std::sqrt(x);
    case Function::kReciprocal:
      return 1 / x;
    case Function::kArcTangent:
      return std::atan(x) / maths::kRadPerDeg;
  }
  throw std::logic_error("unknown function");
}

double slope_of(Function f, double x) {
  switch (f) {
    case Function::kSin:
      return maths::kRadPerDeg * std::cos(x * maths::kRadPerDeg);
    case Function::kCos:
      return -maths::kRadPerDeg * std::sin(x * maths::kRadPerDeg);
    case Function::kExp:
      return std::exp(x);
    case Function::kLog:
      return 1 / x;
    case Function::kSqrt:
      return 0.5 / std::sqrt(x);
    case Function::kReciprocal:
      return -1 / (x * x);
    case Function::kArcTangent:
      return 1 / (1 + x * x) / maths::kRadPerDeg;
  }
  throw std::logic_error("unknown function");
}

// Each of these functions has its largest slope and curvature at the end of the interval nearest
// to zero. Exceptions are exp (at the high end), sine, cosine and arc tangent (bounded
// everywhere).
double slope_bound(Function f, const Interval& x) {
  const double nearest = std::min(std::abs(x.low), std::abs(x.high));
  switch (f) {
    case Function::kSin:
    case Function::kCos:
      return maths::kRadPerDeg;
    case Function::kExp:
      return std::exp(x.high);
    case Function::kArcTangent:
      return 1 / maths::kRadPerDeg;
    default:
      return std::abs(slope_of(f, nearest));
  }
}

double fourth_derivative_bound(Function f, const Interval& x) {
  const double nearest = std::min(std::abs(x.low), std::abs(x.high));
  switch (f) {
    case Function::kSin:
    case Function::kCos:
      return maths::kRadPerDeg * maths::kRadPerDeg * maths::kRadPerDeg * maths::kRadPerDeg;
    case Function::kExp:
      return std::exp(x.high);
    case Function::kLog:
      return 6 / std::pow(nearest, 4);
    case Function::kSqrt:
      return 15.0 / 16 * std::pow(nearest, -3.5);
    case Function::kReciprocal:
      return 24 / std::pow(nearest, 5);
    case Function::kArcTangent:
      return 4.67 / maths::kRadPerDeg;  // max of |24 x (1 - x^2) / (1 + x^2)^4| is 4.669
  }
  throw std::logic_error("unknown function");
}

const char* name_of(Function f) {
  switch (f) {
    case Function::kSin:
      return "sin";
    case Function::kCos:
      return "cos";
    case Function::kExp:
      return "exp";
    case Function::kLog:
      return "log";
    case Function::kSqrt:
      return "sqrt";
    case Function::kReciprocal:
      return "one_over";
    case Function::kArcTangent:
      return "atan";
  }
  throw std::logic_error("unknown function");
}

Interval range_of_function(Function f, const Interval& x) {
  switch (f) {
    case Function::kSin:
      return range_of_sine(x);
    case Function::kCos:
      return range_of_sine({x.low + 90, x.high + 90});
    case Function::kReciprocal:
      return {1 / x.high, 1 / x.low};
    default:
      return {value_of(f, x.low), value_of(f, x.high)};
  }
}

}  // namespace vernier::compile
