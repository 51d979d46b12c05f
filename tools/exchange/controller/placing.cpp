// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/exchange/controller/placing.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "tools/exchange/left_out.h"
#include "tools/exchange/variance_of.h"
#include "tools/kinematics/correction.h"
#include "tools/model/chain/periods.h"
#include "tools/text/error.h"

namespace vernier::exchange {
namespace {

using Eigen::Index;
using Eigen::Matrix3Xd;

double to_step(double value, double unit) {
  const double result = std::round(value / unit) * unit;
  return result == 0 ? 0 : result;  // no -0
}

/// The three corrections along one axis, in one direction, as means over positions of the two other axes.
class Along {
 public:
  /// others: positions of each other axis; 1 is the middle of the range.
  Along(const model::Machine& machine, const ThreeAxes& axes, const model::States& at, std::size_t input,
        std::size_t others)
      : machine_(machine), axes_(axes), at_(at), input_(input), others_(others) {}

  Matrix3Xd operator()(const std::vector<double>& positions, double direction) const {
    constexpr std::size_t kAtATime = 4096;  // states of a forward solution: memory
    const std::size_t part = std::max<std::size_t>(1, kAtATime / (others_ * others_));
    Matrix3Xd all(3, static_cast<Index>(positions.size()));
    for (std::size_t from = 0; from < positions.size(); from += part) {
      const std::size_t to = std::min(from + part, positions.size());
      const std::vector<double> some(positions.begin() + static_cast<std::ptrdiff_t>(from),
                                     positions.begin() + static_cast<std::ptrdiff_t>(to));
      all.middleCols(static_cast<Index>(from), static_cast<Index>(some.size())) = mean(some, direction);
    }
    return all;
  }

 private:
  double other(std::size_t axis, std::size_t k) const {
    const double share = others_ == 1 ? 0.5 : static_cast<double>(k) / static_cast<double>(others_ - 1);
    return axes_.low[axis] + share * (axes_.high[axis] - axes_.low[axis]);
  }

  Matrix3Xd mean(const std::vector<double>& positions, double direction) const {
    const std::size_t a = (input_ + 1) % 3, b = (input_ + 2) % 3, pairs = others_ * others_;
    const auto count = static_cast<Index>(positions.size() * pairs);
    Matrix3Xd commands(3, count), directions = Matrix3Xd::Zero(3, count);
    directions.row(static_cast<Index>(input_)).setConstant(direction);
    for (std::size_t p = 0; p < positions.size(); ++p)
      for (std::size_t k = 0; k < pairs; ++k) {
        const auto column = static_cast<Index>(p * pairs + k);
        commands(static_cast<Index>(input_), column) = positions[p];
        commands(static_cast<Index>(a), column) = other(a, k % others_);
        commands(static_cast<Index>(b), column) = other(b, k / others_);
      }
    const kinematics::CorrectionResult result =
        kinematics::correct(machine_, controller_states(axes_, commands, directions, at_));
    Matrix3Xd offset(3, static_cast<Index>(positions.size()));
    for (std::size_t i = 0; i < 3; ++i)
      for (std::size_t p = 0; p < positions.size(); ++p)
        offset(static_cast<Index>(i), static_cast<Index>(p)) =
            result.offset[axes_.axis[i]]
                .segment(static_cast<Index>(p * pairs), static_cast<Index>(pairs))
                .mean();
    return offset;
  }

