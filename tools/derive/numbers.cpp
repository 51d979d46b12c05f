// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/derive/numbers.h"

#include <cmath>
#include <cstdlib>
#include <numbers>
#include <string>

#include "tools/model/numbers.h"

namespace vernier {
namespace {

bool is_close(double value, double constant) { return std::abs(value - constant) <= 1e-11 * constant; }

GiNaC::numeric decimal(double value) {
  std::string text = number_text(value);
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

}  // namespace

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

}  // namespace vernier
