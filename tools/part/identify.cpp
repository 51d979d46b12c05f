// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/part/identify.h"

#include <fmt/format.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

#include "tools/maths/factors.h"
#include "tools/part/measured_part.h"
#include "tools/part/surface/s_part.h"

namespace vernier::part {
namespace {

constexpr std::array<const char*, 6> kAlignment = {"part.X",  "part.Y",  "part.Z",
                                                   "part.rX", "part.rY", "part.rZ"};

/// Defect that a small rigid motion of the part in the measuring frame feigns, per mm and deg of it: the part
/// moves, so its surface reads along +normal.
Eigen::MatrixXd alignment_columns(const PartDefect& defect) {
  Eigen::MatrixXd columns(defect.position.cols(), 6);
  for (Eigen::Index i = 0; i < columns.rows(); ++i) {
    const Eigen::Vector3d normal = defect.normal.col(i), position = defect.position.col(i);
    columns.row(i).head<3>() = normal;
    columns.row(i).tail<3>() = maths::kRadPerDeg * position.cross(normal);
  }
  return columns;
}

/// Defect that a cutter larger by 1 mm makes: it takes away that much along the normal, and a profile at
/// constant height shows it as wide as the wall leans.
Eigen::VectorXd radius_column(const PartDefect& defect, const std::vector<PartPoint>& points,
                              DefectReading reading) {
  Eigen::VectorXd column = Eigen::VectorXd::Constant(defect.position.cols(), -1);
  if (reading != DefectReading::kInPlane) return column;
  for (Eigen::Index i = 0; i < column.size(); ++i) {
    const PartPoint& at = points[static_cast<std::size_t>(i)];
    column[i] = -1 / surface_point(s_part()[at.flank], at.u, at.v).normal.head<2>().norm();
  }
  return column;
}

/// The measured part as a least-squares problem in the units of the statics (and mm, deg of the alignment).
class PartProblem {
 public:
  PartProblem(const BHeadMachine& machine, const MeasuredPart& part, const IdentifyOptions& options)
      : machine_(machine), options_(options) {
    const auto count = static_cast<Eigen::Index>(part.points.size());
    measured_.resize(count);
    weight_.setOnes(count);
    for (Eigen::Index i = 0; i < count; ++i) {
      const MeasuredPoint& point = part.points[static_cast<std::size_t>(i)];
      points_.push_back(point.at);
      measured_[i] = point.defect_mm;
      if (point.uncertainty_mm > 0) weight_[i] = 1 / point.uncertainty_mm;
    }
    free_ = free_statics(machine.machine);
  }

  const std::vector<std::size_t>& free() const { return free_; }
  Eigen::Index size() const {
    return static_cast<Eigen::Index>(free_.size()) + (options_.aligned ? 6 : 0) +
           (options_.tool_radius ? 1 : 0);
  }
  Eigen::VectorXd start() const {
    Eigen::VectorXd point = Eigen::VectorXd::Zero(size());
    for (std::size_t i = 0; i < free_.size(); ++i)
      point[static_cast<Eigen::Index>(i)] = machine_.machine.statics[free_[i]].value;
    return point;
  }
  BHeadMachine at(const Eigen::VectorXd& point) const {
    BHeadMachine result = machine_;
    for (std::size_t i = 0; i < free_.size(); ++i)
      result.machine.statics[free_[i]].value = point[static_cast<Eigen::Index>(i)];
    return result;
  }

  /// measured - model, and the derivatives of the model.
  Eigen::VectorXd residual(const Eigen::VectorXd& point, Eigen::MatrixXd* jacobian) const {
    const PartDefect defect = part_defect(at(point), points_, options_.defect);
    Eigen::VectorXd left = measured_ - defect.defect_mm;
    Eigen::MatrixXd all(left.size(), size());
    const Eigen::Index statics = defect.jacobian.cols();
    all.leftCols(statics) = defect.jacobian;
    if (options_.aligned) all.middleCols<6>(statics) = alignment_columns(defect);
    if (options_.tool_radius) all.rightCols<1>() = radius_column(defect, points_, options_.defect.reading);
    const Eigen::Index more = size() - statics;
    left -= all.rightCols(more) * point.tail(more);
    if (jacobian != nullptr) *jacobian = all;
    return left;
  }

  /// Sum of squares at a point, and the data for a step.
  double cost(const Eigen::VectorXd& point, Eigen::MatrixXd& normal, Eigen::VectorXd& gradient) const {
    Eigen::MatrixXd jacobian;
    const Eigen::VectorXd left = weight_.cwiseProduct(residual(point, &jacobian));
    jacobian = weight_.asDiagonal() * jacobian;
    normal = jacobian.transpose() * jacobian;
    gradient = jacobian.transpose() * left;
    return left.squaredNorm();
  }
  /// The combinations that the points can distinguish, evaluated at nominal errors. Away from there
  /// second-order terms show differences between columns that are equal.
  fit::Observability seen_at_nominal() const {
    Eigen::VectorXd point = Eigen::VectorXd::Zero(size());
    for (std::size_t i = 0; i < free_.size(); ++i) {
      const model::Static& item = machine_.machine.statics[free_[i]];
      point[static_cast<Eigen::Index>(i)] = item.nominal.value_or(item.value);
    }
    Eigen::MatrixXd normal;
    Eigen::VectorXd gradient;
    cost(point, normal, gradient);
    return fit::observe(normal);
  }

