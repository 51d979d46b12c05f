// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/registry/alike.h"

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <map>
#include <numeric>
#include <set>

#include "tools/maths/chance.h"
#include "tools/maths/decompositions.h"
#include "tools/maths/median.h"
#include "tools/registry/wander.h"
#include "tools/text/wall_time.h"

namespace vernier::registry {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

// A scatter below a thousandth of the stated one is rounding and is not used as a measure.
constexpr double kLeastVariance = 1e-6;
constexpr std::size_t kFewest = 3;  // machines, times, and readings of a machine whose rate is asked for
// Number of machines whose wander is estimated: more machines give no better estimate and take as long as all
// other steps.
constexpr std::size_t kMostAsked = 60;
// Decrease of -2 log likelihood at which wander is significant: chi^2 of two at 1e-3.
constexpr double kWorthSaying = 13;
// A rate that depends on one reading is no drift: without any one of its readings it must still be
// significant at this level.
const double kLogStillTold = std::log(0.05);

/// Readings of one quantity in units of their uncertainty, and the columns of a model of them.
class AdditiveModel {
 public:
  AdditiveModel(const std::vector<FleetReading>& readings, double every_days) {
    std::int64_t first = INT64_MAX;
    for (const FleetReading& one : readings) first = std::min(first, one.at_us);
    for (const FleetReading& one : readings) {
      machine_.try_emplace(one.machine, static_cast<Index>(machine_.size()));
      const double days = static_cast<double>(one.at_us - first) / text::kUsADay;
      rows_.push_back({&one, days, static_cast<std::int64_t>(std::floor(days / every_days))});
      time_.try_emplace(rows_.back().bin, 0);
      begin_of_[rows_.back().bin] = first + static_cast<std::int64_t>(static_cast<double>(rows_.back().bin) *
                                                                      every_days * text::kUsADay);
    }
    Index next = 0;
    for (auto& [bin, index] : time_) index = next++;
    make_series();
  }

  std::size_t machines() const { return machine_.size(); }
  std::size_t times() const { return time_.size(); }
  std::size_t readings() const { return rows_.size(); }

  /// Weighted columns: levels, the curve (but its first time) if asked for, rates of the machines `own`.
  MatrixXd columns(bool curve, const std::vector<std::string>& own) const {
    const Index levels = static_cast<Index>(machine_.size()),
                bends = curve ? static_cast<Index>(time_.size()) - 1 : 0;
    MatrixXd x =
        MatrixXd::Zero(static_cast<Index>(rows_.size()), levels + bends + static_cast<Index>(own.size()));
    for (std::size_t i = 0; i < rows_.size(); ++i) {
      const auto row = static_cast<Index>(i);
      x(row, machine_.at(rows_[i].reading->machine)) = 1 / rows_[i].reading->std;
      const Index bend = time_.at(rows_[i].bin);
      if (curve && bend > 0) x(row, levels + bend - 1) = 1 / rows_[i].reading->std;
    }
    for (std::size_t k = 0; k < own.size(); ++k)
      x.col(levels + bends + static_cast<Index>(k)) = rate_of(own[k]).first;
    return x;
  }
  VectorXd values() const {
    VectorXd y(static_cast<Index>(rows_.size()));
    for (std::size_t i = 0; i < rows_.size(); ++i)
      y[static_cast<Index>(i)] = rows_[i].reading->value / rows_[i].reading->std;
    return y;
  }
  /// The column of a machine's own rate, and how many readings it has.
  std::pair<VectorXd, std::size_t> rate_of(const std::string& machine) const {
    VectorXd column = VectorXd::Zero(static_cast<Index>(rows_.size()));
    std::size_t count = 0;
    for (std::size_t i = 0; i < rows_.size(); ++i) {
      if (rows_[i].reading->machine != machine) continue;
      column[static_cast<Index>(i)] = rows_[i].days / rows_[i].reading->std;
      ++count;
    }
    return {column, count};
  }
  const std::map<std::string, Index>& machine_names() const { return machine_; }
  /// Readings of a machine, or of all in the order of machine_names().
  const WanderSeries& series_of(const std::string& machine) const {
    return series_[static_cast<std::size_t>(machine_.at(machine))];
  }
  const std::vector<WanderSeries>& series() const { return series_; }
  std::int64_t begin_of(std::size_t time) const {
    return std::next(begin_of_.begin(), static_cast<std::ptrdiff_t>(time))->second;
  }

