// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/kinematics/jacobian.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <numbers>

#include "tools/kinematics/rotations.h"
#include "tools/maths/decompositions.h"
#include "tools/maths/factors.h"

namespace vernier::kinematics {
namespace {

using Eigen::Index;
using Eigen::Matrix3d;
using Eigen::MatrixXd;
using Eigen::Vector3d;
using Eigen::VectorXd;
/// Half the distance of the central differences, mm or deg. Third derivatives of a chain (about
/// lever * rad^3) then cause an error of 1e-12 of the slope, rounding 1e-9.
constexpr double kHalfStep = 2e-4;

Index rows_of(Match match) { return match == Match::kPosition ? 3 : match == Match::kDirection ? 5 : 6; }

/// Two unit vectors across `direction`.
Eigen::Matrix<double, 3, 2> across(const Vector3d& direction) {
  Eigen::Matrix<double, 3, 2> result;
  result.col(0) = direction.unitOrthogonal();
  result.col(1) = direction.cross(result.col(0));
  return result;
}

/// Returns the shortest rotation vector (rad) from one unit vector to another; half a turn if they
/// are opposite.
Vector3d turn_from_to(const Vector3d& from, const Vector3d& to) {
  const Vector3d cross = from.cross(to);
  const double sine = cross.norm(), cosine = from.dot(to);
  if (sine < 1e-300)
    return cosine > 0 ? Vector3d::Zero() : Vector3d(std::numbers::pi * from.unitOrthogonal());
  return cross * (std::atan2(sine, cosine) / sine);
}

VectorXd rows(const Vector3d& length, const Vector3d& rotation, const Matrix3d& at, Match match,
              double lever_mm) {
  VectorXd result(rows_of(match));
  result.head<3>() = length;
  if (match == Match::kDirection)
    result.tail<2>() = lever_mm * (across(at.col(2)).transpose() * rotation);
  else if (match == Match::kPose)
    result.tail<3>() = lever_mm * rotation;
  return result;
}

Eigen::JacobiSVD<MatrixXd> decompose(const MatrixXd& jacobian, const VectorXd& scales) {
  return Eigen::JacobiSVD<MatrixXd>(jacobian * scales.asDiagonal(), Eigen::ComputeThinU);
}

}  // namespace

VectorXd pose_error(const model::Poses& poses, const model::Poses& target, std::size_t i, Match match,
                    double lever_mm) {
  const Vector3d length =
      target.position.col(static_cast<Index>(i)) - poses.position.col(static_cast<Index>(i));
  if (match == Match::kPosition) return length;
  const Matrix3d &at = poses.rotation[i], &to = target.rotation[i];
  const Vector3d turn =
      match == Match::kDirection ? turn_from_to(at.col(2), to.col(2)) : rotation_vector(to * at.transpose());
  return rows(length, turn, at, match, lever_mm);
}

std::vector<MatrixXd> axis_jacobian(const model::Machine& machine, const model::States& states,
                                    const std::vector<std::size_t>& axes, Match match, double lever_mm) {
  std::vector<MatrixXd> result(states.count, MatrixXd(rows_of(match), static_cast<Index>(axes.size())));
  const model::Poses here = match == Match::kDirection ? model::forward(machine, states) : model::Poses{};
  for (std::size_t k = 0; k < axes.size(); ++k) {
    model::States moved = states;
    moved.axis[axes[k]] += kHalfStep;
    const model::Poses after = model::forward(machine, moved);
    moved.axis[axes[k]] = states.axis[axes[k]] - kHalfStep;
    const model::Poses before = model::forward(machine, moved);
    for (std::size_t i = 0; i < states.count; ++i) {
      const auto column = static_cast<Index>(i);
      const Vector3d length = after.position.col(column) - before.position.col(column);
      const Vector3d turn = match == Match::kPosition
                                ? Vector3d::Zero()
                                : rotation_vector(after.rotation[i] * before.rotation[i].transpose());
      const Matrix3d at = match == Match::kDirection ? here.rotation[i] : Matrix3d::Identity();
      result[i].col(static_cast<Index>(k)) = rows(length, turn, at, match, lever_mm) / (2 * kHalfStep);
    }
  }
  return result;
}

VectorXd axis_scales(const model::Machine& machine, const std::vector<std::size_t>& axes, double lever_mm) {
  VectorXd result(static_cast<Index>(axes.size()));
  for (std::size_t k = 0; k < axes.size(); ++k)
    result[static_cast<Index>(k)] = machine.axes[axes[k]].rotary ? maths::kDegPerRad / lever_mm : 1;
  return result;
}

double condition_of(const MatrixXd& jacobian, const model::Machine& machine,
                    const std::vector<std::size_t>& axes, const InverseOptions& options) {
  if (jacobian.cols() < jacobian.rows()) return std::numeric_limits<double>::infinity();
  const auto svd = decompose(jacobian, axis_scales(machine, axes, options.lever_mm));
  const double least = svd.singularValues()[jacobian.rows() - 1];
  return least > 0 ? svd.singularValues()[0] / least : std::numeric_limits<double>::infinity();
}

double reducible(const MatrixXd& jacobian, const model::Machine& machine,
                 const std::vector<std::size_t>& axes, const VectorXd& residual,
                 const InverseOptions& options) {
  const auto svd = decompose(jacobian, axis_scales(machine, axes, options.lever_mm));
  double square = 0;
  for (Index k = 0; k < svd.singularValues().size(); ++k) {
    if (svd.singularValues()[k] * options.most_condition <= svd.singularValues()[0]) continue;
    const double part = svd.matrixU().col(k).dot(residual);
    square += part * part;
  }
  return std::sqrt(square);
}

}  // namespace vernier::kinematics
