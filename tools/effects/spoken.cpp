// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/effects/spoken.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <string_view>

#include "tools/maths/factors.h"

namespace vernier::effects {
namespace {

/// A unit of the machine file and the corresponding unit of the shop.
struct ShopUnit {
  const char *unit, *said;
  double factor;
};
constexpr double kUmPerMm = 1000, kMsPerS = 1000, kMmPerM = 1000, kUmPerM = 1e6;
constexpr std::array<ShopUnit, 13> kShopUnits = {{
    {"mm", "um", kUmPerMm},
    {"deg", "arcsec", maths::kArcsecPerDeg},
    {"s", "ms", kMsPerS},
    {"", "um/m", kUmPerM},
    {"deg/mm", "arcsec/m", maths::kArcsecPerDeg* kMmPerM},
    {"mm/degC", "um/degC", kUmPerMm},
    {"deg/degC", "arcsec/degC", maths::kArcsecPerDeg},
    {"1/degC", "um/(m degC)", kUmPerM},
    {"mm/degC/mm", "um/(m degC)", kUmPerM},
    {"mm/s", "um/s", kUmPerMm},
    {"mm/N", "um/N", kUmPerMm},
    {"mm/kg", "um/kg", kUmPerMm},
    {"1", "ppm", kUmPerM},
}};

/// Returns value and uncertainty. Both end at the last significant digit of the uncertainty: it
/// has one digit, two if it begins with 1 (GUM 7.2.6).
std::string with_std(double value, double std) {
  if (!(std > 0) || !std::isfinite(std)) return fmt::format("{:.3g}", value);
  const double power = std::floor(std::log10(std));
  const int digits = static_cast<int>(std / std::pow(10, power) < 2 ? 1 - power : -power);
  const double step = std::pow(10, -digits);
  const double rounded = std::round(value / step) * step,
               spread = std::max(step, std::round(std / step) * step);
  return fmt::format("{:.{}f} +- {:.{}f}", rounded, std::max(0, digits), spread, std::max(0, digits));
}

std::string sized(double value, double std, const std::string& unit) {
  const auto shop = std::find_if(kShopUnits.begin(), kShopUnits.end(),
                                 [&](const ShopUnit& one) { return unit == one.unit; });
  if (shop == kShopUnits.end()) return with_std(value, std) + (unit.empty() || unit == "1" ? "" : " " + unit);
  return with_std(value * shop->factor, std * shop->factor) + " " + shop->said;
}

bool turns(const model::Machine& machine, const AxisPlaces& axes, std::size_t axis) {
  const auto& own = axes.own(axis);
  return own ? is_angle(machine, *own) : machine.axes[axis].rotary;
}

/// Returns the degree of freedom of its part that an effect has: " along Y", " about Z", " in a".
/// Empty for the motion's own degree of freedom.
std::string direction(const model::Machine& machine, const AxisPlaces& axes, const DofPlace& place) {
  const auto axis = axes.axis_of(place);
  if (axis && axes.is_own(*axis, place)) return {};
  const std::string_view name = dof_name(machine, place);
  if (transform_at(machine, place).kind != model::TransformKind::kSixDof) return fmt::format(" in {}", name);
  return name.front() == 'r' ? fmt::format(" about {}", name.substr(1)) : fmt::format(" along {}", name);
}

const SpokenValue* find_value(const std::vector<SpokenValue>& values, const std::string& name) {
  const auto found =
      std::find_if(values.begin(), values.end(), [&](const SpokenValue& one) { return one.name == name; });
  return found == values.end() ? nullptr : &*found;
}

const CandidateUnknown* by_rule(const Candidate& candidate, const std::string& rule) {
  const auto found = std::find_if(candidate.unknowns.begin(), candidate.unknowns.end(),
                                  [&](const CandidateUnknown& one) { return one.rule == rule; });
  return found == candidate.unknowns.end() ? nullptr : &*found;
}

}  // namespace

std::string part_name(const model::Machine& machine, const AxisPlaces& axes, const DofPlace& place) {
  if (const auto axis = axes.axis_of(place)) {
    const std::string& name = machine.axes[*axis].name;
    if (transform_at(machine, place).kind != model::TransformKind::kSixDof) return "joint " + name;
    if (turns(machine, axes, *axis)) return name + (place.workpiece ? " table" : " head");
    return name + (place.workpiece ? " table" : " carriage");
  }
  if (place.workpiece) return "workpiece";
  for (std::size_t axis = 0; axis < machine.axes.size(); ++axis)
    if (const auto& own = axes.own(axis); own && !own->workpiece && own->transform > place.transform)
      return "frame";
  return "tool";
}

std::string spoken_name(const model::Machine& machine, const AxisPlaces& axes, const Candidate& candidate) {
  const Choice& choice = candidate.choice;
  std::string what = choice.effect->short_name;
  if (what.empty()) {
    what = choice.effect->id;
    std::replace(what.begin(), what.end(), '-', ' ');
  }
  std::string with;
  for (std::size_t i = 0; i < choice.inputs.size(); ++i)
    with += (i == 0 ? ", by " : choice.effect->has_found_terms() ? " and " : " - ") + choice.inputs[i];
  if (choice.axis && choice.axis2)
    return fmt::format("{} and {}: {}{}", machine.axes[*choice.axis].name, machine.axes[*choice.axis2].name,
                       what, with);
  if (choice.form->place == PlaceRule::kPoint)
    return fmt::format("{}: {} of the point", part_name(machine, axes, *choice.place), what);
  if (choice.effect->has_found_terms())
    return fmt::format("{}: {}{}", part_name(machine, axes, *choice.place), what, with);
  if (candidate.terms.size() != 1) return what + with;
  const DofPlace& place = candidate.terms.front().place;
  // If another axis than that of the part drives the effect, the name states that axis: the sag of
  // X by Y.
  if (choice.axis && axes.axis_of(place) != choice.axis && with.empty())
    with = ", by " + machine.axes[*choice.axis].name;
  return fmt::format("{}: {}{}{}", part_name(machine, axes, place), what, direction(machine, axes, place),
                     with);
}

std::string spoken_with_size(const Candidate& candidate, const std::vector<SpokenValue>& values) {
  std::string text = candidate.spoken;
  const auto& size = candidate.choice.effect->size;
  if (!size) return text;
  double squares = 0, variance = 0, plain = 0;
  std::string unit;
  for (const std::string& rule : size->unknowns) {
    const CandidateUnknown* const unknown = by_rule(candidate, rule);
    const SpokenValue* const value = unknown == nullptr ? nullptr : find_value(values, unknown->name);
    if (value == nullptr) return text;
    plain = value->value;
    squares += value->value * value->value;
    variance += value->value * value->value * value->std * value->std;
    unit = unknown->unit;
  }
  const bool one = size->unknowns.size() == 1;
  const double amount = one ? plain : std::sqrt(squares);
  const double std = amount == 0 ? 0 : std::sqrt(variance) / std::abs(amount);
  const bool of_workpiece = std::ranges::all_of(candidate.terms, [](const CandidateTerm& term) {
    constexpr std::size_t kLengths = 3;  // X, Y, Z come before the rotations
    return term.place.workpiece && term.place.dof < kLengths;
  });
  const double factor = one && of_workpiece ? -size->factor : size->factor;
  if (!size->name.empty()) text += ", " + size->name;
  text += " " + sized(factor * amount, std::abs(factor) * std, unit);
  // A second coefficient `s` is the change of the effect along its axis.
  const CandidateUnknown* const slope = by_rule(candidate, "s");
  if (const SpokenValue* const value = slope == nullptr ? nullptr : find_value(values, slope->name))
    text += fmt::format(" at position 0, and {} along the axis",
                        sized(factor * value->value, std::abs(factor) * value->std, slope->unit));
  for (const CandidateUnknown& unknown : candidate.unknowns)
    if (unknown.kind == UnknownKind::kPeriod)
      if (const SpokenValue* const value = find_value(values, unknown.name))
        text += fmt::format(", period {} {}", with_std(value->value, value->std), unknown.unit);
  // exp(-since/L) is a tenth after the travel L times ln 10; a ramp (rule W) has an end.
  for (const CandidateUnknown& unknown : candidate.unknowns)
    if (unknown.kind == UnknownKind::kTravel)
      if (const SpokenValue* const value = find_value(values, unknown.name)) {
        const bool ramp = unknown.rule == "W";
        const double part = ramp ? 1 : std::numbers::ln10;
        text += fmt::format(", {} after a travel of {} {}", ramp ? "complete" : "90 %",
                            with_std(part * value->value, part * value->std), unknown.unit);
      }
  return text;
}

}  // namespace vernier::effects
