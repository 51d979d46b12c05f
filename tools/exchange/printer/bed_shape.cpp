// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/exchange/printer/bed_shape.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "tools/format/columns.h"
#include "tools/maths/decompositions.h"
#include "tools/model/chain/chain.h"
#include "tools/text/error.h"

namespace vernier::exchange {
namespace {

using Eigen::Index;
using Eigen::Matrix3Xd;
using Eigen::VectorXd;

/// Touches that are closer to each other touch one place of the bed.
constexpr double kOnePlace_mm = 1;

/// Averages of the points that are closer than `distance_mm` to the first of them.
Matrix3Xd merged(const Matrix3Xd& points, double distance_mm) {
  std::vector<Eigen::Vector3d> first, sum;
  std::vector<double> count;
  for (Index i = 0; i < points.cols(); ++i) {
    const Eigen::Vector3d point = points.col(i);
    std::size_t k = 0;
    while (k < first.size() && (first[k] - point).head<2>().norm() > distance_mm) ++k;
    if (k == first.size()) {
      first.push_back(point), sum.push_back(point), count.push_back(1);
    } else {
      sum[k] += point;
      ++count[k];
    }
  }
  Matrix3Xd result(3, static_cast<Index>(sum.size()));
  for (std::size_t k = 0; k < sum.size(); ++k) result.col(static_cast<Index>(k)) = sum[k] / count[k];
  return result;
}

/// r^2 log r by the square of r.
double kernel(double square) { return square > 0 ? square * std::log(square) / 2 : 0; }

double rms_without_mean_um(const VectorXd& mm) {
  return mm.size() == 0 ? 0 : 1000 * std::sqrt((mm.array() - mm.mean()).square().mean());
}

Matrix3Xd points_of(const std::vector<BedTouch>& touches, bool of_nozzle, bool nominal = false) {
  Matrix3Xd points(3, static_cast<Index>(touches.size()));
  Index count = 0;
  for (const BedTouch& touch : touches)
    if (!touch.check && touch.of_nozzle() == of_nozzle)
      points.col(count++) = nominal ? touch.nominal : touch.point;
  return points.leftCols(count);
}

}  // namespace

Surface::Surface(const Matrix3Xd& points) {
  constexpr Index kMost = 2500;  // points of a dense system: some seconds
  Matrix3Xd knots = points;
  for (double distance_mm = kOnePlace_mm; distance_mm == kOnePlace_mm || knots.cols() > kMost;
       distance_mm *= 1.5)
    knots = merged(points, distance_mm);
  const Index n = knots.cols();
  if (n == 0) return;
  plane_[0] = knots.row(2).mean();
  if (n < 4) return;
  middle_ = knots.topRows<2>().rowwise().mean();
  scale_ = (knots.topRows<2>().colwise() - middle_).colwise().norm().maxCoeff();
  knots_ = (knots.topRows<2>().colwise() - middle_) / scale_;
  // Conditions of the thin-plate spline: it passes through the points, and its weights have no plane part.
  Eigen::MatrixXd system = Eigen::MatrixXd::Zero(n + 3, n + 3);
  VectorXd right = VectorXd::Zero(n + 3);
  for (Index i = 0; i < n; ++i) {
    for (Index k = 0; k < n; ++k) system(i, k) = kernel((knots_.col(i) - knots_.col(k)).squaredNorm());
    system.row(i).tail<3>() << 1, knots_(0, i), knots_(1, i);
    system.col(i).tail<3>() << 1, knots_(0, i), knots_(1, i);
    right[i] = knots(2, i);
  }
  const VectorXd solution = maths::solve_square(system, right);
  if (!solution.allFinite()) {  // all points on one line
    knots_.resize(2, 0);
    return;
  }
  weight_ = solution.head(n);
  plane_ = solution.tail<3>();
}

double Surface::at(double x, double y) const {
  const Eigen::Vector2d point = (Eigen::Vector2d(x, y) - middle_) / scale_;
  double z = plane_[0] + plane_[1] * point[0] + plane_[2] * point[1];
  for (Index i = 0; i < knots_.cols(); ++i) z += weight_[i] * kernel((knots_.col(i) - point).squaredNorm());
  return z;
}

BedShape::BedShape(const std::vector<BedTouch>& touches) {
  const Matrix3Xd probe = points_of(touches, false), nozzle = points_of(touches, true);
  by_probe = static_cast<std::size_t>(probe.cols()), by_nozzle = static_cast<std::size_t>(nozzle.cols());
  const Matrix3Xd& points = by_probe > 0 ? probe : nozzle;
  if (points.cols() < 3) throw text::InputError("the fit rows have fewer than three touches of the bed");
  for (std::size_t k = 0; k < 2; ++k) {
    low[k] = points.row(static_cast<Index>(k)).minCoeff();
    high[k] = points.row(static_cast<Index>(k)).maxCoeff();
  }
  surface_ = Surface(points);
  for (const BedTouch& touch : touches)
    if (!touch.check && !touch.of_nozzle()) offset = touch.offset;
  if (by_probe > 0) add_difference(touches);
  judge_repeats(touches);
  judge(touches);
}

double BedShape::height(double x, double y) const {
  double z = surface_.at(x, y);
  const Eigen::Vector2d at = (Eigen::Vector2d(x, y) - middle_).cwiseQuotient(half_);
  for (std::size_t k = 0; k < powers_.size(); ++k)
    z += difference_[static_cast<Index>(k)] * std::pow(at[0], powers_[k][0]) * std::pow(at[1], powers_[k][1]);
  return z;
}

/// Fits the polynomial to nozzle height minus surface. A variable that hardly varied between the touches of
/// the nozzle has no term: the polynomial would extrapolate the noise.
void BedShape::add_difference(const std::vector<BedTouch>& touches) {
  const Matrix3Xd nozzle = points_of(touches, true);
  const Index n = nozzle.cols();
  if (n == 0) return;
  std::array<bool, 2> varied{};
  for (Index k = 0; k < 2; ++k) {
    const double least = nozzle.row(k).minCoeff(), most = nozzle.row(k).maxCoeff();
    constexpr double kShare = 0.2;  // of the range of the touched region
    varied[static_cast<std::size_t>(k)] =
        most - least > kShare * (high[static_cast<std::size_t>(k)] - low[static_cast<std::size_t>(k)]);
    middle_[k] = (least + most) / 2;
    half_[k] = std::max((most - least) / 2, 1.0);
  }
  constexpr std::array<std::array<int, 2>, 6> kPowers = {{{0, 0}, {1, 0}, {0, 1}, {2, 0}, {1, 1}, {0, 2}}};
  const std::size_t most = static_cast<std::size_t>(n) / 2 + 1;
  for (const auto& powers : kPowers)
    if (powers_.size() < most && (powers[0] == 0 || varied[0]) && (powers[1] == 0 || varied[1]))
      powers_.push_back(powers);
  Eigen::MatrixXd columns(n, static_cast<Index>(powers_.size()));
  VectorXd off(n);
  for (Index i = 0; i < n; ++i) {
    const Eigen::Vector2d at = (nozzle.col(i).head<2>() - middle_).cwiseQuotient(half_);
    for (Index k = 0; k < columns.cols(); ++k)
      columns(i, k) = std::pow(at[0], powers_[static_cast<std::size_t>(k)][0]) *
                      std::pow(at[1], powers_[static_cast<std::size_t>(k)][1]);
    off[i] = nozzle(2, i) - surface_.at(nozzle(0, i), nozzle(1, i));
  }
  difference_ = maths::least_norm(columns, off);
}

void BedShape::judge_repeats(const std::vector<BedTouch>& touches) {
  double squares = 0, freedom = 0;
  for (const bool of_nozzle : {false, true}) {
    const Matrix3Xd points = points_of(touches, of_nozzle);
    const Matrix3Xd places = merged(points, kOnePlace_mm);
    for (Index i = 0; i < points.cols(); ++i) {
      Index nearest = 0;
      (places.topRows<2>().colwise() - points.col(i).head<2>()).colwise().squaredNorm().minCoeff(&nearest);
      squares += std::pow(points(2, i) - places(2, nearest), 2);
    }
    freedom += static_cast<double>(points.cols() - places.cols());
  }
  repeat_rms_um = freedom > 0 ? 1000 * std::sqrt(squares / freedom) : 0;
}

void BedShape::judge(const std::vector<BedTouch>& touches) {
  std::vector<double> off;
  for (const BedTouch& touch : touches)
    if (touch.check && touch.of_nozzle())
      off.push_back(touch.point.z() - height(touch.point.x(), touch.point.y()));
  checks = off.size();
  check_rms_um = rms_without_mean_um(Eigen::Map<const VectorXd>(off.data(), static_cast<Index>(off.size())));
  if (by_probe == 0 || by_nozzle > 0) return;
  // Heights of the bed are those at p; heights of a carriage are those of the touch from p, at p + offset.
  const Surface all(points_of(touches, false, true));
  constexpr int kSide = 25;
  double least = 0, most = 0;
  bool any = false;
  for (int i = 0; i < kSide; ++i)
    for (int j = 0; j < kSide; ++j) {
      const double x = low[0] + (high[0] - low[0]) * i / (kSide - 1),
                   y = low[1] + (high[1] - low[1]) * j / (kSide - 1);
      const double u = x + offset[0], v = y + offset[1];
      if (u < low[0] || u > high[0] || v < low[1] || v > high[1]) continue;
      const double change = all.at(u, v) - all.at(x, y);
      least = any ? std::min(least, change) : change;
      most = any ? std::max(most, change) : change;
      any = true;
    }
  undetermined_um = 1000 * (most - least) / 2;
}

std::vector<BedTouch> bed_touches(const model::Machine& machine, const model::Measurement& rows,
                                  const std::string& artefact) {
  const Matrix3Xd points = model::forward(machine, rows.states).position,
                  nominal = model::forward(model::nominal_machine(machine), rows.states).position;
  std::vector<BedTouch> touches;
  for (std::size_t row = 0; row < rows.rows(); ++row) {
    const std::size_t thing = rows.thing_of(row);
    if (thing == model::kNoThing || rows.things[thing].label != artefact) continue;
    BedTouch touch;
    touch.point = points.col(static_cast<Index>(row));
    touch.nominal = nominal.col(static_cast<Index>(row));
    touch.check = rows.check[row] != 0;
    for (std::size_t k = 0; k < format::columns::kProbe.size(); ++k)
      if (const auto input = machine.find_input(format::columns::kProbe[k]))
        touch.offset[k] = rows.states.input[*input][static_cast<Index>(row)];
    touches.push_back(touch);
  }
  return touches;
}

}  // namespace vernier::exchange
