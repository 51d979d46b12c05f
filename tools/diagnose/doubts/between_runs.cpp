// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/diagnose/doubts/between_runs.h"

#include <algorithm>
#include <map>
#include <optional>

#include "tools/diagnose/doubts/shape.h"

namespace vernier::diagnose {
namespace {

/// The columns of the effect if its inputs and the time never changed, separately for each run. No columns if
/// the rows have one run. `width`: number of columns of one run.
Eigen::MatrixXd one_size_for_each_run(const Evidence& evidence, const effects::Candidate& candidate,
                                      const std::vector<double>& scanned, Eigen::Index& width) {
  model::States constant = evidence.measurement().states;
  for (std::size_t k = 0; k < constant.input.size(); ++k)
    constant.input[k].setConstant(evidence.reference_of(k) + 1);  // where an effect of this input is not 0
  constant.time.setConstant(evidence.time_range().high);
  const Eigen::MatrixXd all = ColumnMaker(evidence).raw_at(candidate, scanned, constant);
  std::map<std::size_t, std::vector<Eigen::Index>> runs;
  for (std::size_t i = 0; i < evidence.rows().size(); ++i)
    runs[constant.run[evidence.rows()[i]]].push_back(static_cast<Eigen::Index>(i));
  if (runs.size() < 2) return {};
  width = all.cols();
  Eigen::MatrixXd columns =
      Eigen::MatrixXd::Zero(all.rows(), all.cols() * static_cast<Eigen::Index>(runs.size()));
  Eigen::Index at = 0;
  for (const auto& [run, readings] : runs) {
    for (const Eigen::Index reading : readings)
      columns.row(reading).segment(at, all.cols()) = all.row(reading);
    at += all.cols();
  }
  return columns;
}

/// The largest decrease of the BIC by one step from a run on, alone or beside a constant size. `of_runs`:
/// whitened columns of each run, `width` columns a run.
double decrease_by_step(const Evidence& evidence, const Eigen::MatrixXd& of_runs, Eigen::Index width,
                        const Eigen::MatrixXd& beside) {
  double best = 0;
  const auto of_run = [&](Eigen::Index run) { return of_runs.middleCols(run * width, width); };
  const Eigen::Index runs = of_runs.cols() / width;
  // The columns from a run on, and those of all runs.
  Eigen::MatrixXd both = Eigen::MatrixXd::Zero(of_runs.rows(), 2 * width);
  for (Eigen::Index run = 0; run < runs; ++run) both.rightCols(width) += of_run(run);
  for (Eigen::Index first = runs - 1; first > 0; --first) {
    both.leftCols(width) += of_run(first);
    // The run of the step is one of a few: its choice costs less than a reading.
    best = std::max({best, bic_decrease(evidence, both.leftCols(width), beside, 0),
                     bic_decrease(evidence, both, beside, 0)});
  }
  return best;
}

/// An effect that an input or the time drives, as it is compared with a change between the runs.
struct Compared {
  Eigen::MatrixXd of_runs;  // whitened columns of the change, `width` columns a run
  Eigen::Index width = 0;
  Eigen::MatrixXd beside;  // columns of the other effects
  double least = 0;        // decrease of the BIC from which a change explains the readings as well
};

std::optional<Compared> compared(const Evidence& evidence, const Pool& pool,
                                 const std::vector<std::size_t>& items, std::size_t position,
                                 double distance) {
  const std::size_t item = items[position];
  const auto in_time = [&](std::size_t one) {
    return pool.candidate(one).choice.runs.empty() &&
           change_in_time(drivers_of(evidence.machine(), pool.candidate(one)));
  };
  if (!in_time(item)) return std::nullopt;
  const effects::Candidate& candidate = pool.candidate(item);
  Compared change;
  Eigen::MatrixXd& of_runs = change.of_runs;
  of_runs = one_size_for_each_run(evidence, candidate, pool[item].scored.scanned, change.width);
  if (of_runs.cols() == 0 || !of_runs.allFinite() || !(of_runs.norm() > 0)) return std::nullopt;
  evidence.whiten(of_runs);
  std::vector<std::size_t> others;
  Eigen::MatrixXd named(of_runs.rows(), 0);
  std::size_t scanned = 0;
  for (const std::size_t one : items) {
    const auto& place = pool.candidate(one).choice.place;
    const bool alike = one == item || (in_time(one) && place && candidate.choice.place &&
                                       moves_alike(evidence, *place, *candidate.choice.place));
    if (!alike) {
      others.push_back(one);
      continue;
    }
    const Eigen::MatrixXd columns = evidence.columns(pool.candidate(one), pool[one].scored.scanned);
    named.conservativeResize(Eigen::NoChange, named.cols() + columns.cols());
    named.rightCols(columns.cols()) = columns;
    scanned += pool[one].scored.scanned.size();
  }
  change.beside = pool.columns(others);
  change.least = bic_decrease(evidence, named, change.beside, scanned) - distance;
  return change;
}

}  // namespace

bool sizes_of_runs_explain(const Evidence& evidence, const Pool& pool, const std::vector<std::size_t>& items,
                           std::size_t position, double distance) {
  const auto change = compared(evidence, pool, items, position, distance);
  return change && bic_decrease(evidence, change->of_runs, change->beside, 0) > change->least;
}

bool step_between_runs_explains(const Evidence& evidence, const Pool& pool,
                                const std::vector<std::size_t>& items, std::size_t position,
                                double distance) {
  // A recorded heat or load can step as the machine did. The number of visits steps with each run anyway.
  if (pool.candidate(items[position]).choice.inputs.empty()) return false;
  const auto change = compared(evidence, pool, items, position, distance);
  return change && decrease_by_step(evidence, change->of_runs, change->width, change->beside) > change->least;
}

}  // namespace vernier::diagnose
