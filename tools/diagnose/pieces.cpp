// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/diagnose/pieces.h"

#include <algorithm>
#include <cmath>
#include <iterator>

namespace vernier::diagnose {
namespace {

bool harmonics(double a, double b, double allowed) {
  if (a <= 0 || b <= 0) return false;
  const double ratio = std::max(a, b) / std::min(a, b);
  return std::round(ratio) > 1 && std::abs(ratio - std::round(ratio)) < allowed * ratio;
}

/// Do two periods beat less than once over a length? Then they are one wave whose amplitude or
/// period changes.
bool unresolved(double a, double b, double length) {
  return a > 0 && b > 0 && length * std::abs(1 / a - 1 / b) < 1;
}

/// A wave with enough periods in the range to be identified.
bool is_plain_wave(const Evidence& evidence, const Pool& pool, std::size_t item) {
  const double period = pool.period_of(item).value_or(0);
  if (period <= 0 || !pool.candidate(item).choice.axis) return false;
  const Evidence::Range range = evidence.range_of(*pool.candidate(item).choice.axis);
  return range.high - range.low >= evidence.thresholds().shape.periods_of_a_wave * period;
}

/// Returns the largest group of functions, as seen from each of them. `alike` decides which belong
/// together.
template <class Counts, class Alike>
std::vector<std::size_t> largest_group(const Evidence& evidence, const Pool& pool,
                                       const std::vector<std::size_t>& items, const Counts& counts,
                                       const Alike& alike) {
  std::vector<std::size_t> most;
  for (const std::size_t first : items) {
    if (!counts(first)) continue;
    std::vector<std::size_t> group;
    for (const std::size_t item : items) {
      if (!counts(item) || !alike(first, item)) continue;
      const bool harmonic = std::any_of(group.begin(), group.end(), [&](std::size_t other) {
        return harmonics(pool.period_of(item).value_or(0), pool.period_of(other).value_or(0),
                         evidence.thresholds().shape.harmonic);
      });
      if (!harmonic) group.push_back(item);
    }
    if (group.size() > most.size()) most = group;
  }
  return most;
}

/// Two periods of one axis that the measured range does not resolve, at locations that move the
/// readings alike.
std::vector<std::size_t> unresolved_periods(const Evidence& evidence, const Pool& pool,
                                            const std::vector<std::size_t>& items) {
  for (const std::size_t a : items)
    for (const std::size_t b : items) {
      if (a >= b) continue;
      const effects::Candidate &x = pool.candidate(a), &y = pool.candidate(b);
      if (!pool.is_function_of_an_axis(a) || !pool.is_function_of_an_axis(b)) continue;
      if (x.choice.axis != y.choice.axis || !moves_alike(evidence, *x.choice.place, *y.choice.place))
        continue;
      const Evidence::Range range = evidence.range_of(*x.choice.axis);
      if (unresolved(pool.period_of(a).value_or(0), pool.period_of(b).value_or(0), range.high - range.low))
        return {a, b};
    }
  return {};
}

bool has_one_reading_a_row(const Evidence& evidence) {
  const std::vector<model::Observation>& all = evidence.measurement().observations;
  return std::all_of(all.begin(), all.end(),
                     [&](const model::Observation& o) { return o.kind == all.front().kind; });
}

/// Position, or a quantity that follows from it along a path at a steady feed.
bool follows_from_position(const Evidence& evidence, const effects::Candidate& candidate) {
  const auto drivers = drivers_of(evidence.machine(), candidate);
  return std::all_of(drivers.begin(), drivers.end(), [](const auto& driver) {
    return driver.first == static_cast<int>(model::SymbolKind::kAcceleration) ||
           driver.first == static_cast<int>(model::SymbolKind::kVelocity) ||
           driver.first == static_cast<int>(model::SymbolKind::kFeed) ||
           driver.first == static_cast<int>(model::SymbolKind::kCurvature);
  });
}

bool depends_on_time(const Evidence& evidence, const effects::Candidate& candidate) {
  const auto drivers = drivers_of(evidence.machine(), candidate);
  return std::any_of(drivers.begin(), drivers.end(), [](const auto& driver) {
    return driver.first == static_cast<int>(model::SymbolKind::kTime);
  });
}

bool depends_on_temperature(const Evidence& evidence, const effects::Candidate& candidate) {
  return std::any_of(candidate.choice.inputs.begin(), candidate.choice.inputs.end(),
                     [&](const std::string& name) {
                       const auto input = evidence.machine().find_input(name);
                       return input && effects::class_of_input(evidence.machine().inputs[*input]) ==
                                           effects::InputClass::kTemperature;
                     });
}

}  // namespace

std::vector<std::size_t> pieces_of_unrecorded_heat(const Evidence& evidence, const Pool& pool,
                                                   const std::vector<std::size_t>& items) {
  for (const std::size_t a : items)
    for (const std::size_t b : items) {
      const effects::Candidate &x = pool.candidate(a), &y = pool.candidate(b);
      const bool slow = depends_on_temperature(evidence, x) || !x.choice.runs.empty();
      if (!slow || !x.choice.place || !y.choice.place || depends_on_temperature(evidence, y) ||
          !depends_on_time(evidence, y))
        continue;
      if (moves_alike(evidence, *x.choice.place, *y.choice.place)) return {a, b};
    }
  return {};
}

std::vector<std::size_t> pieces_of_one_function(const Evidence& evidence, const Pool& pool,
                                                const std::vector<std::size_t>& items) {
  const ShapeThresholds& thresholds = evidence.thresholds().shape;
  const auto choice = [&](std::size_t item) -> const effects::Choice& { return pool.candidate(item).choice; };
  const auto waves = static_cast<std::size_t>(std::count_if(
      items.begin(), items.end(), [&](std::size_t item) { return is_plain_wave(evidence, pool, item); }));
  // Waves beside a curve of the same axis are the part of one function that a table cannot follow,
  // a chirp.
  const auto beside_a_curve = [&](std::size_t wave) {
    return std::any_of(items.begin(), items.end(), [&](std::size_t item) {
      return choice(item).axis == choice(wave).axis && pool.period_of(item).value_or(0) <= 0 &&
             static_cast<double>(pool[item].columns.cols()) >= kCoefficientsOfCurve;
    });
  };
  const auto is_cause = [&](std::size_t item) {
    return waves <= thresholds.most_waves && is_plain_wave(evidence, pool, item) && !beside_a_curve(item);
  };
  std::vector<std::size_t> group = largest_group(
      evidence, pool, items,
      [&](std::size_t item) { return pool.is_function_of_an_axis(item) && !is_cause(item); },
      [&](std::size_t a, std::size_t b) {
        return choice(a).axis == choice(b).axis && moves_alike(evidence, *choice(a).place, *choice(b).place);
      });
  if (group.size() > thresholds.most_of_one_axis) return group;
  if (const auto pair = unresolved_periods(evidence, pool, items); !pair.empty()) return pair;
  if (!has_one_reading_a_row(evidence)) return {};
  group = largest_group(
      evidence, pool, items,
      [&](std::size_t item) {
        return follows_from_position(evidence, pool.candidate(item)) && !is_cause(item);
      },
      [](std::size_t, std::size_t) { return true; });
  std::vector<std::size_t> curves;
  std::copy_if(group.begin(), group.end(), std::back_inserter(curves), [&](std::size_t item) {
    return static_cast<double>(pool[item].columns.cols()) >= kCoefficientsOfCurve;
  });
  if (group.size() > (curves.empty() ? thresholds.most_of_one_reading : thresholds.most_beside_a_curve))
    return group;
  if (curves.size() > 1) return curves;
  return {};
}

}  // namespace vernier::diagnose
