// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/plan/touch_plan.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "tools/fit/convention.h"
#include "tools/fit/coverage/point_readings.h"
#include "tools/fit/size.h"
#include "tools/format/columns.h"
#include "tools/kinematics/inverse.h"
#include "tools/maths/decompositions.h"
#include "tools/model/chain/chain.h"
#include "tools/model/chain/prediction.h"
#include "tools/model/chain/thing_shape.h"
#include "tools/plan/first_plan.h"
#include "tools/plan/offered_poses.h"
#include "tools/text/error.h"

namespace vernier::plan {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::Vector3d;

constexpr std::size_t kPostures = 360;  // first guesses of the axes, over their ranges
/// Size of a surface or line that the plan touches, and the radius if the file does not know one, mm.
constexpr double kExtent_mm = 200, kRadius_mm = 12.5;

const model::Artefact& artefact_of(const model::Machine& machine, const std::string& name) {
  std::vector<std::string> names;
  for (const model::Artefact& one : machine.artefacts) {
    if (one.name == name) return one;
    names.push_back(one.name);
  }
  throw text::InputError({machine.file, 0}, name,
                         names.empty() ? "the machine file has no <artefact>"
                                       : fmt::format("the machine file has no artefact of this name, but {}",
                                                     fmt::join(names, ", ")));
}

/// Points of contact with the outward normal at each.
struct Contact {
  Vector3d point, normal;
};

std::vector<Contact> round_contacts(const Vector3d& centre, const Eigen::Matrix3d& axes, double radius,
                                    double height, std::size_t count) {
  std::vector<Contact> list;
  for (std::size_t i = 0; i < count; ++i) {
    const double turn = 2 * std::numbers::pi * static_cast<double>(i) / static_cast<double>(count);
    const Vector3d across = std::cos(turn) * axes.col(0) + std::sin(turn) * axes.col(1);
    const Vector3d normal =
        height == 0 ? across : (across * std::sqrt(1 - height * height) + height * axes.col(2)).eval();
    list.push_back({centre + radius * normal, normal});
  }
  return list;
}

/// Where an artefact is touched: all sides of it that a probe from above can reach.
std::vector<Contact> contacts_of(const model::Artefact& artefact, const model::ThingShape& shape) {
  const Vector3d along = shape.axes.col(2);
  std::vector<Contact> list;
  const auto take = [&](const std::vector<Contact>& more) {
    list.insert(list.end(), more.begin(), more.end());
  };
  switch (artefact.type) {
    case model::ArtefactType::kPoint:
      return {{shape.point, Vector3d::Zero()}};
    case model::ArtefactType::kLine:
      for (const double share : {-0.5, -0.25, 0.0, 0.25, 0.5})
        list.push_back({shape.point + share * kExtent_mm * along, Vector3d::Zero()});
      return list;
    case model::ArtefactType::kPlane:
      for (const double a : {-0.5, -0.25, 0.0, 0.25, 0.5})
        for (const double b : {-0.5, -0.25, 0.0, 0.25, 0.5})
          list.push_back({shape.point + kExtent_mm * (a * shape.axes.col(0) + b * shape.axes.col(1)), along});
      return list;
    case model::ArtefactType::kSphere:
      list.push_back({shape.point + shape.radius * along, along});
      for (const double height : {0.0, 0.5, 0.8})
        take(round_contacts(shape.point, shape.axes, shape.radius, height, 8));
      return list;
    case model::ArtefactType::kCylinder:
      for (const double share : {-0.1, 0.0, 0.1})
        take(round_contacts(shape.point + share * kExtent_mm * along, shape.axes, shape.radius, 0, 8));
      return list;
  }
  return list;
}

class TouchPlanner {
 public:
  TouchPlanner(const model::Machine& machine, const std::string& name, const TouchPlanOptions& options)
      : machine_(with_own_frame(machine, name)),
        artefact_(artefact_of(machine_, name)),
        options_(options),
        planned_(planned_parameters(machine_, options.expected_um)) {
    stand();
    reach();
    read();
  }

