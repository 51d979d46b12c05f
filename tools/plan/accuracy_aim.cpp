// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/plan/accuracy_aim.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "tools/fit/reach.h"
#include "tools/maths/orthonormal.h"
#include "tools/model/chain.h"
#include "tools/model/prediction.h"
#include "tools/plan/offered_poses.h"
#include "tools/tolerance/feature_values.h"

namespace vernier {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;

/// Poses that a volume is looked at, far behind those that are offered in Halton's sequence.
constexpr std::size_t kLookedAt = 150, kFrom = 7919;

Machine bare(Machine machine) {
  machine.base_shifts.clear();
  return machine;
}

/// How the machine's own parameters move the tool point in workpiece coordinates.
MatrixXd own_columns_at(const Machine& machine, const States& states, const ParameterSet& all,
                        const std::vector<Index>& own) {
  const Machine without = bare(machine);
  const ParameterSet parameters(without, {});
  const MatrixXd columns(linearise(without, point_readings(states), parameters).jacobian);
  MatrixXd result(columns.rows(), static_cast<Index>(own.size()));
  for (std::size_t j = 0; j < own.size(); ++j)
    for (std::size_t i = 0; i < parameters.size(); ++i)
      if (parameters[i].name == all[static_cast<std::size_t>(own[j])].name)
        result.col(static_cast<Index>(j)) = columns.col(static_cast<Index>(i));
  return result;
}

AimRows rows_of_volume(const Knowledge& knowledge, const AccuracyAim& aim, const std::vector<Index>& own) {
  const Machine machine = with_region(knowledge.machine, aim.region);
  const States states = offered_poses(machine, kLookedAt, kFrom);
  std::vector<Machine> tooled = {machine};
  for (const Tool& tool : machine.tools) tooled.push_back(with_tool(machine, tool.point));
  const double share = std::sqrt(static_cast<double>(kLookedAt * tooled.size()));
  AimRows result;
  result.rows.resize(static_cast<Index>(3 * kLookedAt * tooled.size()), static_cast<Index>(own.size()));
  for (std::size_t t = 0; t < tooled.size(); ++t) {
    MatrixXd columns = own_columns_at(tooled[t], states, knowledge.parameters, own);
    const MatrixXd basis =
        orthonormal(rigid_motions(forward(bare(tooled[t]), states).position), 1e-9, nullptr);
    columns -= basis * (basis.transpose() * columns);
    result.rows.middleRows(static_cast<Index>(3 * kLookedAt * t), columns.rows()) = columns / share;
  }
  return result;
}

AimRows rows_of_part(const Knowledge& knowledge, const PlacedPart& part, const std::vector<Index>& own) {
  const PartValues values = part_values(part, PartFrame::kPart, "");
  const MatrixXd columns =
      values.map * own_columns_at(knowledge.machine, part.states, knowledge.parameters, own);
  AimRows result{columns, {}};
  for (const CharacteristicValue& value : values.values) {
    // The mean square of the vectors that a characteristic is made from, and the mean of all of those.
    const double share = std::sqrt(static_cast<double>(value.group) / static_cast<double>(value.count) /
                                   static_cast<double>(values.values.size()));
    result.rows.middleRows(value.first, value.count) *= share;
    result.pieces.push_back(
        {fmt::format("{} of {}", characteristic_name(value.what), part.features[value.feature].feature.name),
         value.first, value.count, 1 / std::sqrt(static_cast<double>(values.values.size()))});
  }
  return result;
}

}  // namespace

Machine with_region(const Machine& machine, const std::vector<WorkRange>& region) {
  Machine result = machine;
  for (const WorkRange& range : region) {
    std::erase_if(result.volume, [&](const WorkRange& one) { return one.axis == range.axis; });
    result.volume.push_back(range);
  }
  return result;
}

AimRows aim_rows(const Knowledge& knowledge, const AccuracyAim& aim, const std::vector<Index>& own) {
  return aim.part ? rows_of_part(knowledge, *aim.part, own) : rows_of_volume(knowledge, aim, own);
}

}  // namespace vernier
