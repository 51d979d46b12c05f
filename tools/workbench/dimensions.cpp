// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/workbench/dimensions.h"

#include <cmath>

#include "tools/text/units.h"

namespace vernier {
namespace {

constexpr std::array<const char*, 8> kNames = {"mm", "deg", "degC", "s", "V", "N", "kg", "A"};

std::optional<UnitPowers> powers_of(Dimension dimension) {
  switch (dimension) {
    case Dimension::kNone:
      return UnitPowers{};
    case Dimension::kLength:
      return UnitPowers{1};
    case Dimension::kAngle:
      return UnitPowers{0, 1};
    case Dimension::kTemperature:
      return UnitPowers{0, 0, 1};
    case Dimension::kTime:
      return UnitPowers{0, 0, 0, 1};
    case Dimension::kSpeed:
      return UnitPowers{1, 0, 0, -1};
    case Dimension::kAngularSpeed:
      return UnitPowers{0, 1, 0, -1};
    case Dimension::kAcceleration:
      return UnitPowers{1, 0, 0, -2};
    case Dimension::kAngularAcceleration:
      return UnitPowers{0, 1, 0, -2};
    case Dimension::kVoltage:
      return UnitPowers{0, 0, 0, 0, 1};
    case Dimension::kForce:
      return UnitPowers{0, 0, 0, 0, 0, 1};
    case Dimension::kMass:
      return UnitPowers{0, 0, 0, 0, 0, 0, 1};
    case Dimension::kCurvature:
      return UnitPowers{-1};
    case Dimension::kCurrent:
      return UnitPowers{0, 0, 0, 0, 0, 0, 0, 1};
    case Dimension::kFrequency:
      return UnitPowers{0, 0, 0, -1};
    case Dimension::kPressure:
      return UnitPowers{-2, 0, 0, 0, 0, 1};
    case Dimension::kTorque:
      return UnitPowers{1, 0, 0, 0, 0, 1};
    case Dimension::kPower:
      return UnitPowers{1, 0, 0, -1, 0, 1};
    case Dimension::kRatio:
      return UnitPowers{};
  }
  return std::nullopt;
}

using Unit = std::optional<UnitPowers>;

/// Walks an expression from its leaves; nothing goes on as nothing.
class UnitWalk {
 public:
  UnitWalk(const Machine& machine, const std::string& unknown, std::vector<std::string>& warnings)
      : machine_(machine), unknown_(unknown), warnings_(warnings) {}

  Unit of(const Expr& expr) {
    switch (expr.op) {
      case Op::kNumber:
      case Op::kRunIs:
        return UnitPowers{};
      case Op::kSymbol:
        return expr.name == unknown_ ? UnitPowers{} : unit_powers(symbol_unit(machine_, expr.symbol));
      case Op::kNegate:
      case Op::kAbs:
        return of(*expr.args[0]);
      case Op::kMultiply:
        return product(expr, 1);
      case Op::kDivide:
        return product(expr, -1);
      case Op::kPower:
        return power(expr);
      default:
        return function(expr);
    }
  }

 private:
  Unit product(const Expr& expr, int sense) {
    const Unit a = of(*expr.args[0]), b = of(*expr.args[1]);
    if (!a || !b) return std::nullopt;
    UnitPowers result = *a;
    for (std::size_t i = 0; i < result.size(); ++i) result[i] += sense * (*b)[i];
    return result;
  }

  Unit power(const Expr& expr) {
    const Unit base = of(*expr.args[0]);
    pure(*expr.args[1], "an exponent");
    double exponent = 0;
    if (!base) return std::nullopt;
    if (*base == UnitPowers{}) return UnitPowers{};
    if (!is_constant(*expr.args[1], exponent) || exponent != std::round(exponent) || std::abs(exponent) > 20)
      return std::nullopt;
    UnitPowers result = *base;
    for (int& one : result) one *= static_cast<int>(exponent);
    return result;
  }