  TouchPlan plan() {
    TouchPlan plan;
    plan.place_mm = shape_.point;
    plan.place_is_assumed = !artefact_.place;
    covariance_ = prior();
    plan.before_um = expanded_um(covariance_);
    std::vector<std::size_t> all(postures_.count);
    for (std::size_t i = 0; i < all.size(); ++i) all[i] = i;
    const MatrixXd after_all = after(all);
    plan.least_um = expanded_um(after_all);
    plan.not_seen = not_seen(after_all);
    plan.has_length = has_length();
    const std::vector<std::size_t> chosen = choose(plan.least_um);
    plan.after_um = expanded_um(covariance_);
    plan.states = model::select_states(postures_, nearest_way(machine_, postures_, chosen));
    return plan;
  }

 private:
  /// An artefact without a place is in workpiece coordinates: no set-up moves it.
  static model::Machine with_own_frame(const model::Machine& machine, const std::string& name) {
    model::Machine result = machine;
    if (!artefact_of(machine, name).place) result.base_shifts.clear();
    return result;
  }

  /// Place, direction and radius that the plan assumes.
  void stand() {
    const Vector3d up = -Eigen::Map<const Vector3d>(machine_.gravity.data());
    shape_.axes.col(2) = artefact_.direction ? Eigen::Map<const Vector3d>(artefact_.direction->data()) : up;
    shape_.axes.col(0) = shape_.axes.col(2).unitOrthogonal();
    shape_.axes.col(1) = shape_.axes.col(2).cross(shape_.axes.col(0));
    shape_.radius = artefact_.radius.value_or(kRadius_mm);
    if (artefact_.place)
      shape_.point = Eigen::Map<const Vector3d>(artefact_.place->data());
    else
      shape_.point = middle_of_volume();
  }

  /// The tool point of an offered pose that is nearest to the mean of all: it can be reached.
  Vector3d middle_of_volume() const {
    const Eigen::Matrix3Xd points =
        model::forward(model::nominal_machine(machine_), planned_.offered).position;
    Index nearest = 0;
    (points.colwise() - points.rowwise().mean()).colwise().squaredNorm().minCoeff(&nearest);
    return points.col(nearest);
  }

  double tip() const {
    const auto found = artefact_.tip.empty() ? std::nullopt : machine_.find_static(artefact_.tip);
    return found ? machine_.statics[*found].value : 0;
  }

  /// Finds the postures that bring the tool point to a contact, each once.
  void reach() {
    const std::vector<Contact> contacts = contacts_of(artefact_, shape_);
    const model::States starts = offered_poses(machine_, kPostures, 0);
    model::Poses target;
    target.position.resize(3, static_cast<Index>(kPostures));
    target.rotation.assign(kPostures, Eigen::Matrix3d::Identity());
    const double side = artefact_.inside ? -1 : 1;
    for (std::size_t i = 0; i < kPostures; ++i) {
      const Contact& contact = contacts[i % contacts.size()];
      target.position.col(static_cast<Index>(i)) = contact.point + side * tip() * contact.normal;
    }
    kinematics::InverseOptions options;
    options.match = kinematics::Match::kPosition;
    const kinematics::InverseResult found =
        kinematics::solve(model::nominal_machine(machine_), target, starts, options);
    std::vector<std::size_t> kept;
    for (std::size_t i = 0; i < kPostures; ++i)
      if (found.each[i].converged && is_new(found.states, i, kept)) kept.push_back(i);
    if (kept.empty())
      throw text::InputError({machine_.file, artefact_.line}, artefact_.name,
                             fmt::format("no posture within the ranges of the axes touches this artefact at "
                                         "({:.1f}, {:.1f}, {:.1f}) mm",
                                         shape_.point[0], shape_.point[1], shape_.point[2]));
    postures_ = model::select_states(found.states, kept);
  }

