// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/fit/least_squares/statistics.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <numeric>
#include <set>
#include <string_view>

#include "tools/format/columns.h"
#include "tools/format/row_counts.h"
#include "tools/maths/factors.h"
#include "tools/model/chain/prediction.h"

namespace vernier::fit {

namespace {

/// Appends where the machine was in a row, and what it touched.
void add_pose(const model::Measurement& m, std::size_t row, std::vector<double>& key) {
  for (std::size_t i = 0; i < m.states.axis.size(); ++i)
    key.push_back(model::commanded(m, i, static_cast<Eigen::Index>(row)));
  if (!m.thing.empty()) key.push_back(static_cast<double>(m.thing[row]));
}

}  // namespace

std::vector<double> row_conditions(const model::Measurement& m, std::size_t row) {
  const auto at = static_cast<Eigen::Index>(row);
  const model::States& s = m.states;
  std::vector<double> key;
  add_pose(m, row, key);
  key.push_back(static_cast<double>(s.of(s.setup, row)));
  for (const auto* columns : {&s.velocity, &s.acceleration, &s.direction, &s.input})
    for (const model::Column& column : *columns) key.push_back(column[at]);
  // A travel that was computed from the order of the rows is no condition that the operator repeats.
  const std::string_view since = format::entry_of(format::AxisQuantity::kSince).prefix;
  if (std::ranges::any_of(m.recorded, [&](const std::string& name) { return name.starts_with(since); }))
    for (const model::Column& column : s.since) key.push_back(column[at]);
  for (const model::Column& normal : s.normal) key.push_back(normal[at]);
  for (Eigen::Index k = 0; k < 3; ++k) {
    key.push_back(std::isnan(m.centre(k, at)) ? 0 : m.centre(k, at));
    key.push_back(std::isnan(m.nominal_point(k, at)) ? 0 : m.nominal_point(k, at));
  }
  for (Eigen::Index k = 0; m.direction.cols() > 0 && k < 3; ++k)
    key.push_back(std::isnan(m.direction(k, at)) ? 0 : m.direction(k, at));
  if (!m.other_end.empty() && m.other_end[row] != model::kNoRow) add_pose(m, m.other_end[row], key);
  key.push_back(s.feed[at]);
  key.push_back(s.curvature[at]);
  for (const model::CandidateInput& candidate : m.candidates) {
    if (format::names_row_count(candidate.name, candidate.unit)) continue;
    key.push_back(std::isnan(candidate.value[at]) ? model::kLongWay : candidate.value[at]);
  }
  return key;
}

namespace {

/// Fewer pooled degrees of freedom than this give too little information about the noise (its own
/// uncertainty would exceed 30 %).
constexpr std::size_t kLeastRepeatFreedom = 5;

/// Readings at one pose are repeats if the corrections agree to this value, mm or deg. It is below
/// the resolution of any instrument here.
constexpr double kCorrectionStep = 1e-4;

struct RepeatPool {
  double sum = 0, largest = 0;
  std::size_t count = 0;
  void add(double value) {
    sum += value * value;
    largest = std::max(largest, std::abs(value));
    ++count;
  }
  std::optional<double> rms() const {
    if (count == 0) return std::nullopt;
    return std::sqrt(sum / static_cast<double>(count));
  }
};

/// Factor from mm or deg to um or urad.
double report_factor(bool rotations) { return rotations ? maths::kUradPerDeg : maths::kUmPerMm; }

/// Fit readings of lengths or rotations, grouped by what the operator repeats.
std::map<std::pair<std::vector<double>, int>, std::vector<std::size_t>> repeated_readings(
    const model::Measurement& m, bool rotations) {
  std::map<std::pair<std::vector<double>, int>, std::vector<std::size_t>> groups;
  for (std::size_t i = 0; i < m.observations.size(); ++i) {
    const model::Observation& o = m.observations[i];
    // The reading of a thing is 0 in every repeat.
    if (m.check[o.row] != 0 || model::is_rotation(o.kind) != rotations || model::is_of_thing(o.kind))
      continue;
    std::vector<double> key = row_conditions(m, o.row);
    for (const model::Column& correction : m.correction)
      key.push_back(std::round(correction[static_cast<Eigen::Index>(o.row)] / kCorrectionStep));
    groups[{std::move(key), static_cast<int>(o.kind)}].push_back(i);
  }
  return groups;
}

std::optional<RepeatNoise> pooled(double squares, std::size_t freedom) {
  if (freedom < kLeastRepeatFreedom) return std::nullopt;
  return RepeatNoise{std::sqrt(squares / static_cast<double>(freedom)), freedom};
}

}  // namespace

std::optional<RepeatNoise> noise_of_repeats(const model::Measurement& m, bool rotations) {
  double squares = 0;
  std::size_t freedom = 0;
  for (const auto& [key, readings] : repeated_readings(m, rotations)) {
    // A running mean loses fewer digits than sums of squares about the group's first value.
    double mean = 0, count = 0;
    for (const std::size_t i : readings) {
      const double value = m.observations[i].value * report_factor(rotations), step = value - mean;
      mean += step / ++count;
      squares += step * (value - mean);
    }
    freedom += readings.size() - 1;
  }
  return pooled(squares, freedom);
}

std::optional<RepeatNoise> noise_of_repeats_in_set_ups(const model::Measurement& m, bool rotations) {
  if (m.rows() == 0) return std::nullopt;
  model::Measurement as_one = m;
  as_one.states.setup.of.assign(m.states.count, 0);
  as_one.states.setup.names = {"1"};
  // In units of mm or deg; first with the mean of each group removed, so that no digits are lost below.
  std::vector<std::pair<std::vector<double>, std::vector<std::size_t>>> groups;  // values, offset of each
  std::map<std::pair<std::size_t, int>, std::size_t> offset_of;                  // set-up and kind
  std::set<int> kinds;
  std::size_t count = 0;
  for (const auto& [key, readings] : repeated_readings(as_one, rotations)) {
    if (readings.size() < 2) continue;
    auto& [values, offsets] = groups.emplace_back();
    for (const std::size_t i : readings) {
      const std::size_t set_up = m.states.of(m.states.setup, m.observations[i].row);
      values.push_back(m.observations[i].value - m.observations[readings.front()].value);
      offsets.push_back(offset_of.try_emplace({set_up, key.second}, offset_of.size()).first->second);
    }
    kinds.insert(key.second);
    count += readings.size();
  }
  // Means of rows and of set-ups in turn converge to their least-squares values.
  constexpr int kMostRounds = 100;
  constexpr double kSettled = 1e-9;  // mm or deg
  double squares = 0;
  for (int round = 0; round < kMostRounds; ++round) {
    std::vector<double> sum(offset_of.size(), 0), number(offset_of.size(), 0);
    squares = 0;
    for (auto& [values, offsets] : groups) {
      const double mean =
          std::accumulate(values.begin(), values.end(), 0.0) / static_cast<double>(values.size());
      for (std::size_t i = 0; i < values.size(); ++i) {
        values[i] -= mean;
        squares += values[i] * values[i];
        sum[offsets[i]] += values[i];
        ++number[offsets[i]];
      }
    }
    double largest = 0;
    for (auto& [values, offsets] : groups)
      for (std::size_t i = 0; i < values.size(); ++i) {
        const double offset = sum[offsets[i]] / number[offsets[i]];
        largest = std::max(largest, std::abs(offset));
        values[i] -= offset;
      }
    if (largest < kSettled) break;
  }
  const std::size_t estimated = groups.size() + offset_of.size() - kinds.size();
  const double factor = report_factor(rotations);
  return pooled(squares * factor * factor, count > estimated ? count - estimated : 0);
}

namespace {

std::optional<double> noise_of(const model::Measurement& m, bool rotations) {
  if (!has_uncertainty(m)) {
    const std::optional<RepeatNoise> repeats = noise_of_repeats(m, rotations);
    return repeats ? std::optional(repeats->value) : std::nullopt;
  }
  RepeatPool pool;
  for (const model::Observation& o : m.observations)
    if (m.check[o.row] == 0 && model::is_rotation(o.kind) == rotations)
      pool.add(model::uncertainty_of(m, o) * report_factor(rotations));
  return pool.rms();
}

}  // namespace

Eigen::VectorXd residuals(const model::Machine& machine, const model::Measurement& measurement) {
  const Eigen::VectorXd predicted = model::predict(machine, measurement);
  Eigen::VectorXd result(predicted.size());
  for (std::size_t i = 0; i < measurement.observations.size(); ++i) {
    const auto at = static_cast<Eigen::Index>(i);
    result[at] = measurement.observations[i].value - predicted[at];
  }
  return result;
}

RoleStatistics role_statistics(const model::Measurement& m, const Eigen::VectorXd& residual, bool check) {
  RepeatPool lengths, rotations;
  for (std::size_t i = 0; i < m.observations.size(); ++i) {
    const model::Observation& o = m.observations[i];
    if ((m.check[o.row] != 0) != check) continue;
    const double value = residual[static_cast<Eigen::Index>(i)];
    if (model::is_rotation(o.kind))
      rotations.add(value * maths::kUradPerDeg);
    else
      lengths.add(value * maths::kUmPerMm);
  }
  RoleStatistics result;
  result.count = lengths.count + rotations.count;
  result.rms_um = lengths.rms();
  result.rms_urad = rotations.rms();
  if (lengths.count > 0) result.max_um = lengths.largest;
  if (rotations.count > 0) result.max_urad = rotations.largest;
  return result;
}

bool has_uncertainty(const model::Measurement& m) {
  bool any = false;
  for (const model::Observation& o : m.observations) {
    if (m.check[o.row] != 0) continue;
    if (model::uncertainty_of(m, o) <= 0) return false;
    any = true;
  }
  return any;
}

std::optional<double> noise_um(const model::Measurement& m) { return noise_of(m, false); }
std::optional<double> noise_urad(const model::Measurement& m) { return noise_of(m, true); }

NoiseUnit noise_unit(const model::Measurement& m) {
  const bool with_u = has_uncertainty(m);
  RepeatPool lengths, angles;
  for (const model::Observation& o : m.observations)
    if (m.check[o.row] == 0) {
      const bool rotation = model::is_rotation(o.kind);
      const double u = with_u ? model::uncertainty_of(m, o) : 1;
      (rotation ? angles : lengths).add(u * (rotation ? maths::kArcsecPerDeg : maths::kUmPerMm));
    }
  NoiseUnit unit;
  unit.um = lengths.rms().value_or(unit.um);
  unit.arcsec = angles.rms().value_or(unit.arcsec);
  unit.angles_only = angles.rms() && !lengths.rms();
  return unit;
}

Eigen::VectorXd fit_weights(const model::Measurement& m) {
  Eigen::VectorXd weights(static_cast<Eigen::Index>(m.observations.size()));
  for (std::size_t i = 0; i < m.observations.size(); ++i) {
    const std::size_t row = m.observations[i].row;
    const double u = model::uncertainty_of(m, m.observations[i]);
    weights[static_cast<Eigen::Index>(i)] = m.check[row] != 0 ? 0 : u > 0 ? 1 / u : 1;
  }
  return weights;
}

std::vector<std::size_t> fitted_readings(const Eigen::VectorXd& weights) {
  std::vector<std::size_t> fitted;
  for (Eigen::Index i = 0; i < weights.size(); ++i)
    if (weights[i] > 0) fitted.push_back(static_cast<std::size_t>(i));
  return fitted;
}

}  // namespace vernier::fit
