// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/derive/numbers.h"

#include <cmath>
#include <cstdlib>
#include <numbers>
#include <string>

#include "tools/text/numbers.h"

namespace vernier::derive {
namespace {

bool is_close(double value, double constant) { return std::abs(value - constant) <= 1e-11 * constant; }

GiNaC::numeric decimal(double value) {
  std::string text = text::number_text(value);
  long exponent = 0;
  if (const auto e = text.find_first_of("eE"); e != std::string::npos) {
    exponent = std::strtol(text.c_str() + e + 1, nullptr, 10);
    text.resize(e);
  }
  if (const auto point = text.find('.'); point != std::string::npos) {
    exponent -= static_cast<long>(text.size() - point - 1);
    text.erase(point, 1);
  }
  return GiNaC::numeric(text.c_str()) * GiNaC::numeric(10).power(GiNaC::numeric(exponent));
}

/// An angle as quarters * pi/2 + sign * rest.
struct SplitAngle {
  int quarters = 0;  // 0..3
  int sign = 1;
  GiNaC::ex rest;
};

/// The number in an expanded sum.
GiNaC::ex constant_part(const GiNaC::ex& sum) {
  if (!GiNaC::is_a<GiNaC::add>(sum)) return 0;
  for (std::size_t i = 0; i < sum.nops(); ++i)
    if (GiNaC::is_a<GiNaC::numeric>(sum.op(i))) return sum.op(i);
  return 0;
}

/// Returns the sign of the symbol of an expanded angle that is first by name; 1 if it is not a
/// plain factor.
int leading_sign(const GiNaC::ex& angle) {
  std::string first;
  int sign = 1;
  for (GiNaC::const_preorder_iterator it = angle.preorder_begin(); it != angle.preorder_end(); ++it) {
    if (!GiNaC::is_a<GiNaC::symbol>(*it)) continue;
    const std::string name = GiNaC::ex_to<GiNaC::symbol>(*it).get_name();
    if (!first.empty() && name >= first) continue;
    first = name;
    const GiNaC::ex factor = angle.coeff(*it, 1).evalf();
    sign = GiNaC::is_a<GiNaC::numeric>(factor) && factor.info(GiNaC::info_flags::negative) ? -1 : 1;
  }
  return sign;
}

SplitAngle split(const GiNaC::ex& angle_rad) {
  SplitAngle result;
  result.rest = angle_rad.expand();
  // A plain number keeps GiNaC's own tables (sin(pi/6) is 1/2).
  if (GiNaC::is_a<GiNaC::numeric>(result.rest.evalf())) return result;
  const GiNaC::ex turns = result.rest.coeff(GiNaC::Pi, 1) * 2;
  const GiNaC::ex constant = GiNaC::is_a<GiNaC::numeric>(turns) ? turns : constant_part(turns);
  if (constant.info(GiNaC::info_flags::integer)) {
    result.quarters = GiNaC::mod(GiNaC::ex_to<GiNaC::numeric>(constant), 4).to_int();
    result.rest = (result.rest - constant * GiNaC::Pi / 2).expand();
  }
  result.sign = leading_sign(result.rest);
  if (result.sign < 0) result.rest = (-result.rest).expand();
  return result;
}

}  // namespace

GiNaC::ex sine(const GiNaC::ex& angle_rad) {
  const SplitAngle a = split(angle_rad);
  const int sign = a.quarters >= 2 ? -1 : 1;
  if (a.quarters % 2 == 0) return sign * a.sign * GiNaC::sin(a.rest);
  return sign * GiNaC::cos(a.rest);
}

GiNaC::ex cosine(const GiNaC::ex& angle_rad) { return sine(angle_rad + GiNaC::Pi / 2); }

GiNaC::ex exact_number(double value) {
  const double size = std::abs(value);
  const int sign = value < 0 ? -1 : 1;
  if (is_close(size, std::numbers::pi)) return sign * GiNaC::Pi;
  if (is_close(size, 180 / std::numbers::pi)) return sign * 180 / GiNaC::Pi;
  if (is_close(size, std::numbers::pi / 180)) return sign * GiNaC::Pi / 180;
  return decimal(value);
}

GiNaC::ex to_rad(const GiNaC::ex& angle_deg) { return (angle_deg * GiNaC::Pi / 180).expand(); }
GiNaC::ex to_deg(const GiNaC::ex& angle_rad) { return angle_rad * 180 / GiNaC::Pi; }

}  // namespace vernier::derive
