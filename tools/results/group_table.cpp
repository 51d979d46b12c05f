// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/results/group_table.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>

#include "tools/format/columns.h"
#include "tools/maths/chance.h"
#include "tools/maths/factors.h"
#include "tools/text/error.h"
#include "tools/text/words.h"

namespace vernier::results {
namespace {

using nlohmann::ordered_json;

/// Number, sum and sum of squares of readings of one kind, um or urad.
struct Sums {
  double count = 0, sum = 0, squares = 0;
  void take(double value) { count += 1, sum += value, squares += value * value; }
};
using Groups = std::map<std::string, Sums>;

/// Approach direction, axis or input of the machine in every row; `nullptr`: the machine has no such column.
const model::Column* machine_column(const model::Machine& machine, const model::Measurement& m,
                                    const std::string& name) {
  for (std::size_t i = 0; i < machine.axes.size(); ++i) {
    if (name == machine.axes[i].name) return &m.states.axis[i];
    if (name == format::axis_column(format::AxisQuantity::kSense, machine.axes[i].name))
      return &m.states.direction[i];
  }
  const auto input = machine.find_input(name);
  return input ? &m.states.input[*input] : nullptr;
}

std::vector<std::string> known_columns(const model::Machine& machine, const model::Measurement& m) {
  std::vector<std::string> names = {format::columns::kRun};
  for (const model::LabelColumn& label : m.labels) names.push_back(label.name);
  for (const model::CandidateInput& candidate : m.candidates) names.push_back(candidate.name);
  for (const model::Axis& axis : machine.axes) {
    names.push_back(axis.name);
    names.push_back(format::axis_column(format::AxisQuantity::kSense, axis.name));
  }
  for (const model::Input& input : machine.inputs)
    if (!input.hidden_axis) names.push_back(input.name);
  return names;
}

/// The group of every row.
std::vector<std::string> values_of(const model::Machine& machine, const model::Measurement& m,
                                   const std::string& column) {
  for (const model::LabelColumn& label : m.labels)
    if (label.name == column) return label.value;
  std::vector<std::string> values(m.rows());
  if (column == format::columns::kRun) {
    for (std::size_t row = 0; row < m.rows(); ++row) values[row] = m.states.run_names[m.states.run[row]];
    return values;
  }
  if (const model::Column* const number = machine_column(machine, m, column)) {
    for (std::size_t row = 0; row < m.rows(); ++row)
      values[row] = fmt::format("{:g}", (*number)[static_cast<Eigen::Index>(row)]);
    return values;
  }
  for (const model::CandidateInput& candidate : m.candidates) {
    if (candidate.name != column) continue;
    for (std::size_t row = 0; row < m.rows(); ++row) {
      const double value = candidate.value[static_cast<Eigen::Index>(row)];
      if (!std::isnan(value)) values[row] = fmt::format("{:g}", value);
    }
    return values;
  }
  throw text::InputError({}, column,
                         fmt::format("the measurement has no such column for groups; its columns are {}",
                                     text::joined(known_columns(machine, m), ", ")));
}

/// log of the probability that means of groups with the same standard deviation differ so much; 0 without
/// groups to distinguish.
double log_chance(const Groups& groups) {
  double count = 0, sum = 0, squares = 0, between = 0;
  for (const auto& [value, group] : groups) {
    count += group.count, sum += group.sum, squares += group.squares;
    between += group.sum * group.sum / group.count;
  }
  const double d1 = static_cast<double>(groups.size()) - 1, d2 = count - static_cast<double>(groups.size());
  if (d1 < 1 || d2 < 1) return 0;
  const double within = squares - between;
  between -= sum * sum / count;
  if (!(within > 0)) return between > 0 ? -HUGE_VAL : 0;
  return maths::log_f_tail((between / d1) / (within / d2), d1, d2);
}

ordered_json one_column(const model::Machine& machine, const model::Measurement& m,
                        const Eigen::VectorXd& residual, const std::string& column) {
  const std::vector<std::string> values = values_of(machine, m, column);
  std::map<model::ObservationKind, Groups> kinds;
  std::map<std::string, bool> seen;
  for (std::size_t i = 0; i < m.observations.size(); ++i) {
    const model::Observation& o = m.observations[i];
    if (m.check[o.row] != 0) continue;
    const double unit = model::is_rotation(o.kind) ? maths::kUradPerDeg : maths::kUmPerMm;
    kinds[o.kind][values[o.row]].take(unit * residual[static_cast<Eigen::Index>(i)]);
    seen[values[o.row]] = true;
  }
  constexpr std::size_t kMostGroups = 50;  // rows of a table that a person reads
  if (seen.size() > kMostGroups)
    throw text::InputError(
        {}, column,
        fmt::format("the column has {} different values, which are too many groups to distinguish",
                    seen.size()));
  double least = 0;
  for (const auto& [kind, groups] : kinds) least = std::min(least, log_chance(groups));
  ordered_json each = ordered_json::array();
  for (const auto& [value, any] : seen) {
    ordered_json readings = ordered_json::array();
    for (const auto& [kind, groups] : kinds) {
      const auto group = groups.find(value);
      if (group == groups.end()) continue;
      const Sums& sums = group->second;
      readings.push_back({{"reading", format::name_of(kind)},
                          {"unit", format::report_unit_of(kind)},
                          {"n", static_cast<std::size_t>(sums.count)},
                          {"mean", sums.sum / sums.count},
                          {"rms", std::sqrt(sums.squares / sums.count)}});
    }
    each.push_back({{"value", value.empty() ? "(empty)" : value}, {"readings", readings}});
  }
  const double p = std::min(1.0, std::exp(least) * static_cast<double>(kinds.size()));
  return {
      {"column", column}, {"differ_p", least < 0 ? ordered_json(p) : ordered_json(nullptr)}, {"each", each}};
}

}  // namespace

ordered_json group_table(const model::Machine& machine, const model::Measurement& m,
                         const Eigen::VectorXd& residual, const std::vector<std::string>& columns) {
  ordered_json table = ordered_json::array();
  for (const std::string& column : columns) table.push_back(one_column(machine, m, residual, column));
  return table;
}

}  // namespace vernier::results
