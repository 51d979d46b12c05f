// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/plan/offers.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "tools/effects/input_class.h"
#include "tools/format/columns.h"
#include "tools/maths/median.h"

namespace vernier::plan {
namespace {

constexpr double kTemperatureStep = 5;     // K, a change that a shop can apply to a machine without damage
constexpr double kLoadFactor = 1.5;        // beyond the largest recorded load
constexpr double kEdge = 0.02;             // of the range, kept free for the approach
constexpr double kWorkingDayS = 8 * 3600;  // eight hours: a longer delay is another day
/// Delay of later rows, as a share of the time measured so far.
constexpr std::array<double, 3> kLater = {0.5, 1, 3};
/// Multiples of the recorded speed, and the travel since the reversal as a share of the range.
constexpr std::array<double, 3> kSpeeds = {0.5, 1, 2};
constexpr std::array<double, 3> kSince = {0.002, 0.02, 0.2};

/// Points of the unit interval, one sequence per dimension, evenly distributed together: fractions
/// of multiples of square roots of primes (Kronecker; Niederreiter 1992, ch. 3).
class Spread {
 public:
  explicit Spread(std::size_t index) : index_(static_cast<double>(index + 1)) {}
  double next() {
    const double root = std::sqrt(static_cast<double>(next_prime()));
    return std::fmod(index_ * root, 1.0);
  }
  template <class List>
  auto pick(const List& list) {
    return list[std::min(list.size() - 1,
                         static_cast<std::size_t>(next() * static_cast<double>(list.size())))];
  }

 private:
  int next_prime() {
    for (++prime_;; ++prime_) {
      bool prime = true;
      for (int d = 2; d * d <= prime_ && prime; ++d) prime = prime_ % d != 0;
      if (prime) return prime_;
    }
  }
  double index_;
  int prime_ = 1;
};

std::vector<double> values_of(const model::Column& column) { return {column.begin(), column.end()}; }

bool moves(const model::States& states, std::size_t row) {
  for (const model::Column& v : states.velocity)
    if (v[static_cast<Eigen::Index>(row)] != 0) return true;
  return false;
}

/// Writes the offered rows one by one into the columns.
class Offerer {
 public:
  Offerer(const model::Machine& machine, const model::Measurement& existing, const Drivers& drivers,
          std::size_t count)
      : machine_(machine), old_(existing), drivers_(drivers), count_(count) {}

  Offers offer() {
    find_ranges();
    choose_levels();
    append_templates();
    for (std::size_t i = 0; i < count_; ++i) draw(i);
    return std::move(result_);
  }

 private:
  bool driven(model::SymbolKind kind) const { return drivers_.kinds.contains(kind); }
  bool any_recorded(format::AxisQuantity quantity) const {
    return std::any_of(machine_.axes.begin(), machine_.axes.end(), [&](const model::Axis& axis) {
      return old_.has_recorded(format::axis_column(quantity, axis.name));
    });
  }

  void find_ranges() {
    for (std::size_t a = 0; a < machine_.axes.size(); ++a) {
      const model::Column q = model::commanded(old_, a);
      double low = machine_.axes[a].min.value_or(q.minCoeff());
      double high = machine_.axes[a].max.value_or(q.maxCoeff());
      const double edge = kEdge * (high - low);
      low_.push_back(low + edge);
      high_.push_back(high - edge);
    }
  }

  /// Levels of a column: its range and the values beyond it that can be set; only the middle if no effect
  /// uses the column.
  std::vector<double> levels(const model::Column& column, const model::Input& input) {
    const double middle = maths::median(values_of(column));
    if (!drivers_.inputs.contains(input.name)) return {middle};
    const double low = column.minCoeff(), high = column.maxCoeff();
    switch (effects::class_of_input(input)) {
      case effects::InputClass::kTemperature:
        return {low - kTemperatureStep, low, high, high + kTemperatureStep};
      case effects::InputClass::kLoad:
        return {0, low, high, std::max(kLoadFactor * high, high)};
      default:
        result_.not_settable.push_back(input.name);
        return {middle};
    }
  }