  const model::Machine& machine_;
  const ThreeAxes& axes_;
  const model::States& at_;
  std::size_t input_, others_;
};

/// Positions of the points of one input axis.
struct Points {
  double from = 0, step = 1;
  std::size_t count = 0;
};

/// Points at a distance `step` that cover a range. Stairs have a point at the reference.
Points points_of(const ControllerRules& rules, double low, double high, double reference, double step) {
  Points points;
  points.step = std::ceil(step / rules.position_step_mm - 1e-6) * rules.position_step_mm;
  points.from = std::floor(low / rules.position_step_mm + 1e-6) * rules.position_step_mm;
  if (rules.stairs) {
    const double before = std::max(1.0, std::ceil((reference - low) / points.step - 1e-9));
    points.from = reference - before * points.step;
  }
  const double parts = std::max(1.0, std::ceil((high - points.from) / points.step - 1e-9));
  points.count = static_cast<std::size_t>(parts) + 1;
  return points;
}

/// The corrections at the points of an input axis, of one direction.
Matrix3Xd values_at(const Along& along, const Points& points, double low, double high, double direction) {
  std::vector<double> positions;
  for (std::size_t k = 0; k < points.count; ++k)
    positions.push_back(std::clamp(points.from + static_cast<double>(k) * points.step, low, high));
  Matrix3Xd values = along(positions, direction);
  // The last point may be beyond the range: the line to that point meets the value at the end of the range.
  constexpr double kShortest = 0.1;
  const Index last = values.cols() - 1;
  const double share = (high - positions[positions.size() - 2]) / points.step;
  if (share >= kShortest && share < 1)
    values.col(last) = values.col(last - 1) + (values.col(last) - values.col(last - 1)) / share;
  return values;
}

Matrix3Xd nearest_values(const Along& along, const Points& points, double low, double high,
                         double direction) {
  std::vector<double> positions;
  for (std::size_t k = 0; k < points.count; ++k)
    positions.push_back(std::clamp(points.from + static_cast<double>(k) * points.step, low, high));
  return along(positions, direction);
}

/// Tables of one input axis with all outputs, before the choice of those that are written.
class InputAxis {
 public:
  InputAxis(const model::Machine& machine, const ThreeAxes& axes, const ControllerRules& rules,
            const model::States& at, const ControllerWishes& wishes, std::size_t input)
      : rules_(rules),
        wishes_(wishes),
        input_(input),
        low_(axes.low[input]),
        high_(axes.high[input]),
        middle_(machine, axes, at, input, 1),
        mean_(machine, axes, at, input, kOthers) {
    probes_ = uneven(machine, axes, at);
    for (std::size_t d = 0; d < 2; ++d) probed_[d] = middle_(probes_, kDirection[d]);
    const std::vector<double> at_reference = {std::clamp(wishes.reference[input], low_, high_)};
    const Eigen::Vector3d zero = (middle_(at_reference, 1) + middle_(at_reference, -1)).col(0) / 2;
    Matrix3Xd shape = (probed_[0] + probed_[1]) / 2;
    shape.colwise() -= zero;
    largest_ = shape.cwiseAbs().rowwise().maxCoeff();
  }

  /// Whether the table of an output is written.
  bool written(std::size_t output) const {
    return output == input_ ||
           (rules_.most_cross > 0 && 1000 * largest_[static_cast<Index>(output)] > wishes_.tolerance_um / 4);
  }

  std::vector<ControllerTable> tables(double& reversal, double& between_um) const {
    std::vector<ControllerTable> result;
    Points shared;
    for (std::size_t output = 0; output < 3; ++output)
      if (written(output)) {
        const Points points = points_for(output);
        if (points.count > shared.count) shared = points;
      }
    for (std::size_t output = 0; output < 3; ++output) {
      if (!written(output)) continue;
      const Points points = rules_.same_points ? shared : points_for(output);
      result.push_back(table(output, points, mean_));
      between_um = std::max(between_um, error_between_um(output, points));
    }
    const Matrix3Xd forward = mean_(evenly(), 1), reverse = mean_(evenly(), -1);
    if (!rules_.own_reverse)
      reversal = to_step((forward - reverse).row(static_cast<Index>(input_)).mean(), rules_.value_step_mm);
    return result;
  }

 private:
  static constexpr std::size_t kOthers = 5;
  static constexpr std::array<double, 2> kDirection = {1, -1};

  std::vector<double> evenly() const {
    constexpr std::size_t kPositions = 101;
    std::vector<double> positions;
    for (std::size_t k = 0; k < kPositions; ++k)
      positions.push_back(low_ + (high_ - low_) * static_cast<double>(k) / (kPositions - 1));
    return positions;
  }

  /// One position in each of many equal parts, at a different position in each part (golden section).
  std::vector<double> uneven(const model::Machine& machine, const ThreeAxes& axes,
                             const model::States& at) const {
    constexpr double kFewest = 1024, kMost = 16384, kPerPeriod = 32, kPerStation = 8;
    constexpr double kGolden = 0.6180339887498949;
    const model::Detail detail = model::detail_along(machine, axes.axis[input_], at);
    const double wanted = (high_ - low_) * std::max(kPerPeriod / detail.period, kPerStation / detail.station);
    const auto count = static_cast<std::size_t>(std::clamp(wanted, kFewest, kMost));
    std::vector<double> positions;
    for (std::size_t i = 0; i < count; ++i) {
      const double place = static_cast<double>(i) * kGolden;
      positions.push_back(low_ + (high_ - low_) * (static_cast<double>(i) + place - std::floor(place)) /
                                     static_cast<double>(count));
    }
    return positions;
  }