  Unit alike(const Expr& expr) {
    const Unit a = of(*expr.args[0]), b = of(*expr.args[1]);
    double constant = 0;
    // A number beside a quantity is one of its unit: T - 20.
    if (is_constant(*expr.args[0], constant)) return b;
    if (is_constant(*expr.args[1], constant)) return a;
    if (a && b && *a != *b)
      warnings_.push_back(to_text(*expr.args[0]) + " is in " + unit_text(*a) + ", " + to_text(*expr.args[1]) +
                          " in " + unit_text(*b));
    return a ? a : b;
  }

  Unit function(const Expr& expr) {
    switch (expr.op) {
      case Op::kAdd:
      case Op::kSubtract:
      case Op::kMin:
      case Op::kMax:
        return alike(expr);
      case Op::kEqual:
      case Op::kLess:
      case Op::kGreater:
        alike(expr);
        return UnitPowers{};
      case Op::kAtan2:
        alike(expr);
        return UnitPowers{0, 1};
      case Op::kSin:
      case Op::kCos:
      case Op::kTan:
        angle(*expr.args[0]);
        return UnitPowers{};
      case Op::kSign:
        of(*expr.args[0]);
        return UnitPowers{};
      case Op::kExp:
      case Op::kLog:
        pure(*expr.args[0], std::string("the argument of ") + function_name(expr.op));
        return UnitPowers{};
      case Op::kSqrt:
        return root(of(*expr.args[0]));
      case Op::kLag:
        return lag(expr);
      default:
        return std::nullopt;
    }
  }

  static Unit root(Unit of_square) {
    if (!of_square) return std::nullopt;
    for (int& one : *of_square) {
      if (one % 2 != 0) return std::nullopt;
      one /= 2;
    }
    return of_square;
  }

  Unit lag(const Expr& expr) {
    const Unit tau = of(*expr.args[1]);
    double constant = 0;
    if (tau && !is_constant(*expr.args[1], constant) && *tau != UnitPowers{0, 0, 0, 1})
      warnings_.push_back("the time constant of lag is in " + unit_text(*tau) + ", not in s");
    return of(*expr.args[0]);
  }

  void pure(const Expr& expr, const std::string& what) {
    const Unit unit = of(expr);
    if (unit && *unit != UnitPowers{})
      warnings_.push_back(what + " is in " + unit_text(*unit) + ", not a pure number");
  }

  /// Turns over a period (360*X/p) are pure numbers, an axis' own angle is in deg: both are right.
  void angle(const Expr& expr) {
    const Unit unit = of(expr);
    if (unit && *unit != UnitPowers{} && *unit != UnitPowers{0, 1})
      warnings_.push_back(to_text(expr) + " is in " + unit_text(*unit) + ", not an angle");
  }

  const Machine& machine_;
  const std::string& unknown_;
  std::vector<std::string>& warnings_;
};

}  // namespace

std::optional<UnitPowers> unit_powers(const std::string& unit) {
  const auto found = find_unit(unit);
  return found ? powers_of(found->dimension) : std::nullopt;
}

std::string unit_text(const UnitPowers& powers) {
  std::string above, below;
  for (std::size_t i = 0; i < powers.size(); ++i) {
    if (powers[i] == 0) continue;
    std::string& side = powers[i] > 0 ? above : below;
    side += (side.empty() ? "" : "*") + std::string(kNames[i]);
    if (std::abs(powers[i]) != 1) side += "^" + std::to_string(std::abs(powers[i]));
  }
  if (below.empty()) return above.empty() ? "1" : above;
  return (above.empty() ? "1" : above) + "/" +
         (below.find('*') == std::string::npos ? below : "(" + below + ")");
}

std::optional<UnitPowers> expression_unit(const Machine& machine, const Expr& expr,
                                          const std::string& unknown, std::vector<std::string>& warnings) {
  return UnitWalk(machine, unknown, warnings).of(expr);
}

}  // namespace vernier