 private:
  void make_series() {
    std::vector<double> stds;
    for (const RowOfModel& row : rows_) stds.push_back(row.reading->std);
    const double usual = maths::median(std::move(stds));
    std::vector<std::size_t> order(rows_.size());
    std::iota(order.begin(), order.end(), 0);
    std::stable_sort(order.begin(), order.end(),
                     [&](std::size_t a, std::size_t b) { return rows_[a].days < rows_[b].days; });
    series_.resize(machine_.size());
    for (const std::size_t i : order) {
      WanderSeries& series = series_[static_cast<std::size_t>(machine_.at(rows_[i].reading->machine))];
      series.row.push_back(static_cast<Index>(i));
      series.days.push_back(rows_[i].days);
      series.weight.push_back(usual / rows_[i].reading->std);
    }
  }

  struct RowOfModel {
    const FleetReading* reading;
    double days;
    std::int64_t bin;
  };
  std::vector<RowOfModel> rows_;
  std::vector<WanderSeries> series_;
  std::map<std::string, Index> machine_;
  std::map<std::int64_t, Index> time_;
  std::map<std::int64_t, std::int64_t> begin_of_;
};

/// Least squares of one model.
struct Solved {
  Eigen::LDLT<MatrixXd> normal;
  VectorXd solution, rest;
  double sum = 0, freedom = 0;
};

Solved solve(const MatrixXd& x, const VectorXd& y) {
  Solved solved;
  solved.normal.compute(x.transpose() * x);
  solved.solution = solved.normal.solve(x.transpose() * y);
  solved.rest = y - x * solved.solution;
  solved.sum = solved.rest.squaredNorm();
  solved.freedom = static_cast<double>(x.rows() - x.cols());
  return solved;
}

struct Clearest {
  std::string machine;
  double log_p = 0;
};

/// The fleet's readings as if they were independent: how each machine wanders is taken out.
class FleetFit {
 public:
  explicit FleetFit(const AdditiveModel& model) : model_(model) {
    // Residual after the common part: a machine's steady rate is no wander.
    const Solved plain = solve(model.columns(true, {}), model.values());
    VectorXd left = model.values();
    const auto levels = static_cast<Index>(model.machines());
    const MatrixXd x = model.columns(true, {});
    left -= x.rightCols(x.cols() - levels) * plain.solution.tail(x.cols() - levels);
    std::vector<WanderSeries> asked = model.series();
    asked.resize(std::min(asked.size(), kMostAsked));
    wander_ = estimated_wander(asked, left);
    fit({});
  }

  const Wander& wander() const { return wander_; }
  const Solved& now() const { return now_; }
  Solved solved(bool curve, const std::vector<std::string>& own) const {
    return solve(whitened(model_.columns(curve, own)), whitened(model_.values()));
  }
  void fit(const std::vector<std::string>& own) {
    own_ = own;
    x_ = whitened(model_.columns(true, own));
    now_ = solve(x_, whitened(model_.values()));
  }

  /// The machine whose individual rate would explain most of the residual.
  Clearest clearest_own() const {
    Clearest best;
    if (now_.freedom < 2) return best;
    for (const auto& [machine, index] : model_.machine_names()) {
      if (std::find(own_.begin(), own_.end(), machine) != own_.end()) continue;
      const double log_p = log_p_of_rate(machine);
      if (log_p < best.log_p) best = {machine, log_p};
    }
    return best;
  }

  /// Logarithm of the probability of a machine's rate without the reading that contributes most to it.
  double without_its_best_reading(const std::string& machine) const {
    double most = -1e300;
    for (const Index row : model_.series_of(machine).row) {
      MatrixXd one = MatrixXd::Zero(x_.rows(), 1);
      one(row, 0) = 1;
      MatrixXd x(x_.rows(), x_.cols() + 1);
      x << x_, whitened(one);
      const Solved without = solve(x, now_.rest);
      most = std::max(most, log_p_of_rate(machine, x, without));
    }
    return most;
  }