  std::size_t most(std::size_t output) const {
    const std::size_t own = output == input_ ? rules_.most_own : rules_.most_cross;
    return rules_.same_points && rules_.most_cross > 0 ? std::min(rules_.most_own, rules_.most_cross) : own;
  }

  Points points_for(std::size_t output) const {
    const double reference = wishes_.reference[input_], range = high_ - low_;
    if (wishes_.step_mm > 0) {
      const Points points = points_of(rules_, low_, high_, reference, wishes_.step_mm);
      if (points.count > most(output))
        throw text::InputError(
            fmt::format("--step: {} mm needs {} points of {}; the controller stores {} points",
                        wishes_.step_mm, points.count, kLetters[input_], most(output)));
      return points;
    }
    // More points can be worse: points 8 mm apart misread an error with a period of 10 mm.
    Points best = points_of(rules_, low_, high_, reference, range);
    double least_um = error_between_um(output, best);
    // 1, 2, 4, 5, 8, 10 parts and so on: distances with few digits.
    for (double decade = 1; decade <= 1e4; decade *= 10)
      for (const double part : {1.0, 2.0, 2.5, 4.0, 5.0, 8.0}) {
        const double parts = decade * part;
        if (parts != std::floor(parts)) continue;
        const Points points = points_of(rules_, low_, high_, reference, range / parts);
        if (points.count > most(output) || least_um <= wishes_.tolerance_um) return best;
        const double um = error_between_um(output, points);
        if (um >= least_um) continue;
        best = points;
        least_um = um;
      }
    return best;
  }

  ControllerTable table(std::size_t output, const Points& points, const Along& along) const {
    ControllerTable result{input_, output, points.from, points.step, rules_.stairs, {}, {}, low_, high_};
    const auto values = rules_.stairs ? nearest_values : values_at;
    const Eigen::VectorXd forward = values(along, points, low_, high_, 1).row(static_cast<Index>(output)),
                          reverse = values(along, points, low_, high_, -1).row(static_cast<Index>(output));
    const std::vector<double> at_reference = {std::clamp(wishes_.reference[input_], low_, high_)};
    const double zero = (along(at_reference, 1) + along(at_reference, -1))(static_cast<Index>(output), 0) / 2;
    const bool apart = rules_.own_reverse && output == input_;
    for (Index k = 0; k < forward.size(); ++k) {
      const double mean = (forward[k] + reverse[k]) / 2;
      result.forward.push_back(to_step((apart ? forward[k] : mean) - zero, rules_.value_step_mm));
      result.reverse.push_back(to_step((apart ? reverse[k] : mean) - zero, rules_.value_step_mm));
    }
    return result;
  }

  /// Largest error of a table between its points, along the middle of the other axes, without an offset.
  double error_between_um(std::size_t output, const Points& points) const {
    const ControllerTable tried = table(output, points, middle_);
    double low = 0, high = 0, sum = 0;
    bool first = true;
    for (std::size_t d = 0; d < 2; ++d)
      for (std::size_t k = 0; k < probes_.size(); ++k) {
        const Eigen::VectorXd& row = mean_or_direction(output, d);
        const double error = row[static_cast<Index>(k)] - tried.at(probes_[k], kDirection[d]);
        low = first ? error : std::min(low, error);
        high = first ? error : std::max(high, error);
        first = false;
        sum += error;
      }
    const double mean = sum / static_cast<double>(2 * probes_.size());
    return 1000 * std::max(high - mean, mean - low);
  }

  const Eigen::VectorXd& mean_or_direction(std::size_t output, std::size_t d) const {
    const bool apart = rules_.own_reverse && output == input_;
    Eigen::VectorXd& row = rows_[output][d];
    if (row.size() == 0)
      row = apart ? Eigen::VectorXd(probed_[d].row(static_cast<Index>(output)))
                  : Eigen::VectorXd((probed_[0] + probed_[1]).row(static_cast<Index>(output)) / 2);
    return row;
  }

