// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/tolerance/placed_part.h"

#include <fmt/format.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>

#include "tools/kinematics/inverse.h"
#include "tools/maths/decompositions.h"
#include "tools/model/chain/chain.h"
#include "tools/text/error.h"

namespace vernier::tolerance {
namespace {

using Eigen::Index;
using Eigen::Vector3d;

/// Least and largest number of points on a circle. Twelve points determine the first three harmonics.
constexpr std::size_t kLeastOnCircle = 12, kMostOnCircle = 384;
/// Circles of a cylinder, points along an edge of a plane. Five points determine a curve of fourth degree.
constexpr int kCircles = 3, kOnEdge = 5;

struct SurfaceSample {
  Vector3d point, direction;
};

/// Returns two unit vectors across `axis`. The first is as near to X (else Y) as possible.
std::array<Vector3d, 2> across(const Vector3d& axis) {
  const Vector3d like = std::abs(axis.x()) < 0.9 ? Vector3d::UnitX() : Vector3d::UnitY();
  const Vector3d first = (like - like.dot(axis) * axis).normalized();
  return {first, axis.cross(first)};
}

std::vector<SurfaceSample> samples_of(const PartFeature& feature, std::size_t on_circle) {
  std::vector<SurfaceSample> samples;
  if (feature.kind == PartFeatureKind::kPoint) return {{feature.at, feature.direction}};
  const auto [u, v] = across(feature.direction);
  if (feature.kind == PartFeatureKind::kPlane) {
    for (int row = 0; row < kOnEdge; ++row)
      for (int k = 0; k < kOnEdge; ++k) {
        const int column = row % 2 == 0 ? k : kOnEdge - 1 - k;  // there and back
        const double a = column / (kOnEdge - 1.0) - 0.5, b = row / (kOnEdge - 1.0) - 0.5;
        samples.push_back(
            {feature.at + a * feature.length_mm * u + b * feature.width_mm * v, feature.direction});
      }
    return samples;
  }
  const int circles = feature.length_mm > 0 ? kCircles : 1;
  for (int circle = 0; circle < circles; ++circle)
    for (std::size_t k = 0; k < on_circle; ++k) {
      const double height = circles > 1 ? circle / (circles - 1.0) - 0.5 : 0;
      const double angle = 2 * std::numbers::pi * static_cast<double>(k) / static_cast<double>(on_circle);
      const Vector3d out = std::cos(angle) * u + std::sin(angle) * v;
      samples.push_back(
          {feature.at + height * feature.length_mm * feature.direction + 0.5 * feature.diameter_mm * out,
           out});
    }
  return samples;
}

/// Axis positions of one feature's points, each found from the one before.
class PointSolver {
 public:
  PointSolver(const model::Machine& machine, const std::string& file)
      : nominal_(model::nominal_machine(machine)), file_(file), linear_(kinematics::linear_axes(machine)) {}

  model::States solve_all(const PartFeature& feature, const std::vector<SurfaceSample>& samples,
                          const model::States& start) const {
    kinematics::InverseOptions options;
    options.match = feature.tool ? kinematics::Match::kDirection : kinematics::Match::kPosition;
    if (!feature.tool && !linear_.empty()) options.axes = linear_;
    model::Poses target;
    target.position.resize(3, static_cast<Index>(samples.size()));
    for (std::size_t i = 0; i < samples.size(); ++i)
      target.position.col(static_cast<Index>(i)) = samples[i].point;
    const Eigen::Matrix3d turn =
        feature.tool ? Eigen::Quaterniond::FromTwoVectors(Vector3d::UnitZ(), *feature.tool).toRotationMatrix()
                     : Eigen::Matrix3d::Identity();
    target.rotation.assign(samples.size(), turn);
    model::States states = model::select_states(start, std::vector<std::size_t>(samples.size(), 0));
    kinematics::InverseResult all = kinematics::solve(nominal_, target, states, options);
    for (std::size_t i = 0; i < samples.size(); ++i)
      if (!all.each[i].converged) again(feature, target, i, options, all);
    return all.states;
  }

 private:
  void again(const PartFeature& feature, const model::Poses& target, std::size_t i,
             const kinematics::InverseOptions& options, kinematics::InverseResult& all) const {
    constexpr int kRestarts = 48;  // other starts from which a pose is sought
    const auto at = static_cast<Index>(i);
    const model::Poses one{target.position.col(at), {target.rotation[i]}};
    const model::States from = model::select_states(all.states, {i > 0 ? i - 1 : i});
    const kinematics::InverseResult result =
        kinematics::solve_anywhere(nominal_, one, from, options, kRestarts);
    const kinematics::Inverse& proof = result.each[0];
    if (!proof.converged)
      throw text::LimitNotMet(
          fmt::format("{}:{}: \"{}\": the machine cannot reach the point {:.6g} {:.6g} {:.6g}: {}", file_,
                      feature.line, feature.name, target.position(0, at), target.position(1, at),
                      target.position(2, at), kinematics::name_of(proof.fault)));
    for (std::size_t a = 0; a < nominal_.axes.size(); ++a) all.states.axis[a][at] = result.states.axis[a][0];
  }

