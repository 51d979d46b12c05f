// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/workbench/files/dimensions.h"

#include <fmt/format.h>

#include <cmath>

#include "tools/format/units.h"

namespace vernier::workbench {
namespace {

constexpr std::array<const char*, 8> kNames = {"mm", "deg", "degC", "s", "V", "N", "kg", "A"};

std::optional<UnitPowers> powers_of(format::Dimension dimension) {
  switch (dimension) {
    case format::Dimension::kNone:
      return UnitPowers{};
    case format::Dimension::kLength:
      return UnitPowers{1};
    case format::Dimension::kAngle:
      return UnitPowers{0, 1};
    case format::Dimension::kTemperature:
      return UnitPowers{0, 0, 1};
    case format::Dimension::kTime:
      return UnitPowers{0, 0, 0, 1};
    case format::Dimension::kSpeed:
      return UnitPowers{1, 0, 0, -1};
    case format::Dimension::kAngularSpeed:
      return UnitPowers{0, 1, 0, -1};
    case format::Dimension::kAcceleration:
      return UnitPowers{1, 0, 0, -2};
    case format::Dimension::kAngularAcceleration:
      return UnitPowers{0, 1, 0, -2};
    case format::Dimension::kVoltage:
      return UnitPowers{0, 0, 0, 0, 1};
    case format::Dimension::kForce:
      return UnitPowers{0, 0, 0, 0, 0, 1};
    case format::Dimension::kMass:
      return UnitPowers{0, 0, 0, 0, 0, 0, 1};
    case format::Dimension::kCurvature:
      return UnitPowers{-1};
    case format::Dimension::kCurrent:
      return UnitPowers{0, 0, 0, 0, 0, 0, 0, 1};
    case format::Dimension::kFrequency:
      return UnitPowers{0, 0, 0, -1};
    case format::Dimension::kPressure:
      return UnitPowers{-2, 0, 0, 0, 0, 1};
    case format::Dimension::kTorque:
      return UnitPowers{1, 0, 0, 0, 0, 1};
    case format::Dimension::kPower:
      return UnitPowers{1, 0, 0, -1, 0, 1};
    case format::Dimension::kRatio:
      return UnitPowers{};
  }
  return std::nullopt;
}

using Unit = std::optional<UnitPowers>;

/// Evaluates an expression from its leaves; an unknown unit remains unknown.
class UnitWalk {
 public:
  UnitWalk(const model::Machine& machine, const std::string& unknown, std::vector<std::string>& warnings)
      : machine_(machine), unknown_(unknown), warnings_(warnings) {}

  Unit of(const model::Expr& expr) {
    switch (expr.op) {
      case model::Op::kNumber:
      case model::Op::kRunIs:
        return UnitPowers{};
      case model::Op::kSymbol:
        return expr.name == unknown_ ? UnitPowers{} : unit_powers(model::symbol_unit(machine_, expr.symbol));
      case model::Op::kNegate:
      case model::Op::kAbs:
        return of(*expr.args[0]);
      case model::Op::kMultiply:
        return product(expr, 1);
      case model::Op::kDivide:
        return product(expr, -1);
      case model::Op::kPower:
        return power(expr);
      default:
        return function(expr);
    }
  }

 private:
  Unit product(const model::Expr& expr, int sense) {
    const Unit a = of(*expr.args[0]), b = of(*expr.args[1]);
    if (!a || !b) return std::nullopt;
    UnitPowers result = *a;
    for (std::size_t i = 0; i < result.size(); ++i) result[i] += sense * (*b)[i];
    return result;
  }

  Unit power(const model::Expr& expr) {
    const Unit base = of(*expr.args[0]);
    pure(*expr.args[1], "an exponent");
    double exponent = 0;
    if (!base) return std::nullopt;
    if (*base == UnitPowers{}) return UnitPowers{};
    if (!model::is_constant(*expr.args[1], exponent) || exponent != std::round(exponent) ||
        std::abs(exponent) > 20)
      return std::nullopt;
    UnitPowers result = *base;
    for (int& one : result) one *= static_cast<int>(exponent);
    return result;
  }

  Unit alike(const model::Expr& expr) {
    const Unit a = of(*expr.args[0]), b = of(*expr.args[1]);
    double constant = 0;
    // A number beside a quantity is one of its unit: T - 20.
    if (model::is_constant(*expr.args[0], constant)) return b;
    if (model::is_constant(*expr.args[1], constant)) return a;
    if (a && b && *a != *b)
      warnings_.push_back(model::to_text(*expr.args[0]) + " is in " + unit_text(*a) + ", " +
                          model::to_text(*expr.args[1]) + " in " + unit_text(*b));
    return a ? a : b;
  }

  Unit function(const model::Expr& expr) {
    switch (expr.op) {
      case model::Op::kAdd:
      case model::Op::kSubtract:
      case model::Op::kMin:
      case model::Op::kMax:
        return alike(expr);
      case model::Op::kEqual:
      case model::Op::kLess:
      case model::Op::kGreater:
        alike(expr);
        return UnitPowers{};
      case model::Op::kAtan2:
        alike(expr);
        return UnitPowers{0, 1};
      case model::Op::kSin:
      case model::Op::kCos:
      case model::Op::kTan:
        angle(*expr.args[0]);
        return UnitPowers{};
      case model::Op::kSign:
        of(*expr.args[0]);
        return UnitPowers{};
      case model::Op::kExp:
      case model::Op::kLog:
        pure(*expr.args[0], std::string("the argument of ") + model::function_name(expr.op));
        return UnitPowers{};
      case model::Op::kSqrt:
        return root(of(*expr.args[0]));
      case model::Op::kLag:
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

  Unit lag(const model::Expr& expr) {
    const Unit tau = of(*expr.args[1]);
    double constant = 0;
    if (tau && !model::is_constant(*expr.args[1], constant) && *tau != UnitPowers{0, 0, 0, 1})
      warnings_.push_back(fmt::format("the time constant of lag is in {}, not in s", unit_text(*tau)));
    return of(*expr.args[0]);
  }

  void pure(const model::Expr& expr, const std::string& what) {
    const Unit unit = of(expr);
    if (unit && *unit != UnitPowers{})
      warnings_.push_back(what + " is in " + unit_text(*unit) + ", not a pure number");
  }

  /// Turns over a period (360*X/p) are pure numbers, an axis' own angle is in deg: both are right.
  void angle(const model::Expr& expr) {
    const Unit unit = of(expr);
    if (unit && *unit != UnitPowers{} && *unit != UnitPowers{0, 1})
      warnings_.push_back(model::to_text(expr) + " is in " + unit_text(*unit) + ", not an angle");
  }

  const model::Machine& machine_;
  const std::string& unknown_;
  std::vector<std::string>& warnings_;
};

}  // namespace

std::optional<UnitPowers> unit_powers(const std::string& unit) {
  const auto found = format::find_unit(unit);
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

std::optional<UnitPowers> expression_unit(const model::Machine& machine, const model::Expr& expr,
                                          const std::string& unknown, std::vector<std::string>& warnings) {
  return UnitWalk(machine, unknown, warnings).of(expr);
}

}  // namespace vernier::workbench