  const ControllerRules& rules_;
  const ControllerWishes& wishes_;
  std::size_t input_;
  double low_, high_;
  Along middle_, mean_;
  std::vector<double> probes_;
  std::array<Matrix3Xd, 2> probed_;
  Eigen::Vector3d largest_;
  mutable std::array<std::array<Eigen::VectorXd, 2>, 3> rows_;
};

}  // namespace

namespace {

/// The straight line that fits values at equal distances best.
Eigen::VectorXd line_of(const Eigen::VectorXd& values) {
  const Eigen::VectorXd place = Eigen::VectorXd::LinSpaced(values.size(), -1, 1);
  return Eigen::VectorXd::Constant(values.size(), values.mean()) +
         place * (place.dot(values) / place.squaredNorm());
}

/// Values of the tables of an input axis for the two other axes without their straight lines, one below the
/// other, in the middle of the other axes.
Eigen::VectorXd shapes_along(const model::Machine& machine, const ThreeAxes& axes, const model::States& at,
                             std::size_t input) {
  constexpr std::size_t kPositions = 33;
  std::vector<double> positions;
  for (std::size_t k = 0; k < kPositions; ++k)
    positions.push_back(axes.low[input] +
                        (axes.high[input] - axes.low[input]) * static_cast<double>(k) / (kPositions - 1));
  const Matrix3Xd values = Along(machine, axes, at, input, 1)(positions, 0);
  Eigen::VectorXd shapes(2 * values.cols());
  for (std::size_t other = 1; other <= 2; ++other) {
    const Eigen::VectorXd row = values.row(static_cast<Index>((input + other) % 3));
    shapes.segment(static_cast<Index>(other - 1) * values.cols(), values.cols()) = row - line_of(row);
  }
  return shapes;
}

/// Straight lines in place of the tables whose shape is less than twice its standard uncertainty.
void leave_uncertain_shapes(ControllerTables& result, const model::Machine& machine, const ThreeAxes& axes,
                            const model::States& at, const ControllerRules& rules) {
  if (!machine.fitted || machine.fitted->factor.cols() == 0) return;
  for (std::size_t input = 0; input < 3; ++input) {
    const auto of = [&](const model::Machine& moved) { return shapes_along(moved, axes, at, input); };
    if (result.find(input, (input + 1) % 3) == nullptr && result.find(input, (input + 2) % 3) == nullptr)
      continue;
    const Eigen::VectorXd shapes = of(machine), variance = variance_of(machine, machine.fitted->factor, of);
    for (ControllerTable& table : result.tables) {
      if (table.input != input || table.output == input) continue;
      const Index half = shapes.size() / 2, from = table.output == (input + 1) % 3 ? 0 : half;
      const double rms = std::sqrt(shapes.segment(from, half).squaredNorm() / static_cast<double>(half)),
                   std = std::sqrt(variance.segment(from, half).mean());
      if (1000 * rms < kNothing_um || std <= kMostShare * rms) continue;
      result.uncertain.push_back({table.input, table.output, 1000 * rms, 1000 * std});
      for (std::vector<double>* const values : {&table.forward, &table.reverse}) {
        Eigen::Map<Eigen::VectorXd> all(values->data(), static_cast<Index>(values->size()));
        all = line_of(all);
      }
      const double zero = table.at(result.reference[input], 1);
      for (std::vector<double>* const values : {&table.forward, &table.reverse})
        for (double& value : *values) value = to_step(value - zero, rules.value_step_mm);
    }
  }
}

}  // namespace

ControllerTables controller_tables(const model::Machine& machine, const ThreeAxes& axes,
                                   const ControllerRules& rules, const model::States& at,
                                   const ControllerWishes& wishes) {
  ControllerTables result;
  result.reference = wishes.reference;
  for (std::size_t input = 0; input < 3; ++input) {
    const InputAxis one(machine, axes, rules, at, wishes, input);
    for (ControllerTable& table : one.tables(result.reversal[input], result.between_um[input]))
      result.tables.push_back(std::move(table));
  }
  leave_uncertain_shapes(result, machine, axes, at, rules);
  return result;
}

}  // namespace vernier::exchange