  model::Machine nominal_;
  const std::string& file_;
  std::vector<std::size_t> linear_;
};

/// If axes have ranges, their centre is the safest start of a search.
model::States start_of(const model::Machine& machine, const model::States& at) {
  model::States start = at;
  for (std::size_t a = 0; a < machine.axes.size(); ++a)
    if (const auto range = model::work_range(machine, a);
        range && !machine.axes[a].rotary && at.axis[a][0] == 0)
      start.axis[a][0] = 0.5 * ((*range)[0] + (*range)[1]);
  return start;
}

/// Sets directions of the axes in the order of the points. An axis without motion keeps its last
/// direction. The first direction is + (from below).
void set_senses(const model::Machine& machine, std::size_t first, std::size_t count, model::States& states) {
  constexpr double kStill = 1e-6;  // mm or deg
  for (std::size_t a = 0; a < machine.axes.size(); ++a) {
    double sense = 1;
    const auto way = [&](std::size_t from, std::size_t to) {
      return states.axis[a][static_cast<Index>(to)] - states.axis[a][static_cast<Index>(from)];
    };
    for (std::size_t i = 1; i < count; ++i)
      if (const double step = way(first + i - 1, first + i); std::abs(step) > kStill) {
        sense = step > 0 ? 1 : -1;
        break;
      }
    for (std::size_t i = 0; i < count; ++i) {
      if (i > 0)
        if (const double step = way(first + i - 1, first + i); std::abs(step) > kStill)
          sense = step > 0 ? 1 : -1;
      states.direction[a][static_cast<Index>(first + i)] = sense;
    }
  }
}

Eigen::Matrix3Xd directions_of(const std::vector<SurfaceSample>& samples) {
  Eigen::Matrix3Xd direction(3, static_cast<Index>(samples.size()));
  for (std::size_t i = 0; i < samples.size(); ++i)
    direction.col(static_cast<Index>(i)) = samples[i].direction;
  return direction;
}

/// Size and form of the error of the fitted machine on these points.
struct CircleError {
  double size = 0, form = 0;
};

CircleError circle_error(const model::Machine& machine, const model::States& states,
                         const Eigen::Matrix3Xd& direction) {
  const Eigen::Matrix3Xd error = model::forward(machine, states).position -
                                 model::forward(model::nominal_machine(machine), states).position;
  Eigen::VectorXd outward = error.cwiseProduct(direction).colwise().sum().transpose();
  const double mean = outward.mean();
  // The shift of the middle is no form. Its direction along the axis is not in `direction`.
  Eigen::MatrixXd design(direction.cols(), 4);
  design << direction.transpose(), Eigen::VectorXd::Ones(direction.cols());
  outward -= design * maths::least_norm(design, outward);
  return {2 * mean, outward.maxCoeff() - outward.minCoeff()};
}

/// Points on the circles of a feature; 0 for one without circles.
std::size_t on_circle_of(const model::Machine& machine, const PointSolver& solver, const PartFeature& feature,
                         const model::States& start) {
  if (feature.kind != PartFeatureKind::kCylinder) return 0;
  return points_on_circle(machine, [&](std::size_t count) {
    const std::vector<SurfaceSample> samples = samples_of(feature, count);
    model::States states = solver.solve_all(feature, samples, start);
    set_senses(machine, 0, samples.size(), states);
    return std::pair(std::move(states), directions_of(samples));
  });
}

}  // namespace

std::size_t points_on_circle(
    const model::Machine& machine,
    const std::function<std::pair<model::States, Eigen::Matrix3Xd>(std::size_t)>& placed) {
  constexpr double kAgree_mm = 5e-5,
                   kShare = 0.02;  // 0.05 um: below the resolution of a roundness instrument
  std::map<std::size_t, CircleError> known;
  const auto error = [&](std::size_t count) {
    if (const auto found = known.find(count); found != known.end()) return found->second;
    const auto [states, direction] = placed(count);
    return known[count] = circle_error(machine, states, direction);
  };
  std::size_t count = kLeastOnCircle;
  for (; 2 * count <= kMostOnCircle; count *= 2) {
    const CircleError few = error(count), twice = error(2 * count + 1),
                      thrice = error(3 * count + 1);  // no angle but the first is the same
    const double agree = std::max(kAgree_mm, kShare * thrice.form);
    const auto far = [&](const CircleError& one) {
      return std::abs(one.size - few.size) > agree || std::abs(one.form - few.form) > agree;
    };
    if (!far(twice) && !far(thrice)) break;
  }
  return count;
}

PlacedPart place_part(const model::Machine& machine, const PartDrawing& part, const model::States& at) {
  PlacedPart placed;
  const PointSolver solver(machine, part.file);
  const model::States start = start_of(machine, at);
  std::vector<model::States> parts;
  std::size_t count = 0;
  for (const PartFeature& feature : part.features) {
    const std::vector<SurfaceSample> samples =
        samples_of(feature, on_circle_of(machine, solver, feature, start));
    PlacedFeature one{feature, count, samples.size(), directions_of(samples)};
    parts.push_back(solver.solve_all(feature, samples, start));
    count += samples.size();
    placed.features.push_back(std::move(one));
  }
  placed.states = model::select_states(at, std::vector<std::size_t>(count, 0));
  for (std::size_t f = 0; f < parts.size(); ++f) {
    const PlacedFeature& one = placed.features[f];
    for (std::size_t a = 0; a < machine.axes.size(); ++a)
      placed.states.axis[a].segment(static_cast<Index>(one.first), static_cast<Index>(one.count)) =
          parts[f].axis[a];
    set_senses(machine, one.first, one.count, placed.states);
  }
  placed.point = model::forward(model::nominal_machine(machine), placed.states).position;
  return placed;
}

}  // namespace vernier::tolerance
