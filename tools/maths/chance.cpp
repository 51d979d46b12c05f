// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/maths/chance.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

namespace vernier::maths {
namespace {

constexpr int kMostTerms = 10000;  // of a fraction that converges in sqrt(n)
constexpr double kDone = 1e-13;    // relative: a digit above rounding
constexpr double kTiny = 1e-300;   // replaces 0 in a denominator (modified Lentz)

/// Continued fraction of the incomplete beta function, x < (a + 1) / (a + b + 2).
double beta_fraction(double a, double b, double x) {
  double c = 1, d = 1 - (a + b) * x / (a + 1);
  d = 1 / (std::abs(d) < kTiny ? kTiny : d);
  double h = d;
  for (int m = 1; m < kMostTerms; ++m) {
    const double two_m = 2.0 * m;
    for (const double term : {m * (b - m) * x / ((a - 1 + two_m) * (a + two_m)),
                              -(a + m) * (a + b + m) * x / ((a + two_m) * (a + 1 + two_m))}) {
      d = 1 + term * d;
      c = 1 + term / c;
      d = 1 / (std::abs(d) < kTiny ? kTiny : d);
      if (std::abs(c) < kTiny) c = kTiny;
      h *= c * d;
      if (term < 0 && std::abs(c * d - 1) < kDone) return h;
    }
  }
  return h;
}

/// log of the regularised incomplete beta function I_x(a, b); y = 1 - x.
double log_beta(double a, double b, double x, double y) {
  if (x <= 0) return -std::numeric_limits<double>::infinity();
  if (y <= 0) return 0;
  const double front =
      std::lgamma(a + b) - std::lgamma(a) - std::lgamma(b) + a * std::log(x) + b * std::log(y);
  if (x < (a + 1) / (a + b + 2)) return front + std::log(beta_fraction(a, b, x) / a);
  return std::log1p(-std::min(1.0, std::exp(front) * beta_fraction(b, a, y) / b));
}

}  // namespace

double log_f_tail(double f, double d1, double d2) {
  if (!(d1 > 0) || !(d2 > 0) || !(f > 0)) return 0;
  if (std::isinf(f)) return -std::numeric_limits<double>::infinity();
  const double whole = d2 + d1 * f;
  return std::min(0.0, log_beta(d2 / 2, d1 / 2, d2 / whole, d1 * f / whole));
}

double log_chi_square_tail(double x, double k) {
  const double a = k / 2, z = x / 2;
  if (!(k > 0) || !(z > 0)) return 0;
  const double front = -z + a * std::log(z) - std::lgamma(a);
  if (z < a + 1) {
    double term = 1 / a, sum = term;
    for (int n = 1; n < kMostTerms && term > sum * kDone; ++n) sum += term *= z / (a + n);
    return std::log1p(-std::min(1.0, std::exp(front) * sum));
  }
  double b = z + 1 - a, c = 1 / kTiny, d = 1 / b, h = d;
  for (int n = 1; n < kMostTerms; ++n) {
    const double an = -n * (n - a);
    b += 2;
    d = an * d + b;
    d = 1 / (std::abs(d) < kTiny ? kTiny : d);
    c = b + an / c;
    if (std::abs(c) < kTiny) c = kTiny;
    h *= c * d;
    if (std::abs(c * d - 1) < kDone) break;
  }
  return front + std::log(h);
}

double chi_square_tail(double x, double k) { return std::exp(log_chi_square_tail(x, k)); }

double chi_square_point(double p, double k) {
  double low = 0, high = 10 * k + 100;
  constexpr int kHalvings = 80;  // to the last digit
  for (int i = 0; i < kHalvings; ++i) {
    const double middle = (low + high) / 2;
    (chi_square_tail(middle, k) > p ? low : high) = middle;
  }
  return (low + high) / 2;
}

double upper_tail(double z) { return 0.5 * std::erfc(z / std::numbers::sqrt2); }

double upper_quantile(double p) {
  // Newton's method on the logarithm of the tail.
  double z = std::sqrt(std::max(0.0, -2 * std::log(2 * p)));
  constexpr int kSteps = 20;  // five are needed from p = 0.4 to 1e-300
  for (int i = 0; i < kSteps; ++i) {
    const double tail = upper_tail(z);
    const double density = std::exp(-0.5 * z * z) / std::sqrt(2 * std::numbers::pi);
    z += (std::log(tail) - std::log(p)) * tail / density;
  }
  return z;
}

double log_correlation_tail(double r, double pairs) {
  const double freedom = pairs - 2;
  if (freedom <= 0) return 0;
  // Both tails of t are the upper tail of F = t^2; half of it is the upper one of t.
  const double both = log_f_tail(r * r * freedom / std::max(1 - r * r, kTiny), 1, freedom);
  return r > 0 ? both - std::log(2.0) : std::log1p(-std::exp(both) / 2);
}

}  // namespace vernier::maths
