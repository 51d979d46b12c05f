// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/derive/symbol_ranges.h"
#include "tools/derive/symbol_book.h"
#include "tools/derive/tidy.h"

#include <fmt/format.h>

#include <cmath>
#include <limits>
#include <numbers>
#include <sstream>

namespace vernier::derive {
namespace {

using GiNaC::ex;
using std::numbers::pi;

compile::Interval widened(const compile::Interval& a) {
  if (!std::isfinite(a.low) || !std::isfinite(a.high)) throw NoRange("a value without bound");
  const double by = 1e-12 * a.magnitude() + std::numeric_limits<double>::min();
  return {a.low - by, a.high + by};
}

std::string text_of(const ex& expr) {
  std::ostringstream out;
  out << expr;
  return out.str();
}

compile::Interval reciprocal(const compile::Interval& a, const ex& expr) {
  if (a.low <= 0 && a.high >= 0) throw NoRange("a divisor may be zero: " + text_of(expr));
  return widened({1 / a.high, 1 / a.low});
}

compile::Interval integer_power(const compile::Interval& base, int n) {
  const double a = std::pow(base.low, n), b = std::pow(base.high, n);
  if (n % 2 == 0 && base.contains(0)) return widened({0, std::max(a, b)});
  return widened({std::min(a, b), std::max(a, b)});
}

compile::Interval power_range(const ex& e, const Ranges& ranges) {
  const compile::Interval base = range_of(e.op(0), ranges);
  if (e.op(1).info(GiNaC::info_flags::integer)) {
    const int n = GiNaC::ex_to<GiNaC::numeric>(e.op(1)).to_int();
    return n >= 0 ? integer_power(base, n) : reciprocal(integer_power(base, -n), e.op(0));
  }
  if (base.low < 0)
    throw NoRange(fmt::format("the operand of a root or a real power may be negative: {}", text_of(e.op(0))));
  const compile::Interval exponent = range_of(e.op(1), ranges);
  if (base.low == 0 && exponent.low < 0) throw NoRange("a divisor may be zero: " + text_of(e.op(0)));
  // Monotonic in each of the two separately, so the extremes are at corners.
  const auto [low, high] =
      std::minmax({std::pow(base.low, exponent.low), std::pow(base.low, exponent.high),
                   std::pow(base.high, exponent.low), std::pow(base.high, exponent.high)});
  return widened({low, high});
}

compile::Interval function_range(const ex& e, const Ranges& ranges) {
  const compile::Interval a = range_of(e.op(0), ranges);
  if (is_call(e, "sin")) return sine_range(a);
  if (is_call(e, "cos")) return cosine_range(a);
  if (is_call(e, "tan")) {
    if (std::floor(a.low / pi + 0.5) != std::floor(a.high / pi + 0.5))
      throw NoRange(text_of(e) + " may be infinite");
    return widened({std::tan(a.low), std::tan(a.high)});
  }
  if (is_call(e, "exp")) return widened({std::exp(a.low), std::exp(a.high)});
  if (is_call(e, "log")) {
    if (a.low <= 0) throw NoRange(text_of(e) + " may be infinite");
    return widened({std::log(a.low), std::log(a.high)});
  }
  if (is_call(e, "atan2")) {
    if (a.low == a.high) {
      const compile::Interval b = range_of(e.op(1), ranges);
      if (b.low == b.high) return widened({std::atan2(a.low, b.low), std::atan2(a.low, b.low)});
    }
    return {-pi, pi};
  }
  throw NoRange(text_of(e) + " has no known range");
}

}  // namespace

compile::Interval cosine_range(const compile::Interval& a) {
  compile::Interval result =
      widened(compile::hull({std::cos(a.low), std::cos(a.low)}, {std::cos(a.high), std::cos(a.high)}));
  const double slack = 1e-9;  // an extreme just outside is included
  if (std::floor((a.high + slack) / (2 * pi)) >= std::ceil((a.low - slack) / (2 * pi))) result.high = 1;
  if (std::floor((a.high + slack) / (2 * pi) - 0.5) >= std::ceil((a.low - slack) / (2 * pi) - 0.5))
    result.low = -1;
  return {std::max(result.low, -1.0), std::min(result.high, 1.0)};
}

compile::Interval sine_range(const compile::Interval& a) {
  return cosine_range({a.low - pi / 2, a.high - pi / 2});
}

compile::Interval range_of(const ex& e, const Ranges& ranges) {
  if (GiNaC::is_a<GiNaC::numeric>(e) || GiNaC::is_a<GiNaC::constant>(e)) {
    const double value = GiNaC::ex_to<GiNaC::numeric>(e.evalf()).to_double();
    return {value, value};
  }
  if (GiNaC::is_a<GiNaC::symbol>(e)) {
    const auto found = ranges.find(e);
    if (found == ranges.end()) throw NoRange(text_of(e) + " has no range");
    return found->second;
  }
  if (GiNaC::is_a<GiNaC::power>(e)) return power_range(e, ranges);
  if (GiNaC::is_a<GiNaC::function>(e)) return function_range(e, ranges);
  const bool sum = GiNaC::is_a<GiNaC::add>(e);
  if (!sum && !GiNaC::is_a<GiNaC::mul>(e)) throw NoRange(text_of(e) + " has no known range");
  compile::Interval result = sum ? compile::Interval{0, 0} : compile::Interval{1, 1};
  for (std::size_t i = 0; i < e.nops(); ++i) {
    const compile::Interval part = range_of(e.op(i), ranges);
    result = widened(sum ? result + part : result * part);
  }
  return result;
}

}  // namespace vernier::derive