  void choose_levels() {
    for (std::size_t i = 0; i < machine_.inputs.size(); ++i)
      input_levels_.push_back(levels(old_.states.input[i], machine_.inputs[i]));
    for (const model::CandidateInput& candidate : old_.candidates) {
      std::vector<double> known;
      for (const double value : candidate.value)
        if (std::isfinite(value)) known.push_back(value);
      const model::Column column =
          Eigen::Map<const model::Column>(known.data(), static_cast<Eigen::Index>(known.size()));
      model::Input input;
      input.name = candidate.name;
      input.unit = candidate.unit;
      candidate_levels_.push_back(known.empty() ? std::vector<double>{0} : levels(column, input));
    }
    const double begin = old_.states.time.minCoeff(), end = old_.states.time.maxCoeff();
    time_levels_ = {end + step_of_time()};
    if (driven(model::SymbolKind::kTime))
      for (const double share : kLater)
        time_levels_.push_back(end + std::min(share * (end - begin), std::max(end - begin, kWorkingDayS)));
    bool moving = false;
    for (std::size_t row = 0; row < old_.rows(); ++row) moving = moving || moves(old_.states, row);
    speeds_ = moving ? std::vector<double>(kSpeeds.begin(), kSpeeds.end()) : std::vector<double>{1};
    senses_ = any_recorded(format::AxisQuantity::kSense) || driven(model::SymbolKind::kDirection);
    since_ = any_recorded(format::AxisQuantity::kSince) || driven(model::SymbolKind::kSince);
  }

  double step_of_time() const {
    const double span = old_.states.time.maxCoeff() - old_.states.time.minCoeff();
    return span / std::max(1.0, static_cast<double>(old_.rows()) - 1);
  }

  void append_templates() {
    std::vector<std::size_t> which(old_.rows());
    for (std::size_t row = 0; row < which.size(); ++row) which[row] = row;
    result_.existing = old_.rows();
    for (std::size_t i = 0; i < count_; ++i)
      which.push_back(std::min(
          old_.rows() - 1, static_cast<std::size_t>(Spread(i).next() * static_cast<double>(old_.rows()))));
    model::Measurement& rows = result_.rows = model::select_rows(old_, which);
    const double u = maths::median(values_of(old_.uncertainty));
    plan_without_correction(rows);
    for (std::size_t row = result_.existing; row < rows.rows(); ++row) {
      rows.uncertainty[static_cast<Eigen::Index>(row)] = u;
      model::begin_run(rows.states, row, kPlanRun);
      rows.states.visit[static_cast<Eigen::Index>(row)] = 0;
    }
    // The direction of the tool is not known before the machine is at the pose.
    if (rows.direction.cols() > 0)
      rows.direction.rightCols(static_cast<Eigen::Index>(count_)).setConstant(std::nan(""));
    fixed_pose_.assign(rows.rows(), 0);
    for (const model::Observation& o : rows.observations)
      if (o.kind == model::ObservationKind::kLength || o.kind == model::ObservationKind::kD)
        fixed_pose_[o.row] = 1;
  }

  /// The offered rows are at the commanded positions of the templates, without a correction.
  void plan_without_correction(model::Measurement& rows) const {
    const auto from = static_cast<Eigen::Index>(result_.existing), count = static_cast<Eigen::Index>(count_);
    for (std::size_t a = 0; a < rows.correction.size(); ++a) {
      rows.states.axis[a].segment(from, count) = model::commanded(rows, a).segment(from, count);
      rows.correction[a].segment(from, count).setZero();
    }
    for (std::size_t row = result_.existing; row < rows.corrected.size(); ++row) rows.corrected[row].clear();
  }

