// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/compile/symbolic/ranges.h"

#include <algorithm>
#include <iterator>

#include "tools/model/fit_record.h"

namespace vernier::compile {
namespace {

// Defaults for a machine file without declared ranges. Values beyond are limited and flagged.
constexpr double kLinearSpeed = 1000;          // mm/s
constexpr double kRotarySpeed = 1000;          // deg/s
constexpr double kLinearAcceleration = 10000;  // mm/s^2
constexpr double kRotaryAcceleration = 10000;  // deg/s^2
constexpr double kFeed = 60000;                // mm/min
constexpr double kCurvature = 1;               // 1/mm
constexpr double kTime = 1e6;                  // s
constexpr double kVisits = 1e6;                // rows of a clock: a day at ten per second

double half_width_of(const std::string& unit) {
  if (unit == "degC" || unit == "K") return 50;
  if (unit == "degF") return 90;
  if (unit == "mm" || unit == "V" || unit == "deg") return 10;
  if (unit == "um" || unit == "N" || unit == "mV") return 10000;
  if (unit == "kg") return 1000;
  return 1000;
}

}  // namespace

Interval axis_range(const model::Machine& machine, std::size_t axis) {
  const model::Axis& a = machine.axes[axis];
  if (!a.min || !a.max)
    throw text::InputError({machine.file, a.line}, a.name, "an axis without min and max cannot be compiled");
  return {*a.min, *a.max};
}

Interval input_range(const model::Machine& machine, std::size_t input) {
  const model::Input& one = machine.inputs[input];
  const double width = half_width_of(one.unit);
  Interval range{one.reference - width, one.reference + width};
  constexpr double kBeyond =
      0.1;  // of the measured range: a day that is a little warmer than that of the survey
  if (machine.fitted)
    for (const model::FitRecord::Range& measured : machine.fitted->measured)
      if (measured.name == one.name) {
        const double more = kBeyond * (measured.max - measured.min);
        range = {std::min(range.low, measured.min - more), std::max(range.high, measured.max + more)};
      }
  return {one.min.value_or(range.low), one.max.value_or(range.high)};
}

Interval channel_range(const model::Machine& machine, ChannelKind kind, std::size_t index) {
  const auto symmetric = [&](double linear, double rotary) {
    const double limit = machine.axes[index].rotary ? rotary : linear;
    return Interval{-limit, limit};
  };
  switch (kind) {
    case ChannelKind::kPosition:
      return axis_range(machine, index);
    case ChannelKind::kVelocity:
      return symmetric(kLinearSpeed, kRotarySpeed);
    case ChannelKind::kAcceleration:
      return symmetric(kLinearAcceleration, kRotaryAcceleration);
    case ChannelKind::kSense:
      return {-1, 1};
    case ChannelKind::kSince: {
      const Interval travel = axis_range(machine, index);
      return {0, std::max(1000.0, 10 * (travel.high - travel.low))};
    }
    case ChannelKind::kInput:
      return input_range(machine, index);
    case ChannelKind::kFeed:
      return {0, kFeed};
    case ChannelKind::kCurvature:
      return {0, kCurvature};
    case ChannelKind::kTime:
      return {0, kTime};
    case ChannelKind::kVisit:
      return {0, kVisits};
  }
  return {};
}

Interval table_range(const model::Table& table, std::size_t column, const Interval& positions,
                     const Interval& whole) {
  if (table.interpolation != model::Interpolation::kLinear || table.periodic) return whole;
  const auto beyond = [](double location, const model::Station& s) { return location < s.loc; };
  const auto first = table.stations.begin(), last = std::prev(table.stations.end());
  auto from = std::upper_bound(first, table.stations.end(), positions.low, beyond);
  auto to = std::upper_bound(first, table.stations.end(), positions.high, beyond);
  if (from != first) --from;
  if (from > last) from = last;
  if (to > last) to = last;
  Interval range{from->value[column], from->value[column]};
  for (; from <= to; ++from) range = hull(range, {from->value[column], from->value[column]});
  return range;
}

}  // namespace vernier::compile
