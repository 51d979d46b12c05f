// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/model/chain/linearizer.h"

#include <algorithm>
#include <map>

#include "tools/model/chain/observation_model.h"
#include "tools/model/station_table.h"

namespace vernier::model {
namespace {

using Eigen::Index;

std::vector<std::size_t> row_starts(const Measurement& m) {
  std::vector<std::size_t> start(m.rows() + 1, 0);
  for (const Observation& o : m.observations) ++start[o.row + 1];
  for (std::size_t i = 0; i < m.rows(); ++i) start[i + 1] += start[i];
  return start;
}

}  // namespace

Linearizer::Linearizer(const Machine& machine, const Measurement& measurement, const ParameterSet& parameters)
    : measurement_(measurement), things_(machine, measurement), start_(row_starts(measurement)) {
  const std::size_t statics = machine.statics.size();
  active_.assign(statics + 7 * machine.axes.size(), 0);
  slot_of_key_.assign(active_.size(), -1);
  base_parameter_.resize(machine.base_shifts.size());
  tool_parameter_.resize(machine.tool_shifts.size());
  for (auto* const list : {&base_parameter_, &tool_parameter_})
    for (auto& six : *list) six.fill(-1);
  for (std::size_t i = 0; i < parameters.size(); ++i) {
    const Parameter& p = parameters[i];
    const auto parameter = static_cast<Index>(i);
    if (p.kind == ParameterKind::kBaseShift) {
      base_parameter_[p.item][p.column] = parameter;
    } else if (p.kind == ParameterKind::kToolShift) {
      tool_parameter_[p.item][p.column] = parameter;
    } else if (p.kind != ParameterKind::kStation) {
      const std::size_t key =
          p.kind == ParameterKind::kStatic ? p.item : statics + 6 * machine.axes.size() + p.item;
      if (static_groups_.empty() ||
          static_groups_.back().first_weight[0].first + static_groups_.back().width != parameter)
        static_groups_.push_back({slots_, 0, {{parameter, 1.0}}});
      ++static_groups_.back().width;
      active_[key] = 1;
      slot_of_key_[key] = slots_++;
    } else if (p.station == 0) {
      const std::size_t axis = machine.tables[p.item].axis, key = statics + axis * 6 + p.column;
      if (tables_.empty() || tables_.back().axis != axis)
        tables_.push_back({axis, {slots_, 0, {{parameter, 1.0}}}, {}, {}});
      ++tables_.back().group.width;
      active_[key] = 1;
      slot_of_key_[key] = slots_++;
    }
  }
  std::vector<std::pair<std::size_t, double>> weights;
  for (TableGroup& table : tables_) {
    const StationTable look(*machine.table_of(table.axis));
    const Index first = table.group.first_weight[0].first;
    for (std::size_t row = 0; row < measurement.rows(); ++row) {
      table.start.push_back(table.weights.size());
      look.weights(measurement.states.axis[table.axis][static_cast<Index>(row)], weights);
      std::sort(weights.begin(), weights.end());
      for (const auto& [station, weight] : weights)
        table.weights.emplace_back(first + static_cast<Index>(station) * table.group.width, weight);
    }
    table.start.push_back(table.weights.size());
  }
}

Linearizer::Pass::Pass(const Linearizer& all, const Machine& machine)
    : all_(all),
      machine_(machine),
      chain_(machine, all.measurement_.states, all.active_),
      things_(all.things_, machine, chain_),
      set_ups_(set_ups_of(machine, all.measurement_.states.names(all.measurement_.states.setup))) {
  for (const std::size_t key : chain_.keys()) slot_of_key_.push_back(all.slot_of_key_[key]);
  row_.groups = all.static_groups_;
  for (const TableGroup& table : all.tables_) row_.groups.push_back(table.group);
}

bool Linearizer::Pass::next() {
  while (at_ < all_.measurement_.rows() && all_.start_[at_] == all_.start_[at_ + 1]) ++at_;
  if (at_ >= all_.measurement_.rows()) return false;
  const std::size_t other = all_.measurement_.other_end.empty() ? kNoRow : all_.measurement_.other_end[at_];
  is_joined_ = other != kNoRow && !all_.measurement_.is_between_things(at_);
  if (is_joined_)
    join_other_end(at_, other);
  else
    fill(at_, at_, Eigen::Vector3d::Zero());
  ++at_;
  return true;
}

void Linearizer::Pass::join_other_end(std::size_t row, std::size_t other) {
  // By parameter: the influence of the row's own pose, then that of the other end's pose.
  std::map<Index, Eigen::VectorXd> by_parameter;
  const auto add = [&] {
    for (const ParameterGroup& group : row_.groups)
      for (const auto& [first, weight] : group.first_weight)
        for (Index k = 0; k < group.width; ++k) {
          Eigen::VectorXd& sum = by_parameter[first + k];
          if (sum.size() == 0) sum = Eigen::VectorXd::Zero(row_.predicted.size());
          sum += weight * row_.gradient.row(group.slot + k).transpose();
        }
  };
  fill(row, row, point_at(other));
  add();
  joined_.first_observation = row_.first_observation;
  joined_.predicted = row_.predicted;
  fill(row, other, point_at(row));
  add();
  joined_.groups.clear();
  joined_.gradient.resize(static_cast<Index>(by_parameter.size()), joined_.predicted.size());
  Index slot = 0;
  for (const auto& [parameter, sum] : by_parameter) {
    joined_.gradient.row(slot) = sum.transpose();
    joined_.groups.push_back({slot++, 1, {{parameter, 1.0}}});
  }
}

Eigen::Vector3d Linearizer::Pass::point_at(std::size_t row) const {
  const Frame pose = chain_.pose(row);
  return ObservationModel(all_.measurement_, machine_.gravity, set_up_of(row), pose).point();
}

void Linearizer::Pass::fill(std::size_t row, std::size_t at, const Eigen::Vector3d& other_end) {
  const Measurement& m = all_.measurement_;
  const SetUpOfRow& set_up = set_up_of(at);
  const Frame pose = chain_.pose(at, twists_);
  ObservationModel model(m, machine_.gravity, set_up, pose);
  model.set_other_end(other_end);
  const std::size_t first = all_.start_[row], count = all_.start_[row + 1] - first;
  row_.first_observation = first;
  row_.predicted.setZero(static_cast<Index>(count));
  row_.gradient.setZero(all_.slots_ + 12, static_cast<Index>(count));
  std::array<Twist, 6> base, tool;
  if (set_up.base != nullptr) base = model.base_twists();
  if (set_up.tool != nullptr) tool = model.tool_twists();
  for (std::size_t k = 0; k < count; ++k) {
    const auto o = static_cast<Index>(k);
    const Observation& observation = m.observations[first + k];
    if (row != at && observation.kind != ObservationKind::kDistance)
      continue;  // depends on its own pose only
    Twist g;
    if (all_.things_.cluster_of(observation) == kNoThing) {
      row_.predicted[o] = model.predicted(observation);
      g = model.gradient(observation);
    } else {
      const ThingsAt::Reading reading = things_.read(observation);
      row_.predicted[o] = reading.predicted;
      const bool measured = m.things[m.thing[row]].in_measuring_frame();
      g.point = measured ? reading.by_point : Eigen::Vector3d(model.base_rotation() * reading.by_point);
      if (const std::size_t tip = all_.things_.tip_of(m.thing[row]); tip != kNoThing)
        if (const Index slot = all_.slot_of_key_[tip]; slot >= 0) row_.gradient(slot, o) = reading.by_tip;
    }
    const Twist in_workpiece{model.base_rotation().transpose() * g.point,
                             model.base_rotation().transpose() * g.rotation};
    for (std::size_t s = 0; s < twists_.size(); ++s)
      row_.gradient(slot_of_key_[s], o) +=
          in_workpiece.point.dot(twists_[s].point) + in_workpiece.rotation.dot(twists_[s].rotation);
    if (is_free_of_set_up(m, observation)) continue;
    const auto add = [&](const std::array<Twist, 6>& twists, Index slot) {
      for (std::size_t c = 0; c < 6; ++c)
        row_.gradient(slot + static_cast<Index>(c), o) =
            g.point.dot(twists[c].point) + g.rotation.dot(twists[c].rotation);
    };
    if (set_up.base != nullptr) add(base, all_.slots_);
    if (set_up.tool != nullptr && !is_of_thing(observation.kind)) add(tool, all_.slots_ + 6);
  }
  const std::size_t statics = all_.static_groups_.size();
  for (std::size_t t = 0; t < all_.tables_.size(); ++t) {
    const TableGroup& table = all_.tables_[t];
    row_.groups[statics + t].first_weight.assign(
        table.weights.begin() + static_cast<std::ptrdiff_t>(table.start[at]),
        table.weights.begin() + static_cast<std::ptrdiff_t>(table.start[at + 1]));
  }
  row_.groups.resize(statics + all_.tables_.size());
  add_set_up(all_.base_parameter_, machine_.base_shifts, set_up.base, all_.slots_);
  add_set_up(all_.tool_parameter_, machine_.tool_shifts, set_up.tool, all_.slots_ + 6);
}

void Linearizer::Pass::add_set_up(const std::vector<std::array<Index, 6>>& parameters,
                                  const std::vector<BaseShift>& shifts, const BaseShift* shift, Index slot) {
  if (shift == nullptr) return;
  const Index first = parameters[static_cast<std::size_t>(shift - shifts.data())][0];
  if (first >= 0) row_.groups.push_back({slot, 6, {{first, 1.0}}});
}

}  // namespace vernier::model
