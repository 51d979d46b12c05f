// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/tolerance/feature_values.h"

#include <algorithm>
#include <cmath>
#include <functional>

#include "tools/fit/coverage/point_readings.h"
#include "tools/fit/coverage/reach.h"
#include "tools/maths/decompositions.h"
#include "tools/text/error.h"

namespace vernier::tolerance {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;

/// Below this share of its length a row is absorbed by the frame.
constexpr double kLeft = 1e-9;

/// Rows that select the deviations along the directions of a feature's points (all three without directions).
MatrixXd along_directions(const PlacedFeature& feature, Index points) {
  const bool every = feature.direction.squaredNorm() == 0 || feature.feature.kind == PartFeatureKind::kPath;
  const auto count = static_cast<Index>(feature.count), first = static_cast<Index>(feature.first);
  MatrixXd rows = MatrixXd::Zero((every ? 3 : 1) * count, 3 * points);
  for (Index i = 0; i < count; ++i) {
    if (every) {
      // Along a path the deviation is zero.
      const Eigen::Vector3d tangent = feature.direction.col(i);
      rows.block<3, 3>(3 * i, 3 * (first + i)) = Eigen::Matrix3d::Identity() - tangent * tangent.transpose();
    } else {
      rows.block<1, 3>(i, 3 * (first + i)) = feature.direction.col(i).transpose();
    }
  }
  return rows;
}

/// Effect of location, tilt and size of a plane or cylinder on the deviations along its normals.
MatrixXd own_columns(const PlacedFeature& feature, const PlacedPart& part) {
  const auto count = static_cast<Index>(feature.count), first = static_cast<Index>(feature.first);
  const bool plane = feature.feature.kind == PartFeatureKind::kPlane;
  const bool flat = !plane && feature.feature.length_mm <= 0;  // a circle
  const Eigen::Vector3d axis = feature.feature.direction;
  const Eigen::Vector3d like = std::abs(axis.x()) < 0.9 ? Eigen::Vector3d::UnitX() : Eigen::Vector3d::UnitY();
  const Eigen::Vector3d u = (like - like.dot(axis) * axis).normalized(), v = axis.cross(u);
  MatrixXd columns(count, plane || flat ? 3 : 5);
  for (Index i = 0; i < count; ++i) {
    const Eigen::Vector3d from = part.point.col(first + i) - feature.feature.at, n = feature.direction.col(i);
    if (plane) {
      columns.row(i) << 1, from.dot(u), from.dot(v);
    } else {
      columns(i, 0) = n.dot(u);
      columns(i, 1) = n.dot(v);
      columns(i, 2) = 1;
      if (!flat) columns(i, 3) = from.dot(axis) * n.dot(u), columns(i, 4) = from.dot(axis) * n.dot(v);
    }
  }
  return columns;
}

class ValueMaker {
 public:
  ValueMaker(const PlacedPart& part, PartFrame frame, const std::string& file)
      : part_(part), file_(file), points_(part.point.cols()) {
    if (frame == PartFrame::kPart) align();
  }

  PartValues make() {
    for (std::size_t f = 0; f < part_.features.size(); ++f) take(f);
    return std::move(result_);
  }

 private:
  /// Rows of the features that are asked for, below one another.
  MatrixXd rows_of(const std::function<bool(const PartFeature&)>& asked) const {
    MatrixXd all(0, 3 * points_);
    for (const PlacedFeature& one : part_.features) {
      if (!asked(one.feature)) continue;
      const MatrixXd block = along_directions(one, points_);
      all.conservativeResize(all.rows() + block.rows(), Eigen::NoChange);
      all.bottomRows(block.rows()) = block;
    }
    return all;
  }

