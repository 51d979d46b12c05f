// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/exchange/controller/tables.h"

#include <algorithm>
#include <cmath>
#include <random>

#include "tools/maths/decompositions.h"
#include "tools/model/chain/chain.h"

namespace vernier::exchange {

using Eigen::Index;
using Eigen::Matrix3Xd;

model::States controller_states(const ThreeAxes& axes, const Matrix3Xd& commands, const Matrix3Xd& directions,
                                const model::States& at) {
  model::States states = states_at(axes, commands, at);
  for (std::size_t i = 0; i < 3; ++i)
    states.direction[axes.axis[i]] = directions.row(static_cast<Index>(i)).transpose().array();
  return states;
}

double ControllerTable::at(double position_mm, double direction) const {
  const std::vector<double>& values = direction < 0 ? reverse : forward;
  const double last = static_cast<double>(values.size() - 1);
  const double place = std::clamp((position_mm - from) / step, 0.0, last);
  if (stairs) return values[static_cast<std::size_t>(std::floor(place + 0.5))];
  const auto k = static_cast<std::size_t>(std::min(place, last - 1));
  const double share = place - static_cast<double>(k);
  return (1 - share) * values[k] + share * values[k + 1];
}

const ControllerTable* ControllerTables::find(std::size_t input, std::size_t output) const {
  for (const ControllerTable& table : tables)
    if (table.input == input && table.output == output) return &table;
  return nullptr;
}

Matrix3Xd ControllerTables::corrected(const Matrix3Xd& commands, const Matrix3Xd& directions) const {
  Matrix3Xd result = commands;
  for (Index k = 0; k < commands.cols(); ++k) {
    for (const ControllerTable& table : tables)
      result(static_cast<Index>(table.output), k) += table.at(commands(static_cast<Index>(table.input), k),
                                                              directions(static_cast<Index>(table.input), k));
    for (std::size_t i = 0; i < 3; ++i)
      result(static_cast<Index>(i), k) += reversal[i] / 2 * directions(static_cast<Index>(i), k);
  }
  return result;
}

namespace {

/// The rotation in what the tables correct. Straight lines are fitted: dY/dX and dZ/dX are the direction of
/// the travel of X, dZ/dY the plane of X and Y; the other slopes are squareness and scale.
void add_rotation(ControllerErrors& errors, const Matrix3Xd& points, const Matrix3Xd& corrected) {
  const Eigen::Vector3d middle = points.rowwise().mean();
  const Matrix3Xd from_middle = points.colwise() - middle;
  const Eigen::MatrixXd columns = from_middle.transpose();
  const Eigen::VectorXd y = maths::least_squares(columns, corrected.row(1).transpose()),
                        z = maths::least_squares(columns, corrected.row(2).transpose());
  const Eigen::Vector3d rotation(z[1], -z[0], y[0]);
  constexpr double kUradPerRad = 1e6;
  for (std::size_t i = 0; i < 3; ++i) errors.rotation_urad[i] = kUradPerRad * rotation[static_cast<Index>(i)];
  for (Index k = 0; k < from_middle.cols(); ++k) {
    const Eigen::Vector3d at = from_middle.col(k);
    errors.rotation_um = std::max(errors.rotation_um, 1000 * rotation.cross(at).norm());
  }
}

}  // namespace

ControllerErrors controller_errors(const model::Machine& machine, const ThreeAxes& axes,
                                   const ControllerTables& tables, const model::States& at) {
  constexpr Index kPositions = 4096;
  constexpr unsigned long kPositionsSeed = 1;
  std::mt19937_64 random(kPositionsSeed);
  Matrix3Xd points(3, kPositions), directions(3, kPositions);
  for (std::size_t i = 0; i < 3; ++i) {
    std::uniform_real_distribution<double> position(axes.low[i], axes.high[i]);
    for (Index k = 0; k < kPositions; ++k) {
      points(static_cast<Index>(i), k) = position(random);
      directions(static_cast<Index>(i), k) = random() % 2 == 0 ? 1 : -1;
    }
  }
  const Matrix3Xd nominal =
      model::forward(model::nominal_machine(machine), controller_states(axes, points, directions, at))
          .position;
  const auto error_at = [&](const Matrix3Xd& commands) {
    Matrix3Xd error =
        model::forward(machine, controller_states(axes, commands, directions, at)).position - nominal;
    const Eigen::Vector3d mean = error.rowwise().mean();
    error.colwise() -= mean;
    return error;
  };
  const Matrix3Xd before = error_at(points), after = error_at(tables.corrected(points, directions));
  ControllerErrors errors;
  errors.positions = static_cast<std::size_t>(kPositions);
  for (std::size_t i = 0; i < 3; ++i) {
    const auto row = static_cast<Index>(i);
    errors.before_um[i] = 1000 * before.row(row).cwiseAbs().maxCoeff();
    errors.after_um[i] = 1000 * after.row(row).cwiseAbs().maxCoeff();
    for (Index k = 0; k < kPositions; ++k) {
      double& largest = directions(row, k) > 0 ? errors.after_positive_um[i] : errors.after_negative_um[i];
      largest = std::max(largest, 1000 * std::abs(after(row, k)));
    }
  }
  errors.rms_before_um = rms_um(before);
  errors.rms_after_um = rms_um(after);
  add_rotation(errors, points, before - after);
  return errors;
}

}  // namespace vernier::exchange
