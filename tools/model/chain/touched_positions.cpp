// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/model/chain/touched_positions.h"

#include <Eigen/Core>
#include <map>

#include "tools/maths/decompositions.h"
#include "tools/maths/factors.h"
#include "tools/model/chain/chain.h"
#include "tools/model/chain/chain_rows.h"
#include "tools/model/chain/things.h"

namespace vernier::model {
namespace {

using Eigen::Index;

/// Indices of the readings of touches, by row.
std::map<std::size_t, std::vector<std::size_t>> touches_of(const Measurement& m) {
  std::map<std::size_t, std::vector<std::size_t>> rows;
  for (std::size_t i = 0; i < m.observations.size(); ++i)
    if (is_of_thing(m.observations[i].kind)) rows[m.observations[i].row].push_back(i);
  return rows;
}

}  // namespace

double extent_of_points(const Machine& machine, const Measurement& m, const std::vector<std::size_t>& rows) {
  if (rows.empty()) return 0;
  const Eigen::Matrix3Xd points = forward(machine, m.states).position(Eigen::all, rows);
  return (points.rowwise().maxCoeff() - points.rowwise().minCoeff()).norm();
}

std::vector<Column> touched_positions(const Machine& machine, const Measurement& m) {
  States states = m.states;
  const auto rows = touches_of(m);
  if (rows.empty()) return states.axis;
  const Things things(machine, m);
  const ThingsAt at(things, machine, ChainRows(machine, m.states));
  std::vector<std::size_t> touched;
  for (const auto& [row, readings] : rows) touched.push_back(row);
  // A deg of a rotary axis counts as much as the mm by which it moves the point.
  const double mm_per_deg = std::max(1.0, extent_of_points(machine, m, touched)) * maths::kRadPerDeg;
  const auto axes = static_cast<Index>(machine.axes.size());
  Eigen::VectorXd unit(axes);  // of each axis, for a move of 1 mm
  for (Index i = 0; i < axes; ++i)
    unit[i] = machine.axes[static_cast<std::size_t>(i)].rotary ? 1 / mm_per_deg : 1;
  constexpr int kSteps = 3;        // of Newton's method
  constexpr double kProbe = 1e-3;  // mm
  for (int step = 0; step < kSteps; ++step) {
    const std::vector<Eigen::Vector3d> points = points_at_things(machine, m, ChainRows(machine, states));
    std::vector<std::vector<Eigen::Vector3d>> moved;
    for (Index i = 0; i < axes; ++i) {
      States probed = states;
      probed.axis[static_cast<std::size_t>(i)] += kProbe * unit[i];
      moved.push_back(points_at_things(machine, m, ChainRows(machine, probed)));
    }
    for (const auto& [row, readings] : rows) {
      Eigen::MatrixXd by_axis(static_cast<Index>(readings.size()), axes);
      Eigen::VectorXd off(by_axis.rows());
      for (Index k = 0; k < by_axis.rows(); ++k) {
        const TouchReading reading =
            at.read_at(m.observations[readings[static_cast<std::size_t>(k)]], points[row]);
        off[k] = -reading.value;
        for (Index i = 0; i < axes; ++i)
          by_axis(k, i) =
              reading.by_point.dot(moved[static_cast<std::size_t>(i)][row] - points[row]) / kProbe;
      }
      const Eigen::VectorXd move = maths::least_norm(by_axis, off).cwiseProduct(unit);
      for (Index i = 0; i < axes; ++i)
        states.axis[static_cast<std::size_t>(i)][static_cast<Index>(row)] += move[i];
    }
  }
  return states.axis;
}

}  // namespace vernier::model