  bool is_new(const model::States& states, std::size_t row, const std::vector<std::size_t>& kept) const {
    constexpr double kSame = 1e-3;  // mm or deg
    return std::ranges::none_of(kept, [&](std::size_t other) {
      return std::ranges::all_of(states.axis, [&](const auto& axis) {
        return std::abs(axis[static_cast<Index>(row)] - axis[static_cast<Index>(other)]) < kSame;
      });
    });
  }

  /// Readings of all postures by parameters (in plan units) and unknown values of the artefact.
  void read() {
    const model::Measurement rows = fit::point_readings(postures_);
    const model::Linearisation linear =
        model::linearise(model::nominal_machine(machine_), rows, planned_.all);
    const MatrixXd moves = MatrixXd(linear.jacobian) * planned_.scale.asDiagonal();
    const Index n = moves.cols(), m = model::unknowns_of(artefact_);
    dimension_ = static_cast<Index>(artefact_.dimension());
    jacobian_.resize(dimension_ * static_cast<Index>(postures_.count), n + m);
    for (std::size_t i = 0; i < postures_.count; ++i)
      for (Index c = 0; c < dimension_; ++c) {
        const Index pose = 3 * static_cast<Index>(i);
        const model::TouchReading reading = model::touch(artefact_, shape_, linear.predicted.segment<3>(pose),
                                                         tip(), static_cast<std::size_t>(c));
        const Index row = dimension_ * static_cast<Index>(i) + c;
        jacobian_.row(row).head(n) = reading.by_point.transpose() * moves.middleRows(pose, 3);
        jacobian_.row(row).tail(m) = reading.by_unknown.transpose();
      }
  }

  MatrixXd prior() const {
    const Index n = planned_.scale.size(), m = jacobian_.cols() - n;
    constexpr double kUnknown = 1e3;  // mm, rad: an unknown place may be anywhere
    MatrixXd covariance = MatrixXd::Identity(n + m, n + m);
    const model::ThingUnknowns known = model::known_values(artefact_, shape_).precision;
    for (Index k = 0; k < m; ++k)
      covariance(n + k, n + k) = known[k] > 0 ? 1 / known[k] : kUnknown * kUnknown;
    return covariance;
  }

  auto rows_of(std::size_t posture) const {
    return jacobian_.middleRows(dimension_ * static_cast<Index>(posture), dimension_);
  }
  double variance() const { return std::pow(1e-3 * options_.reading_um, 2); }
  double expanded_um(const MatrixXd& covariance) const {
    const Index n = planned_.scale.size();
    return planned_.expanded_um(covariance.topLeftCorner(n, n));
  }

  MatrixXd inner_of(const MatrixXd& covariance, std::size_t posture) const {
    const MatrixXd one = rows_of(posture);
    return one * covariance * one.transpose() + variance() * MatrixXd::Identity(dimension_, dimension_);
  }
  void update(MatrixXd& covariance, std::size_t posture) const {
    const MatrixXd gain = covariance * rows_of(posture).transpose();
    covariance -= gain * maths::solve_positive(inner_of(covariance, posture), MatrixXd(gain.transpose()));
  }
  MatrixXd after(const std::vector<std::size_t>& postures) const {
    MatrixXd covariance = prior();
    for (const std::size_t one : postures) update(covariance, one);
    return covariance;
  }

  std::vector<std::size_t> choose(double least_um) {
    constexpr double kNearLeast = 1.1;  // of the limit of this artefact: more touches hardly help
    const Index n = planned_.scale.size();
    std::vector<std::size_t> chosen;
    std::vector<char> taken(postures_.count, 0);
    while (chosen.size() < std::min(options_.points, postures_.count) &&
           (chosen.size() < 2 || expanded_um(covariance_) > kNearLeast * least_um)) {
      const MatrixXd in_volume =
          covariance_.leftCols(n) * planned_.weight * covariance_.leftCols(n).transpose();
      std::pair<double, std::size_t> best{-1, 0};
      for (std::size_t i = 0; i < postures_.count; ++i) {
        if (taken[i] != 0) continue;
        const MatrixXd one = rows_of(i);
        const MatrixXd fall = one * in_volume * one.transpose();
        best = std::max(best, {maths::solve_positive(inner_of(covariance_, i), fall).trace(), i});
      }
      chosen.push_back(best.second);
      taken[best.second] = 1;
      update(covariance_, best.second);
    }
    return chosen;
  }