  /// The motion that brings the datums back to their nominal location; the directions that they leave free
  /// apply to all features.
  void align() {
    Eigen::Matrix3Xd centred = part_.point;
    centred.colwise() -= part_.point.rowwise().mean().eval();
    motions_ = fit::rigid_motions(centred);
    // A turn by 1 moves the outermost point by 1: all six of like size.
    motions_.rightCols(3) /= std::max(1.0, centred.colwise().norm().maxCoeff());
    MatrixXd free = MatrixXd::Identity(6, 6);
    back_ = MatrixXd::Zero(6, 3 * points_);
    for (const bool datums : {true, false}) {
      const MatrixXd pick = rows_of([&](const PartFeature& one) { return !datums || one.datum; });
      if (pick.rows() == 0 || free.cols() == 0) continue;
      Eigen::JacobiSVD<MatrixXd> svd(pick * motions_ * free, Eigen::ComputeThinU | Eigen::ComputeFullV);
      svd.setThreshold(1e-6);  // freedoms that a part fixes by a millionth of its size it does not fix
      back_ += free * svd.solve(pick - pick * motions_ * back_);
      free = (free * svd.matrixV().rightCols(free.cols() - svd.rank())).eval();
    }
  }

  void add(std::size_t f, PartCharacteristic what, const MatrixXd& rows, Index group,
           const std::optional<std::array<double, 2>>& limits) {
    MatrixXd map = rows;
    if (back_.size() > 0) map -= rows * motions_ * back_;
    const bool nothing = map.norm() < kLeft * rows.norm();
    if (nothing && !limits) return;
    if (nothing)
      throw text::InputError({file_, part_.features[f].feature.line}, part_.features[f].feature.name,
                             "the position of this feature has no value, because this feature defines the "
                             "origin of the part: mark other features as datum, or use --frame machine");
    result_.values.push_back({f, what, limits, result_.map.rows(), map.rows(), group});
    MatrixXd all(result_.map.rows() + map.rows(), 3 * points_);
    if (result_.map.rows() > 0) all.topRows(result_.map.rows()) = result_.map;
    all.bottomRows(map.rows()) = map;
    result_.map = std::move(all);
  }

  static std::optional<std::array<double, 2>> zone(const std::optional<double>& width_mm) {
    if (!width_mm) return std::nullopt;
    return std::array{0.0, *width_mm};
  }

  void take(std::size_t f) {
    const PlacedFeature& one = part_.features[f];
    const PartFeature& feature = one.feature;
    const MatrixXd along = along_directions(one, points_);
    if (feature.kind == PartFeatureKind::kPoint || feature.kind == PartFeatureKind::kPath) {
      const Index group = along.rows() == static_cast<Index>(one.count) ? 1 : 3;
      add(f, PartCharacteristic::kPosition, along, group, zone(feature.position_mm));
      return;
    }
    const MatrixXd own = own_columns(one, part_);
    const MatrixXd fit = maths::least_norm(own, along);
    const MatrixXd rest = along - own * fit;
    if (feature.kind == PartFeatureKind::kPlane) {
      add(f, PartCharacteristic::kPosition, along, 1, zone(feature.position_mm));
    } else {
      // The axis at both ends, two components each.
      MatrixXd ends(own.cols() > 3 ? 4 : 2, fit.cols());
      ends.topRows(2) = fit.topRows(2);
      if (own.cols() > 3) {
        const double half = feature.length_mm / 2;
        ends.bottomRows(2) = fit.topRows(2) - half * fit.bottomRows(2);
        ends.topRows(2) += half * fit.bottomRows(2);
      }
      add(f, PartCharacteristic::kPosition, ends, 2, zone(feature.position_mm));
      add(f, PartCharacteristic::kSize, 2 * fit.row(2), 1, feature.size_mm);
    }
    add(f, PartCharacteristic::kForm, rest, 1, zone(feature.form_mm));
  }

  const PlacedPart& part_;
  const std::string& file_;
  Index points_;
  MatrixXd motions_, back_;  // 3 N x 6; 6 x 3 N: the motion that deviations are taken for
  PartValues result_;
};

}  // namespace

double CharacteristicValue::of(const Eigen::Ref<const Eigen::VectorXd>& rows) const {
  if (what == PartCharacteristic::kSize) return rows[first];
  const auto own = rows.segment(first, count);
  if (what == PartCharacteristic::kForm) return own.maxCoeff() - own.minCoeff();
  double longest = 0;
  for (Index i = 0; i < count; i += group) longest = std::max(longest, own.segment(i, group).squaredNorm());
  return 2 * std::sqrt(longest);
}

PartValues part_values(const PlacedPart& part, PartFrame frame, const std::string& file) {
  return ValueMaker(part, frame, file).make();
}

}  // namespace vernier::tolerance
