// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/model/chain/work_poses.h"

#include <algorithm>
#include <array>

#include "tools/maths/halton.h"
#include "tools/model/chain/chain.h"

namespace vernier::model {
namespace {

constexpr std::size_t kPoses = 500;  // they give an rms over a volume to 3 %

}  // namespace

WorkPoses poses_over(const Machine& machine, const std::vector<std::array<double, 2>>& ranges) {
  constexpr std::array<std::size_t, 12> kPrimes = {2, 3, 5, 7, 11, 13, 17, 19, 23, 29, 31, 37};
  WorkPoses poses{make_states(kPoses, machine), 0};
  for (std::size_t a = 0; a < machine.axes.size(); ++a) {
    const auto [low, high] = ranges[a];
    Column& q = poses.states.axis[a];
    q[0] = low;
    q[1] = high;
    for (std::size_t i = 2; i < kPoses; ++i)
      q[static_cast<Eigen::Index>(i)] =
          low + (high - low) * maths::radical_inverse(i, kPrimes[a % kPrimes.size()]);
    for (std::size_t i = 0; i < kPoses; ++i)
      poses.states.direction[a][static_cast<Eigen::Index>(i)] = (i >> (a % 8)) % 2 == 0 ? 1 : -1;
  }
  const Eigen::Matrix3Xd points = forward(nominal_machine(machine), poses.states).position;
  poses.extent_mm = std::max(1.0, (points.rowwise().maxCoeff() - points.rowwise().minCoeff()).norm());
  return poses;
}

WorkPoses work_poses(const Machine& machine) {
  std::vector<std::array<double, 2>> ranges;
  for (std::size_t a = 0; a < machine.axes.size(); ++a) {
    auto range = work_range(machine, a);
    if (const Table* table = machine.table_of(a); !range && table != nullptr && table->stations.size() > 1)
      range = std::array{table->stations.front().loc, table->stations.back().loc};
    if (!range)
      throw text::InputError(
          {machine.file, machine.axes[a].line}, machine.axes[a].name,
          "this axis has no range: give min and max of the axis, or enter the axis in <volume>");
    ranges.push_back(*range);
  }
  return poses_over(machine, ranges);
}

}  // namespace vernier::model