  void draw(std::size_t offer) {
    const std::size_t row = result_.existing + offer;
    const auto at = static_cast<Eigen::Index>(row);
    Spread spread(offer);
    spread.next();  // has selected the template
    draw_motion(at, spread);
    // Half of the poses are recorded ones: an arm or an instrument does not reach all of the
    // ranges.
    const bool recorded_pose = spread.next() < 0.5;
    for (std::size_t a = 0; a < machine_.axes.size(); ++a) {
      const double place = spread.next();
      if (fixed_pose_[row] != 0) continue;
      double& q = result_.rows.states.axis[a][at];
      q = std::clamp(q, low_[a], high_[a]);  // space for an approach from either side
      if (recorded_pose) continue;
      const double inside = std::clamp((place - 0.3) / 0.4, 0.0, 1.0);
      q = low_[a] + inside * (high_[a] - low_[a]);
    }
    result_.rows.states.time[at] = spread.pick(time_levels_);
    for (std::size_t i = 0; i < input_levels_.size(); ++i)
      result_.rows.states.input[i][at] = spread.pick(input_levels_[i]);
    for (std::size_t i = 0; i < candidate_levels_.size(); ++i)
      result_.rows.candidates[i].value[at] = spread.pick(candidate_levels_[i]);
  }

  /// The template's motion, at another speed and in either direction. The path is the same, so
  /// accelerations are proportional to the square of the speed.
  void draw_motion(Eigen::Index at, Spread& spread) {
    model::States& s = result_.rows.states;
    const double speed = spread.pick(speeds_), sense = spread.next() < 0.5 ? -1 : 1;
    const double since = spread.pick(kSince);
    const bool alike = spread.next() < 0.5;
    s.feed[at] *= speed;
    for (std::size_t a = 0; a < machine_.axes.size(); ++a) {
      s.velocity[a][at] *= speed * sense;
      s.acceleration[a][at] *= speed * speed;
      const double own = alike ? sense : spread.next() < 0.5 ? -1 : 1;
      if (senses_) s.direction[a][at] = s.velocity[a][at] != 0 ? (s.velocity[a][at] > 0 ? 1 : -1) : own;
      if (since_) s.since[a][at] = since * (high_[a] - low_[a]);
    }
  }

  const model::Machine& machine_;
  const model::Measurement& old_;
  const Drivers& drivers_;
  std::size_t count_;
  Offers result_;
  std::vector<double> low_, high_, speeds_, time_levels_;
  std::vector<std::vector<double>> input_levels_, candidate_levels_;
  std::vector<char> fixed_pose_;
  bool senses_ = false, since_ = false;
};

}  // namespace

model::Measurement append_rows(const model::Measurement& first, const model::Measurement& second) {
  model::Measurement all = first;
  model::append_measurement(all, second, true);
  return all;
}

model::Measurement rows_to_build_on(const model::Measurement& all, const Drivers& drivers, std::size_t most) {
  std::vector<char> read(all.rows(), 0);
  for (const model::Observation& o : all.observations) read[o.row] = 1;
  std::vector<std::size_t> keep;
  for (std::size_t row = 0; row < all.rows(); ++row) {
    bool known = all.check[row] == 0 && read[row] != 0;
    for (const model::CandidateInput& candidate : all.candidates)
      if (drivers.inputs.contains(candidate.name))
        known = known && std::isfinite(candidate.value[static_cast<Eigen::Index>(row)]);
    if (known) keep.push_back(row);
  }
  const std::size_t stride = (keep.size() + most - 1) / std::max<std::size_t>(1, most);
  std::vector<std::size_t> thinned;
  for (std::size_t i = 0; i < keep.size(); i += std::max<std::size_t>(1, stride)) thinned.push_back(keep[i]);
  return model::select_rows(all, thinned);
}

Offers offer_rows(const model::Machine& machine, const model::Measurement& existing, const Drivers& drivers,
                  std::size_t count) {
  return Offerer(machine, existing, drivers, count).offer();
}

}  // namespace vernier::plan