 private:
  const BHeadMachine& machine_;
  const IdentifyOptions& options_;
  std::vector<PartPoint> points_;
  std::vector<std::size_t> free_;
  Eigen::VectorXd measured_, weight_;
};

struct Solution {
  Eigen::VectorXd point;
  double chi_square = 0;
  int iterations = 0;
  bool converged = false;
};

/// Newton with the inverse of the start: the errors are so small that the chain is nearly linear in them, and
/// the directions that the points do not determine do not change.
Solution solve(const PartProblem& problem, const fit::Observability& seen) {
  constexpr int kMost = 50;           // Newton's steps, at most
  constexpr double kSettled = 1e-12;  // of the step that the first iteration made
  Solution solution{problem.start()};
  Eigen::MatrixXd normal;
  Eigen::VectorXd gradient;
  double first = 0;
  while (!solution.converged && solution.iterations < kMost) {
    problem.cost(solution.point, normal, gradient);
    const Eigen::VectorXd step = seen.covariance * gradient;
    const double size = step.dot(normal * step);  // gain of the step
    first = std::max(first, size);
    solution.point += step;
    ++solution.iterations;
    solution.converged = size <= kSettled * kSettled * first;
  }
  solution.chi_square = problem.cost(solution.point, normal, gradient);
  return solution;
}

void fill_statistics(Identification& result, const Solution& solved, bool with_uncertainty) {
  result.chi_square = solved.chi_square;
  result.freedom = result.residual_mm.size() - result.observability.rank;
  if (result.freedom > 0) result.variance_factor = solved.chi_square / static_cast<double>(result.freedom);
  if (with_uncertainty) result.variance_factor = std::max(1.0, result.variance_factor);
  const Eigen::MatrixXd covariance = result.variance_factor * result.observability.covariance;
  result.correlation = Eigen::MatrixXd::Zero(covariance.rows(), covariance.cols());
  const auto known = [&](Eigen::Index i) {
    return result.observability.determined[static_cast<std::size_t>(i)] != 0 && covariance(i, i) > 0;
  };
  for (Eigen::Index i = 0; i < covariance.rows(); ++i) {
    if (known(i) && (with_uncertainty || result.freedom > 0))
      result.errors[static_cast<std::size_t>(i)].std = std::sqrt(covariance(i, i));
    for (Eigen::Index k = 0; k < covariance.cols(); ++k)
      if (known(i) && known(k))
        result.correlation(i, k) = covariance(i, k) / std::sqrt(covariance(i, i) * covariance(k, k));
  }
}

/// A rest that the points' uncertainty does not explain, and what would.
void warn_of_rest(const BHeadMachine& machine, const MeasuredPart& part, const IdentifyOptions& options,
                  Identification& result) {
  constexpr double kLoud = 2;      // times u
  constexpr double kExplains = 2;  // times less chi^2
  const bool with_uncertainty = part.points.front().uncertainty_mm > 0;
  const double over =
      std::sqrt(result.chi_square / static_cast<double>(std::max<Eigen::Index>(1, result.freedom)));
  const bool loud = with_uncertainty && over > kLoud;
  if (loud)
    result.warnings.push_back(fmt::format(
        "the residual is {:.2g} times the uncertainty of the points: the fitted errors do not explain the "
        "part, and their values may have errors far larger than their standard uncertainties",
        over));
  if (options.tool_radius || result.freedom < 2 || (with_uncertainty && !loud)) return;
  IdentifyOptions more = options;
  more.tool_radius = true;
  const Identification with = identify(machine, part, more);
  if (result.chi_square < kExplains * with.chi_square || !with.errors.back().std) return;
  result.warnings.push_back(
      fmt::format("a tool radius error of {:+.4f} +- {:.2g} mm would explain the residual (chi^2 {:.3g} -> "
                  "{:.3g}): --tool-radius also fits this error",
                  with.errors.back().value, *with.errors.back().std, result.chi_square, with.chi_square));
}

}  // namespace

Identification identify(const BHeadMachine& machine, const MeasuredPart& part,
                        const IdentifyOptions& options) {
  const PartProblem problem(machine, part, options);
  const text::Place place{part.file, 0};
  if (problem.free().empty())
    throw text::InputError({machine.machine.file, 0}, "static",
                           "the machine file has no free static, so no error can be identified");
  if (static_cast<Eigen::Index>(part.points.size()) < problem.size())
    throw text::InputError(place, std::to_string(part.points.size()) + " points",
                           "the file has fewer points than the fit has unknowns");
  const bool with_uncertainty = part.points.front().uncertainty_mm > 0;
  const fit::Observability seen = problem.seen_at_nominal();
  const Solution solved = solve(problem, seen);
  Identification result;
  result.observability = seen;
  result.machine = problem.at(solved.point).machine;
  for (const std::size_t index : problem.free()) {
    const model::Static& item = result.machine.statics[index];
    result.errors.push_back({item.name, item.unit, item.value, {}});
  }
  for (std::size_t k = 0; options.aligned && k < kAlignment.size(); ++k)
    result.errors.push_back({kAlignment[k],
                             k < 3 ? "mm" : "deg",
                             solved.point[static_cast<Eigen::Index>(problem.free().size() + k)],
                             {}});
  if (options.tool_radius)
    result.errors.push_back({"tool.radius", "mm", solved.point[problem.size() - 1], {}});
  result.before_mm = problem.residual(problem.start(), nullptr);
  result.residual_mm = problem.residual(solved.point, nullptr);
  result.iterations = solved.iterations;
  result.converged = solved.converged;
  fill_statistics(result, solved, with_uncertainty);
  warn_of_rest(machine, part, options, result);
  return result;
}

fit::Observability part_observability(const BHeadMachine& machine, const std::vector<PartPoint>& points,
                                      const DefectOptions& options) {
  MeasuredPart part;
  for (const PartPoint& point : points) part.points.push_back({point, 0, 1, 0});
  const IdentifyOptions asked{options};
  const PartProblem problem(machine, part, asked);
  return problem.seen_at_nominal();
}

}  // namespace vernier::part
