// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/tolerance/program_features.h"

#include <fmt/format.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <iterator>

#include "tools/kinematics/inverse.h"
#include "tools/maths/decompositions.h"
#include "tools/model/chain/chain.h"
#include "tools/offline/part_program.h"
#include "tools/text/error.h"

namespace vernier::tolerance {
namespace {

using Eigen::Index;

/// Evaluated points per stretch of a path, and their largest total.
constexpr std::size_t kOnStretch = 12, kMostOfPath = 400;

/// Moves that form one feature.
struct ProgramCut {
  std::size_t first_line = 0, last_line = 0;
  bool circle = false;
  std::vector<model::States> stretches;
};

class CutCollector {
 public:
  explicit CutCollector(std::size_t axes) : axes_(axes) {}

  void take(const offline::ProgramStretch& stretch) {
    if (stretch.rapid) {
      open_ = false;
      return;
    }
    const bool same_circle =
        open_ && stretch.whole_circle && cuts.back().circle && cuts.back().last_line == stretch.line;
    if (stretch.whole_circle ? !same_circle : (!open_ || cuts.back().circle)) {
      cuts.push_back({stretch.line, stretch.line, stretch.whole_circle, {}});
      open_ = true;
    }
    ProgramCut& cut = cuts.back();
    cut.last_line = stretch.line;
    cut.stretches.push_back(stretch.states);
  }

  /// Returns all stretches of a cut together, with points evenly along the path, on a circle `on_circle`.
  model::States points_of(const ProgramCut& cut, const model::Machine& nominal, std::size_t on_circle) const {
    std::vector<std::pair<const model::States*, std::size_t>> all;
    std::vector<double> way;
    Eigen::Vector3d last = Eigen::Vector3d::Zero();
    for (const model::States& states : cut.stretches) {
      const Eigen::Matrix3Xd points = model::forward(nominal, states).position;
      for (std::size_t k = 0; k < states.count; ++k) {
        const Eigen::Vector3d point = points.col(static_cast<Index>(k));
        way.push_back(way.empty() ? 0 : way.back() + (point - last).norm());
        all.emplace_back(&states, k);
        last = point;
      }
    }
    // The last point of a circle is its first point.
    const std::size_t count =
        cut.circle ? on_circle
                   : std::min(kMostOfPath, std::max<std::size_t>(2, kOnStretch * cut.stretches.size()));
    const double steps = static_cast<double>(cut.circle ? count : count - 1);
    model::States picked = model::select_states(cut.stretches.front(), std::vector<std::size_t>(count, 0));
    for (std::size_t i = 0; i < count; ++i) {
      const double target = way.back() * static_cast<double>(i) / steps;
      auto at = std::lower_bound(way.begin(), way.end(), target);
      if (at == way.end() || (at != way.begin() && target - *std::prev(at) < *at - target)) --at;
      take_row(*all[static_cast<std::size_t>(at - way.begin())].first,
               all[static_cast<std::size_t>(at - way.begin())].second, i, picked);
    }
    return picked;
  }

  std::vector<ProgramCut> cuts;

 private:
  void take_row(const model::States& from, std::size_t row, std::size_t to, model::States& all) const {
    const auto source = static_cast<Index>(row), target = static_cast<Index>(to);
    for (const auto list : {&model::States::axis, &model::States::direction, &model::States::velocity,
                            &model::States::acceleration, &model::States::since})
      for (std::size_t a = 0; a < axes_; ++a) (all.*list)[a][target] = (from.*list)[a][source];
    all.feed[target] = from.feed[source];
  }

