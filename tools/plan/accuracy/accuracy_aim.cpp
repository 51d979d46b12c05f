// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/plan/accuracy/accuracy_aim.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "tools/fit/coverage/point_readings.h"
#include "tools/fit/coverage/reach.h"
#include "tools/maths/orthonormal.h"
#include "tools/model/chain/chain.h"
#include "tools/model/chain/prediction.h"
#include "tools/plan/offered_poses.h"
#include "tools/tolerance/feature_values.h"

namespace vernier::plan {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;

/// Number of poses at which a volume is evaluated. They are far behind the offered poses in
/// Halton's sequence.
constexpr std::size_t kLookedAt = 150, kFrom = 7919;

model::Machine bare(model::Machine machine) {
  machine.base_shifts.clear();
  machine.tool_shifts.clear();
  return machine;
}

/// Motion of the tool point by the machine's own parameters, in workpiece coordinates.
MatrixXd own_columns_at(const model::Machine& machine, const model::States& states,
                        const model::ParameterSet& all, const std::vector<Index>& own) {
  const model::Machine without = bare(machine);
  const model::ParameterSet parameters(without, {});
  const MatrixXd columns(model::linearise(without, fit::point_readings(states), parameters).jacobian);
  MatrixXd result(columns.rows(), static_cast<Index>(own.size()));
  for (std::size_t j = 0; j < own.size(); ++j)
    for (std::size_t i = 0; i < parameters.size(); ++i)
      if (parameters[i].name == all[static_cast<std::size_t>(own[j])].name)
        result.col(static_cast<Index>(j)) = columns.col(static_cast<Index>(i));
  return result;
}

AimRows rows_of_volume(const Knowledge& knowledge, const AccuracyAim& aim, const std::vector<Index>& own) {
  const model::Machine machine = with_region(aim.tooled.value_or(knowledge.machine), aim.region);
  const model::States states = offered_poses(machine, kLookedAt, kFrom);
  std::vector<model::Machine> tooled = {machine};
  if (!aim.tooled)
    for (const model::Tool& tool : machine.tools) tooled.push_back(model::with_tool(machine, tool.point));
  const double share = std::sqrt(static_cast<double>(kLookedAt * tooled.size()));
  AimRows result;
  result.rows.resize(static_cast<Index>(3 * kLookedAt * tooled.size()), static_cast<Index>(own.size()));
  for (std::size_t t = 0; t < tooled.size(); ++t) {
    MatrixXd columns = own_columns_at(tooled[t], states, knowledge.parameters, own);
    const MatrixXd basis = maths::orthonormal(
        fit::rigid_motions(model::forward(bare(tooled[t]), states).position), 1e-9, nullptr);
    columns -= basis * (basis.transpose() * columns);
    result.rows.middleRows(static_cast<Index>(3 * kLookedAt * t), columns.rows()) = columns / share;
  }
  return result;
}

AimRows rows_of_part(const model::Machine& machine, const Knowledge& knowledge,
                     const tolerance::PlacedPart& part, const std::vector<Index>& own) {
  const tolerance::PartValues values = tolerance::part_values(part, tolerance::PartFrame::kPart, "");
  const MatrixXd columns = values.map * own_columns_at(machine, part.states, knowledge.parameters, own);
  AimRows result{columns, {}};
  for (const tolerance::CharacteristicValue& value : values.values) {
    // The mean square of the vectors of a characteristic, and the mean of all of those.
    const double share = std::sqrt(static_cast<double>(value.group) / static_cast<double>(value.count) /
                                   static_cast<double>(values.values.size()));
    result.rows.middleRows(value.first, value.count) *= share;
    result.pieces.push_back({fmt::format("{} of {}", tolerance::characteristic_name(value.what),
                                         part.features[value.feature].feature.name),
                             value.first, value.count,
                             1 / std::sqrt(static_cast<double>(values.values.size()))});
  }
  return result;
}

}  // namespace

model::Machine with_region(const model::Machine& machine, const std::vector<model::WorkRange>& region) {
  model::Machine result = machine;
  for (const model::WorkRange& range : region) {
    std::erase_if(result.volume, [&](const model::WorkRange& one) { return one.axis == range.axis; });
    result.volume.push_back(range);
  }
  return result;
}

AimRows aim_rows(const Knowledge& knowledge, const AccuracyAim& aim, const std::vector<Index>& own) {
  return aim.part ? rows_of_part(aim.tooled.value_or(knowledge.machine), knowledge, *aim.part, own)
                  : rows_of_volume(knowledge, aim, own);
}

}  // namespace vernier::plan
