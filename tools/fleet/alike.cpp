// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/fleet/alike.h"

#include <Eigen/Cholesky>
#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <map>
#include <set>

#include "tools/maths/chance.h"

namespace vernier::fleet {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

constexpr double kUsEachDay = 86'400e6;
// A scatter below a thousandth of what is stated is rounding, and no measure for anything.
constexpr double kLeastVariance = 1e-6;
constexpr std::size_t kFewest = 3;  // machines, times, and readings of a machine whose rate is asked for

/// Readings of one quantity in units of their uncertainty, and the columns of a model of them.
class AdditiveModel {
 public:
  AdditiveModel(const std::vector<FleetReading>& readings, double every_days) {
    std::int64_t first = INT64_MAX;
    for (const FleetReading& one : readings) first = std::min(first, one.at_us);
    for (const FleetReading& one : readings) {
      machine_.try_emplace(one.machine, static_cast<Index>(machine_.size()));
      const double days = static_cast<double>(one.at_us - first) / kUsEachDay;
      rows_.push_back({&one, days, static_cast<std::int64_t>(std::floor(days / every_days))});
      time_.try_emplace(rows_.back().bin, 0);
      begin_of_[rows_.back().bin] =
          first + static_cast<std::int64_t>(static_cast<double>(rows_.back().bin) * every_days * kUsEachDay);
    }
    Index next = 0;
    for (auto& [bin, index] : time_) index = next++;
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
      for (std::size_t k = 0; k < own.size(); ++k)
        if (rows_[i].reading->machine == own[k])
          x(row, levels + bends + static_cast<Index>(k)) = rows_[i].days / rows_[i].reading->std;
    }
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
  std::int64_t begin_of(std::size_t time) const {
    return std::next(begin_of_.begin(), static_cast<std::ptrdiff_t>(time))->second;
  }

 private:
  struct RowOfModel {
    const FleetReading* reading;
    double days;
    std::int64_t bin;
  };
  std::vector<RowOfModel> rows_;
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

/// The machine whose own rate would explain most of what is left.
Clearest clearest_own(const AdditiveModel& model, const MatrixXd& x, const Solved& now,
                      const std::vector<std::string>& own) {
  Clearest best;
  if (now.freedom < 2) return best;
  for (const auto& [machine, index] : model.machine_names()) {
    if (std::find(own.begin(), own.end(), machine) != own.end()) continue;
    const auto [column, count] = model.rate_of(machine);
    if (count < kFewest) continue;
    const VectorXd through = x.transpose() * column;
    const double amount = column.squaredNorm() - through.dot(now.normal.solve(through));
    if (!(amount > 1e-9 * column.squaredNorm())) continue;
    const double gain = std::pow(column.dot(now.rest), 2) / amount;
    const double left = std::max(now.sum - gain, kLeastVariance * (now.freedom - 1));
    const double log_p = maths::log_f_tail(gain / (left / (now.freedom - 1)), 1, now.freedom - 1);
    if (log_p < best.log_p) best = {machine, log_p};
  }
  return best;
}

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
  const VectorXd y = model.values();
  const double share = options.false_alarms / (2 * static_cast<double>(quantities));
  std::vector<std::string> own;
  MatrixXd x = model.columns(true, own);
  Solved now = solve(x, y);
  // Were all but two let go their own way, nobody would be left to be common.
  while (own.size() + 2 < drift.machines) {
    const Clearest next = clearest_own(model, x, now, own);
    if (next.machine.empty() || next.log_p > std::log(share / static_cast<double>(drift.machines))) break;
    own.push_back(next.machine);
    x = model.columns(true, own);
    now = solve(x, y);
  }
  drift.scatter = std::sqrt(now.sum / now.freedom);
  const Solved still = solve(model.columns(false, own), y);
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
    const Index at = x.cols() - static_cast<Index>(own.size() - k);
    const VectorXd unit = VectorXd::Unit(x.cols(), at);
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

}  // namespace vernier::fleet
