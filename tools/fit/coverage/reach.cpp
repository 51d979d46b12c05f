// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/fit/coverage/reach.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>

#include "tools/fit/coverage/point_readings.h"
#include "tools/fit/coverage/unmeasured.h"
#include "tools/maths/decompositions.h"
#include "tools/model/chain/chain.h"
#include "tools/model/chain/prediction.h"
#include "tools/model/chain/work_poses.h"
#include "tools/model/fit_record.h"
#include "tools/model/measurement.h"

namespace vernier::fit {
namespace {

/// A file keeps 17 digits. A value that differs by more was changed.
bool changed(double now, double fitted) { return std::abs(now - fitted) > 1e-9 * std::abs(fitted); }

/// Returns the ranges in which a fit measured, else the range of an axis in the file, else its
/// position.
std::vector<std::array<double, 2>> measured_ranges(const model::Machine& machine) {
  std::vector<std::array<double, 2>> ranges;
  for (std::size_t a = 0; a < machine.axes.size(); ++a) {
    std::array<double, 2> range = model::work_range(machine, a).value_or(std::array{0.0, 0.0});
    for (const model::FitRecord::Range& measured : machine.fitted->measured)
      if (measured.name == machine.axes[a].name) range = {measured.min, measured.max};
    ranges.push_back(range);
  }
  return ranges;
}

/// Returns the machine in workpiece coordinates alone. Its scale factors are free if the fit freed
/// them.
model::Machine without_set_up(const model::Machine& machine) {
  model::Machine bare = machine;
  bare.base_shifts.clear();
  bare.tool_shifts.clear();
  if (!machine.fitted) return bare;
  const std::vector<std::string>& names = machine.fitted->parameters;
  for (model::Axis& axis : bare.axes)
    axis.scale_free = std::find(names.begin(), names.end(), "scalefactor." + axis.name) != names.end();
  return bare;
}

/// Extent of the points across an axis, of their largest extent. Below it the points do not determine a
/// rotation about this axis: along a line the micrometres of its errors would.
constexpr double kLine = 1e-3;

/// Rigid motion of points that fits each column best: translation at the origin and rotation, 6 x k. A
/// rotation that the points do not determine is 0.
Eigen::MatrixXd rigid_fit(const Eigen::Matrix3Xd& points, const Eigen::MatrixXd& columns) {
  const Eigen::Vector3d centre = points.rowwise().mean();
  const Eigen::Matrix3Xd around = points.colwise() - centre;
  const double size = std::max(around.norm() / std::sqrt(static_cast<double>(points.cols())), 1e-12);
  const Eigen::MatrixXd motions = rigid_motions(around / size);
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> eigen(motions.transpose() * motions);
  const double least = kLine * kLine * eigen.eigenvalues()[5];
  const Eigen::VectorXd inverse =
      eigen.eigenvalues().unaryExpr([&](double value) { return value > least ? 1 / value : 0.0; });
  Eigen::MatrixXd fitted =
      eigen.eigenvectors() *
      (inverse.asDiagonal() * (eigen.eigenvectors().transpose() * (motions.transpose() * columns)));
  fitted.bottomRows(3) /= size;
  // The translation of the centre becomes that of the origin.
  for (Eigen::Index k = 0; k < fitted.cols(); ++k) {
    const Eigen::Vector3d turn = fitted.col(k).tail<3>();
    fitted.col(k).head<3>() -= turn.cross(centre);
  }
  return fitted;
}

}  // namespace

Reach::Reach(const model::Machine& machine)
    : machine_(without_set_up(machine)), known_(machine.fitted != nullptr) {
  if (!known_) return;
  const model::FitRecord& record = *machine.fitted;
  record_ = record;
  discrepancy_mm_ =
      Eigen::Vector3d(record.discrepancy_mm[0], record.discrepancy_mm[1], record.discrepancy_mm[2]);
  parameters_ = model::ParameterSet(machine_, {});
  std::map<std::string, Eigen::Index> place;
  for (std::size_t i = 0; i < record.parameters.size(); ++i)
    place[record.parameters[i]] = static_cast<Eigen::Index>(i);
  // A parameter that was added later and has no effect yet needs no uncertainty.
  const Eigen::VectorXd values = parameters_.get(machine_),
                        nominal = parameters_.get(model::nominal_machine(machine_));
  factor_ = Eigen::MatrixXd::Zero(values.size(), record.factor.cols());
  open_ = Eigen::MatrixXd::Zero(values.size(), record.open_known ? record.open.cols() : 0);
  open_known_ = record.open_known;
  std::vector<std::pair<Eigen::Index, double>> hand_set;
  for (std::size_t i = 0; i < parameters_.size(); ++i) {
    const auto at = static_cast<Eigen::Index>(i);
    const auto found = place.find(parameters_[i].name);
    if (found != place.end()) factor_.row(at) = record.factor.row(found->second);
    if (found != place.end() && open_.cols() > 0) open_.row(at) = record.open.row(found->second);
    const double moved = values[at] - (found == place.end() ? nominal[at] : record.values[found->second]);
    const bool stale = found == place.end() ? moved != 0 : changed(values[at], record.values[found->second]);
    if (!stale) continue;
    stale_.push_back(parameters_[i].name);
    hand_set.emplace_back(at, moved);
  }
  // A parameter that was set by hand has the size of its change as uncertainty.
  for (Eigen::MatrixXd* all : {&factor_, &open_}) {
    const Eigen::Index known = all->cols();
    all->conservativeResize(Eigen::NoChange, known + static_cast<Eigen::Index>(hand_set.size()));
    all->rightCols(static_cast<Eigen::Index>(hand_set.size())).setZero();
    for (std::size_t k = 0; k < hand_set.size(); ++k)
      (*all)(hand_set[k].first, known + static_cast<Eigen::Index>(k)) = hand_set[k].second;
  }
  if (parameters_.size() == 0) return;
  measured_ = model::poses_over(machine_, measured_ranges(machine)).states;
}

Eigen::MatrixXd Reach::rigid_part(const model::States& like, Eigen::Index row, const Columns& columns) const {
  model::States over = measured_;
  for (std::size_t i = 0; i < machine_.inputs.size(); ++i)
    if (machine_.inputs[i].hidden_axis) over.input[i].setConstant(like.input[i][row]);
  return rigid_fit(model::forward(machine_, over).position, columns(over));
}

Eigen::MatrixXd Reach::moved_at(const model::States& states, const Eigen::MatrixXd& change) const {
  return model::linearise(machine_, point_readings(states), parameters_).jacobian * change;  // 3 N x k
}

Eigen::MatrixXd Reach::without_rigid_part(const model::States& states, const Columns& columns) const {
  Eigen::MatrixXd result = columns(states);
  const Eigen::MatrixXd motions = rigid_motions(model::forward(machine_, states).position);
  std::map<std::vector<double>, Eigen::MatrixXd> rigid;
  for (std::size_t i = 0; i < states.count; ++i) {
    const auto row = static_cast<Eigen::Index>(i);
    std::vector<double> tool;
    for (std::size_t k = 0; k < machine_.inputs.size(); ++k)
      if (machine_.inputs[k].hidden_axis) tool.push_back(states.input[k][row]);
    auto found = rigid.find(tool);
    if (found == rigid.end()) found = rigid.emplace(tool, rigid_part(states, row, columns)).first;
    result.middleRows(3 * row, 3) -= motions.middleRows(3 * row, 3) * found->second;
  }
  return result;
}

Eigen::MatrixXd Reach::moved(const model::States& states, const Eigen::MatrixXd& change) const {
  if (!known_ || parameters_.size() == 0)
    return Eigen::MatrixXd::Zero(3 * static_cast<Eigen::Index>(states.count), change.cols());
  return without_rigid_part(states, [&](const model::States& at) { return moved_at(at, change); });
}

Eigen::MatrixXd Reach::unmeasured(const model::States& states) const {
  if (!known_ || parameters_.size() == 0)
    return Eigen::MatrixXd::Zero(3 * static_cast<Eigen::Index>(states.count), 0);
  return unmeasured_columns(machine_, parameters_, record_, states);
}

Eigen::MatrixXd Reach::moved_unmeasured(const model::States& states) const {
  if (!known_ || parameters_.size() == 0) return unmeasured(states);
  return without_rigid_part(states, [&](const model::States& at) { return unmeasured(at); });
}

std::vector<Eigen::Matrix3d> Reach::covariance(const model::States& states) const {
  std::vector<Eigen::Matrix3d> result(states.count, Eigen::Matrix3d::Zero());
  if (!known_ || parameters_.size() == 0) return result;
  const Eigen::MatrixXd spread = moved(states, factor_), unmeasured = moved_unmeasured(states);
  for (std::size_t i = 0; i < states.count; ++i) {
    const auto rows = spread.middleRows(3 * static_cast<Eigen::Index>(i), 3),
               more = unmeasured.middleRows(3 * static_cast<Eigen::Index>(i), 3);
    result[i] = rows * rows.transpose() + more * more.transpose();
  }
  return result;
}

std::vector<Eigen::Matrix3d> Reach::covariance_of_machine(const model::States& states) const {
  std::vector<Eigen::Matrix3d> result = covariance(states);
  for (Eigen::Matrix3d& one : result) one.diagonal() += discrepancy_mm_.cwiseAbs2();
  return result;
}

Eigen::VectorXd Reach::std_of_machine_um(const model::States& states) const {
  const Eigen::VectorXd model = std_um(states);
  return (model.array().square() + 1e6 * discrepancy_mm_.squaredNorm()).sqrt();
}

Eigen::Matrix3Xd Reach::std_unmeasured_um(const model::States& states) const {
  const Eigen::MatrixXd spread = moved(states, open_), more = moved_unmeasured(states);
  const Eigen::VectorXd both =
      1000 * (spread.rowwise().squaredNorm() + more.rowwise().squaredNorm()).cwiseSqrt();
  return both.reshaped(3, static_cast<Eigen::Index>(states.count));
}

Eigen::VectorXd Reach::std_um(const model::States& states) const {
  Eigen::VectorXd result(static_cast<Eigen::Index>(states.count));
  const auto each = covariance(states);
  for (std::size_t i = 0; i < each.size(); ++i)
    result[static_cast<Eigen::Index>(i)] = 1000 * std::sqrt(each[i].trace());
  return result;
}

}  // namespace vernier::fit
