#include "tools/part/identify.h"

#include <Eigen/Geometry>
#include <cmath>
#include <numbers>

#include "tools/fit/levenberg.h"

namespace vernier {
namespace {

constexpr double kDeg = std::numbers::pi / 180;
constexpr std::array<const char*, 6> kAlignment = {"part.X",  "part.Y",  "part.Z",
                                                   "part.rX", "part.rY", "part.rZ"};

/// Defect that a small rigid motion of the part in the measuring frame feigns, per mm and deg of it: the part
/// moves, so its surface reads along +normal.
Eigen::MatrixXd alignment_columns(const PartDefect& defect) {
  Eigen::MatrixXd columns(defect.position.cols(), 6);
  for (Eigen::Index i = 0; i < columns.rows(); ++i) {
    const Eigen::Vector3d normal = defect.normal.col(i), position = defect.position.col(i);
    columns.row(i).head<3>() = normal;
    columns.row(i).tail<3>() = kDeg * position.cross(normal);
  }
  return columns;
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
    for (std::size_t i = 0; i < machine.machine.statics.size(); ++i)
      if (!machine.machine.statics[i].hidden) free_.push_back(i);
  }

  const std::vector<std::size_t>& free() const { return free_; }
  Eigen::Index size() const { return static_cast<Eigen::Index>(free_.size()) + (options_.aligned ? 6 : 0); }
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
    all.leftCols(defect.jacobian.cols()) = defect.jacobian;
    // A chain need not use every static; a column that it has no derivative for is one that nothing sees.
    if (defect.parameters != free_) {
      all.setZero();
      for (std::size_t k = 0; k < defect.parameters.size(); ++k)
        for (std::size_t i = 0; i < free_.size(); ++i)
          if (free_[i] == defect.parameters[k])
            all.col(static_cast<Eigen::Index>(i)) = defect.jacobian.col(static_cast<Eigen::Index>(k));
    }
    if (options_.aligned) {
      all.rightCols<6>() = alignment_columns(defect);
      left -= all.rightCols<6>() * point.tail<6>();
    }
    if (jacobian != nullptr) *jacobian = all;
    return left;
  }

  double cost(const Eigen::VectorXd& point) const {
    return weight_.cwiseProduct(residual(point, nullptr)).squaredNorm();
  }
  NormalEquations equations(const Eigen::VectorXd& point) const {
    Eigen::MatrixXd jacobian;
    const Eigen::VectorXd left = weight_.cwiseProduct(residual(point, &jacobian));
    jacobian = weight_.asDiagonal() * jacobian;
    return {left.squaredNorm(), jacobian.transpose() * jacobian, jacobian.transpose() * left};
  }

 private:
  const BHeadMachine& machine_;
  const IdentifyOptions& options_;
  std::vector<PartPoint> points_;
  std::vector<std::size_t> free_;
  Eigen::VectorXd measured_, weight_;
};

void fill_statistics(Identification& result, const PartProblem& problem, const LevenbergResult& solved,
                     bool with_uncertainty) {
  result.observability = observe(problem.equations(solved.point).normal);
  result.chi_square = solved.cost;
  result.freedom = result.residual_mm.size() - result.observability.rank;
  if (result.freedom > 0) result.variance_factor = solved.cost / static_cast<double>(result.freedom);
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

}  // namespace

Identification identify(const BHeadMachine& machine, const MeasuredPart& part,
                        const IdentifyOptions& options) {
  const PartProblem problem(machine, part, options);
  const Place place{part.file, 0};
  if (problem.free().empty())
    throw InputError({machine.machine.file, 0}, "static", "nothing is free to be fitted");
  if (static_cast<Eigen::Index>(part.points.size()) < problem.size())
    throw InputError(place, std::to_string(part.points.size()) + " points", "fewer points than unknowns");
  const bool with_uncertainty = part.points.front().uncertainty_mm > 0;
  const LevenbergResult solved = minimise(
      problem.start(), [&](const Eigen::VectorXd& p) { return problem.equations(p); },
      [&](const Eigen::VectorXd& p) { return problem.cost(p); }, {});
  Identification result;
  result.machine = problem.at(solved.point).machine;
  for (const std::size_t index : problem.free()) {
    const Static& item = result.machine.statics[index];
    result.errors.push_back({item.name, item.unit, item.value, {}});
  }
  for (std::size_t k = 0; options.aligned && k < kAlignment.size(); ++k)
    result.errors.push_back({kAlignment[k],
                             k < 3 ? "mm" : "deg",
                             solved.point[static_cast<Eigen::Index>(problem.free().size() + k)],
                             {}});
  result.before_mm = problem.residual(problem.start(), nullptr);
  result.residual_mm = problem.residual(solved.point, nullptr);
  result.iterations = solved.iterations;
  result.converged = solved.converged;
  fill_statistics(result, problem, solved, with_uncertainty);
  return result;
}

Observability part_observability(const BHeadMachine& machine, const std::vector<PartPoint>& points,
                                 const DefectOptions& options) {
  MeasuredPart part;
  for (const PartPoint& point : points) part.points.push_back({point, 0, 1, 0});
  const IdentifyOptions asked{options, false};
  const PartProblem problem(machine, part, asked);
  return observe(problem.equations(problem.start()).normal);
}

}  // namespace vernier