  std::size_t axes_;
  bool open_ = false;
};

Eigen::Matrix3Xd tangents_of(const Eigen::Matrix3Xd& points) {
  Eigen::Matrix3Xd tangents = Eigen::Matrix3Xd::Zero(3, points.cols());
  for (Index i = 0; i < points.cols(); ++i) {
    const Eigen::Vector3d way =
        points.col(std::min(i + 1, points.cols() - 1)) - points.col(std::max<Index>(i - 1, 0));
    if (way.norm() > 1e-9) tangents.col(i) = way.normalized();
  }
  return tangents;
}

/// Computes centre, axis and diameter of a circle from points all around it: the least-squares
/// circle (Kasa 1976).
void make_circle(const Eigen::Matrix3Xd& points, PartFeature& feature, Eigen::Matrix3Xd& direction) {
  const Eigen::Vector3d middle = points.rowwise().mean();
  Eigen::Matrix3Xd from = points.colwise() - middle;
  Eigen::Vector3d axis = Eigen::Vector3d::Zero();
  for (Index i = 0; i + 1 < from.cols(); ++i) axis += from.col(i).cross(Eigen::Vector3d(from.col(i + 1)));
  feature.direction = axis.normalized();
  Eigen::MatrixXd design(from.cols() + 1, 4);
  Eigen::VectorXd squares(from.cols() + 1);
  design.topRows(from.cols()) << 2 * from.transpose(), Eigen::VectorXd::Ones(from.cols());
  design.bottomRows(1) << feature.direction.transpose(), 0;  // in the plane of the points
  squares << from.colwise().squaredNorm().transpose(), 0;
  const Eigen::Vector4d found = maths::least_squares(design, squares);
  feature.at = middle + found.head<3>();
  from = points.colwise() - feature.at;
  feature.diameter_mm = 2 * from.colwise().norm().mean();
  direction = from.colwise().normalized();
}

}  // namespace

PlacedPart program_part(const model::Machine& machine, const std::string& text, const std::string& file,
                        const model::States& at, const std::vector<char>& known,
                        const ProgramOptions& options) {
  CutCollector collector(machine.axes.size());
  offline::PartProgramOptions reading;
  reading.zero = options.zero;
  reading.watch = [&](const offline::ProgramStretch& stretch) { collector.take(stretch); };
  offline::Corrector corrector(machine,
                               {.with_rotary = kinematics::linear_axes(machine).empty(), .back = false});
  offline::corrected_program(text, file, at, known, reading, corrector);
  if (collector.cuts.empty())
    throw text::InputError({file, 0}, file, "the program has no cutting move (G1, G2, G3)");
  PlacedPart part;
  part.program = true;
  std::vector<model::States> all;
  std::size_t count = 0;
  const model::Machine nominal = model::nominal_machine(machine);
  for (const ProgramCut& cut : collector.cuts) {
    PlacedFeature one;
    const auto circle = [&](std::size_t on_circle) {
      model::States states = collector.points_of(cut, nominal, on_circle);
      make_circle(model::forward(nominal, states).position, one.feature, one.direction);
      return std::pair(std::move(states), one.direction);
    };
    const model::States states =
        collector.points_of(cut, nominal, cut.circle ? points_on_circle(machine, circle) : 0);
    const Eigen::Matrix3Xd points = model::forward(nominal, states).position;
    one.first = count;
    one.count = states.count;
    one.feature.kind = cut.circle ? PartFeatureKind::kCylinder : PartFeatureKind::kPath;
    one.feature.name = cut.first_line == cut.last_line
                           ? fmt::format("{} of line {}", cut.circle ? "circle" : "path", cut.first_line)
                           : fmt::format("path of lines {} to {}", cut.first_line, cut.last_line);
    one.feature.line = cut.first_line;
    one.feature.position_mm = options.position_mm;
    if (cut.circle) {
      one.feature.size_mm = options.size_mm;
      one.feature.form_mm = options.form_mm;
      make_circle(points, one.feature, one.direction);
    } else {
      one.feature.at = points.rowwise().mean();
      one.direction = tangents_of(points);
    }
    all.push_back(states);
    count += states.count;
    part.features.push_back(std::move(one));
  }
  part.states = model::select_states(at, std::vector<std::size_t>(count, 0));
  for (std::size_t f = 0; f < all.size(); ++f) {
    const auto first = static_cast<Index>(part.features[f].first), n = static_cast<Index>(all[f].count);
    for (const auto list : {&model::States::axis, &model::States::direction, &model::States::velocity,
                            &model::States::acceleration, &model::States::since})
      for (std::size_t a = 0; a < machine.axes.size(); ++a)
        (part.states.*list)[a].segment(first, n) = (all[f].*list)[a];
    part.states.feed.segment(first, n) = all[f].feed;
  }
  part.point = model::forward(nominal, part.states).position;
  return part;
}

}  // namespace vernier::tolerance