 private:
  MatrixXd whitened(MatrixXd columns) const {
    whiten(model_.series(), wander_, columns);
    return columns;
  }
  double log_p_of_rate(const std::string& machine) const { return log_p_of_rate(machine, x_, now_); }
  double log_p_of_rate(const std::string& machine, const MatrixXd& x, const Solved& now) const {
    const auto [plain, count] = model_.rate_of(machine);
    if (count < kFewest || now.freedom < 2) return 0;
    const VectorXd column = whitened(plain);
    const VectorXd through = x.transpose() * column;
    const double amount = column.squaredNorm() - through.dot(now.normal.solve(through));
    if (!(amount > 1e-9 * column.squaredNorm())) return 0;
    const double gain = std::pow(column.dot(now.rest), 2) / amount;
    const double left = std::max(now.sum - gain, kLeastVariance * (now.freedom - 1));
    return maths::log_f_tail(gain / (left / (now.freedom - 1)), 1, now.freedom - 1);
  }

  const AdditiveModel& model_;
  Wander wander_;
  std::vector<std::string> own_;
  MatrixXd x_;
  Solved now_;
};

Drift drift_of(const std::vector<FleetReading>& readings, const AlikeOptions& options,
               std::size_t quantities) {
  const AdditiveModel model(readings, options.every_days);
  Drift drift;
  drift.quantity = readings[0].quantity, drift.unit = readings[0].unit;
  drift.machines = model.machines(), drift.times = model.times(), drift.readings = model.readings();
  if (drift.machines < kFewest || drift.times < kFewest ||
      drift.readings < drift.machines + drift.times + kFewest)
    return drift;
  drift.judged = true;
  const double share = options.false_alarms / (2 * static_cast<double>(quantities));
  FleetFit fit(model);
  std::vector<std::string> own;
  // If all machines but two had individual rates, no machine would define the common part.
  while (own.size() + 2 < drift.machines) {
    const Clearest next = fit.clearest_own();
    if (next.machine.empty() || next.log_p > std::log(share / static_cast<double>(drift.machines)) ||
        fit.without_its_best_reading(next.machine) > kLogStillTold)
      break;
    own.push_back(next.machine);
    fit.fit(own);
  }
  const Solved& now = fit.now();
  drift.scatter = std::sqrt(now.sum / now.freedom);
  if (fit.wander().gain > kWorthSaying) {
    drift.wander = drift.scatter * std::sqrt(fit.wander().ratio);
    drift.wander_days = fit.wander().days;
  }
  const Solved still = fit.solved(false, own);
  const double bends = still.freedom - now.freedom;
  drift.common_p = std::exp(maths::log_f_tail(
      std::max(still.sum - now.sum, 0.0) / bends / std::max(now.sum / now.freedom, kLeastVariance), bends,
      now.freedom));
  drift.common = drift.common_p < share;
  const auto levels = static_cast<Index>(drift.machines);
  for (std::size_t time = 0; time < drift.times; ++time)
    drift.curve.emplace_back(model.begin_of(time),
                             time == 0 ? 0.0 : now.solution[levels + static_cast<Index>(time) - 1]);
  const auto [low, high] =
      std::minmax_element(drift.curve.begin(), drift.curve.end(),
                          [](const auto& a, const auto& b) { return a.second < b.second; });
  drift.common_swing = high->second - low->second;
  const double wide = std::max(drift.scatter, 1.0);
  for (std::size_t k = 0; k < own.size(); ++k) {
    const Index at = now.solution.size() - static_cast<Index>(own.size() - k);
    const VectorXd unit = VectorXd::Unit(now.solution.size(), at);
    drift.own.push_back({own[k], now.solution[at], wide * std::sqrt(now.normal.solve(unit)[at])});
  }
  return drift;
}

}  // namespace

std::vector<Drift> drifts(const std::vector<FleetReading>& readings, const AlikeOptions& options) {
  std::map<std::string, std::vector<FleetReading>> by_quantity;
  for (const FleetReading& one : readings)
    if (one.std > 0) by_quantity[one.quantity + "\n" + one.unit].push_back(one);  // of one unit only
  std::vector<Drift> all;
  for (const auto& [name, its] : by_quantity) all.push_back(drift_of(its, options, by_quantity.size()));
  return all;
}

}  // namespace vernier::registry
