// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/evaluate/robot.h"

#include <fmt/format.h>

#include <Eigen/Eigenvalues>
#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <random>
#include <tuple>

#include "tools/maths/alignment.h"
#include "tools/maths/chance.h"
#include "tools/maths/factors.h"
#include "tools/text/error.h"

namespace vernier::evaluate {
namespace {

using Eigen::Matrix3d, Eigen::Vector3d;

Eigen::Quaterniond rotation(const Vector3d& vector_deg) {
  const Vector3d v = vector_deg * maths::kRadPerDeg;
  const double angle = v.norm();
  return angle > 0 ? Eigen::Quaterniond(Eigen::AngleAxisd(angle, v / angle)) : Eigen::Quaterniond::Identity();
}

/// Rotation vector from one orientation to another, deg.
Vector3d turn(const Vector3d& from_deg, const Vector3d& to_deg) {
  const Eigen::AngleAxisd way(rotation(to_deg) * rotation(from_deg).conjugate());
  const double angle = way.angle() > M_PI ? way.angle() - 2 * M_PI : way.angle();
  return maths::kDegPerRad * angle * way.axis();
}

/// Degrees of freedom of a chi square whose root varies as RP_l of n readings does: 1 / (2 relative
/// variance), the variance of mean + 3 S by the delta method over distances of normal scatter with these
/// variances.
double freedom_of(const Vector3d& variances, double n) {
  // The constant is a property of the ratio of the variances: 20000 draws give it to 2 %.
  constexpr unsigned kSeed = 9283;
  constexpr std::size_t kDraws = 20000;
  std::mt19937 random(kSeed);
  std::normal_distribution<double> normal(0, 1);
  std::vector<double> distance(kDraws);
  double sum = 0, squares = 0;
  for (double& l : distance) {
    double square = 0;
    for (int k = 0; k < 3; ++k) square += std::max(variances[k], 0.0) * std::pow(normal(random), 2);
    l = std::sqrt(square);
    sum += l, squares += square;
  }
  const double mean = sum / kDraws, spread = std::sqrt(std::max(squares / kDraws - mean * mean, 0.0));
  if (!(spread > 0)) return n - 1;
  double variance = 0;
  for (const double l : distance)
    variance += std::pow(l - mean + 3 * (std::pow(l - mean, 2) - spread * spread) / (2 * spread), 2) / kDraws;
  // One degree in n went into the barycentre.
  return (n - 1) * std::pow(mean + 3 * spread, 2) / (2 * variance);
}

void take_rotations(const std::vector<const PoseReading*>& readings, PoseResult& result) {
  if (!std::all_of(readings.begin(), readings.end(),
                   [](const PoseReading* r) { return r->measured_deg.has_value(); }))
    return;
  const Vector3d reference = readings.front()->commanded_deg.value_or(*readings.front()->measured_deg);
  Vector3d mean = Vector3d::Zero(), squares = Vector3d::Zero();
  for (const PoseReading* reading : readings) mean += turn(reference, *reading->measured_deg);
  mean /= static_cast<double>(readings.size());
  for (const PoseReading* reading : readings)
    squares += (turn(reference, *reading->measured_deg) - mean).cwiseAbs2();
  if (readings.front()->commanded_deg) result.accuracy_deg = mean;
  result.repeatability_deg = 3 * (squares / static_cast<double>(readings.size() - 1)).cwiseSqrt();
}

void take_interval(const std::vector<Vector3d>& rest, PoseResult& result) {
  const auto n = static_cast<double>(rest.size());
  Matrix3d covariance = Matrix3d::Zero();
  for (const Vector3d& d : rest) covariance += d * d.transpose() / (n - 1);
  const Vector3d variances = Eigen::SelfAdjointEigenSolver<Matrix3d>(covariance).eigenvalues();
  result.freedom = freedom_of(variances, n);
  // Readings lie nearer to their own barycentre than to the true one.
  const double centre = result.repeatability_mm * std::sqrt(n / (n - 1));
  std::tie(result.low_mm, result.high_mm) = spread_interval(centre, result.freedom);
  const double length = result.accuracy_mm;
  const Vector3d along = length > 0 ? Vector3d(result.deviation_mm / length) : Vector3d::UnitX();
  result.scatter_std_mm = std::sqrt(along.dot(covariance * along) / n);
}

PoseResult pose_of(const std::vector<const PoseReading*>& readings) {
  PoseResult result;
  result.commanded_mm = readings.front()->commanded_mm;
  result.count = readings.size();
  const auto n = static_cast<double>(result.count);
  Vector3d barycentre = Vector3d::Zero();
  for (const PoseReading* reading : readings) barycentre += reading->measured_mm / n;
  result.deviation_mm = barycentre - result.commanded_mm;
  result.accuracy_mm = result.deviation_mm.norm();
  std::vector<Vector3d> rest;
  double u = 0, squares = 0;
  for (const PoseReading* reading : readings) {
    rest.emplace_back(reading->measured_mm - barycentre);
    result.mean_distance_mm += rest.back().norm() / n;
    u = std::max(u, reading->u_mm);
  }
  for (const Vector3d& d : rest) squares += std::pow(d.norm() - result.mean_distance_mm, 2);
  result.distance_spread_mm = std::sqrt(squares / (n - 1));
  result.repeatability_mm = result.mean_distance_mm + 3 * result.distance_spread_mm;
  take_interval(rest, result);
  // An error of the instrument is the same in every visit: no mean removes it.
  result.accuracy_std_mm = std::hypot(result.scatter_std_mm, u);
  take_rotations(readings, result);
  return result;
}

using Key = std::array<long long, 6>;

Key key_of(const PoseReading& reading) {
  Key key{};
  for (int k = 0; k < 3; ++k) {
    key[static_cast<std::size_t>(k)] = std::llround(reading.commanded_mm[k] * 1e6);
    if (reading.commanded_deg)
      key[static_cast<std::size_t>(k) + 3] =
          std::llround((*reading.commanded_deg)[k] * maths::kRadPerDeg * 1e9);
  }
  return key;
}

}  // namespace

std::pair<double, double> spread_interval(double spread, double freedom) {
  constexpr double kTail = 0.025;  // on either side of 95 %
  return {spread * std::sqrt(freedom / maths::chi_square_point(kTail, freedom)),
          spread * std::sqrt(freedom / maths::chi_square_point(1 - kTail, freedom))};
}

std::vector<std::vector<const PoseReading*>> visits_by_pose(const std::vector<PoseReading>& readings) {
  std::map<Key, std::size_t> place;
  std::vector<std::vector<const PoseReading*>> poses;
  for (const PoseReading& reading : readings) {
    const auto [found, fresh] = place.emplace(key_of(reading), poses.size());
    if (fresh) poses.emplace_back();
    poses[found->second].push_back(&reading);
  }
  return poses;
}

std::vector<PoseResult> evaluate_poses(const std::vector<PoseReading>& readings) {
  std::vector<PoseResult> results;
  for (const auto& pose : visits_by_pose(readings)) {
    const Vector3d& at = pose.front()->commanded_mm;
    if (pose.size() < 2)
      throw text::InputError(
          fmt::format("the file has only one reading at {:g} {:g} {:g} mm: a standard deviation needs two "
                      "readings, and ISO 9283 requires thirty",
                      at[0], at[1], at[2]));
    results.push_back(pose_of(pose));
  }
  return results;
}

void align_to_commanded(std::vector<PoseReading>& readings) {
  const auto count = static_cast<Eigen::Index>(readings.size());
  Eigen::Matrix3Xd from(3, count), to(3, count);
  for (std::size_t i = 0; i < readings.size(); ++i) {
    from.col(static_cast<Eigen::Index>(i)) = readings[i].measured_mm;
    to.col(static_cast<Eigen::Index>(i)) = readings[i].commanded_mm;
  }
  if (!maths::fixes_motion(to))
    throw text::InputError("--align: the alignment requires at least three poses that are not on one line");
  const maths::RigidMotion motion = maths::align(from, to);
  const Eigen::Quaterniond turned(motion.rotation);
  for (PoseReading& r : readings) {
    r.measured_mm = motion.rotation * r.measured_mm + motion.translation;
    if (!r.measured_deg) continue;
    const Eigen::AngleAxisd whole(turned * rotation(*r.measured_deg));
    r.measured_deg = maths::kDegPerRad * whole.angle() * whole.axis();
  }
}

}  // namespace vernier::evaluate