  std::vector<std::string> not_seen(const MatrixXd& after_all) const {
    constexpr double kStays = 0.9;  // share of the uncertainty before
    std::vector<std::string> names;
    for (const Index j : planned_.own)
      if (std::sqrt(after_all(j, j)) > kStays)
        names.push_back(planned_.all[static_cast<std::size_t>(j)].name);
    return names;
  }

  /// A known radius is a length, and so are positions of linear axes that the fit does not scale.
  bool has_length() const {
    if (artefact_.has_radius() && artefact_.radius) return true;
    const model::Measurement rows = fit::point_readings(planned_.offered);
    const fit::Convention convention = fit::convention_of(machine_, rows, planned_.all);
    return !fit::size_direction(machine_, rows, planned_.all, convention, planned_.all.get(machine_));
  }

  const model::Machine machine_;
  const model::Artefact& artefact_;
  const TouchPlanOptions options_;
  const PlannedParameters planned_;
  model::ThingShape shape_;
  model::States postures_;
  Index dimension_ = 0;  // readings of a touch
  MatrixXd jacobian_;    // of all postures
  MatrixXd covariance_;  // of parameters and unknown values, after the chosen touches
};

}  // namespace

TouchPlan touch_plan(const model::Machine& machine, const std::string& artefact,
                     const TouchPlanOptions& options) {
  return TouchPlanner(machine, artefact, options).plan();
}

std::string touch_plan_text(const TouchPlan& plan, const std::string& artefact) {
  std::string text = fmt::format(
      "{} touches of the artefact {}: U95 of the tool point {:.3g} um (k = 2, mean over the volume), now "
      "{:.3g} um; with "
      "all touches of this artefact: {:.3g} um\n",
      plan.states.count, artefact, plan.after_um, plan.before_um, plan.least_um);
  if (plan.place_is_assumed)
    text += fmt::format("The plan assumes that the artefact is at ({:.1f}, {:.1f}, {:.1f}) mm.\n",
                        plan.place_mm[0], plan.place_mm[1], plan.place_mm[2]);
  if (!plan.has_length)
    text +=
        "Touches cannot determine the size of the machine, because no length is known. Give the radius of "
        "the artefact, or the distance of two points.\n";
  constexpr std::size_t kListed = 12;  // entries of a printed list
  const std::size_t more = plan.not_seen.size() - std::min(kListed, plan.not_seen.size());
  const std::vector<std::string> named(plan.not_seen.begin(),
                                       plan.not_seen.end() - static_cast<std::ptrdiff_t>(more));
  if (!named.empty())
    text += fmt::format("Touches of this artefact do not determine: {}{}\n", fmt::join(named, ", "),
                        more > 0 ? fmt::format(" and {} more", more) : "");
  return text;
}

std::string touch_plan_csv(const model::Machine& machine, const TouchPlan& plan, const std::string& artefact,
                           double reading_um) {
  std::string text =
      "# Replace the positions of the axes by those at the touch. Check the poses for collisions.\n";
  for (const model::Axis& axis : machine.axes)
    text += format::axis_heading(format::AxisQuantity::kPosition, axis.name, axis.rotary) + ",";
  text += input_headings(machine);
  text += std::string(format::columns::kOn) + "," +
          format::headings(std::array{format::columns::kUncertainty}) + "\n";
  for (std::size_t row = 0; row < plan.states.count; ++row) {
    for (std::size_t i = 0; i < machine.axes.size(); ++i)
      text += fmt::format("{:.4f},", plan.states.axis[i][static_cast<Index>(row)]);
    text += input_references(machine);
    text += fmt::format("{},{:g}\n", artefact, 1e-3 * reading_um);
  }
  return text;
}

}  // namespace vernier::plan
