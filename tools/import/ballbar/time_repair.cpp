// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/import/ballbar/time_repair.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "tools/import/ballbar/profile.h"
#include "tools/timebase/stretch.h"

namespace vernier::importer {
namespace {

using Index = Eigen::Index;

Eigen::MatrixXd readings_um(const BallbarRun& run) {
  Eigen::MatrixXd series(static_cast<Index>(run.reading_mm.size()), 1);
  for (std::size_t i = 0; i < run.reading_mm.size(); ++i)
    series(static_cast<Index>(i), 0) = 1000 * run.reading_mm[i];
  return series;
}

// Properties of a run before its angle is anchored.
struct Found {
  std::vector<timebase::RepeatBlock> blocks;
  std::vector<timebase::LagJump> jumps;
  double turn = 0, turn_uncertainty = 0;
  std::vector<double> sample;  // numbers if no sample had been lost
  std::size_t feed_in = 0, feed_out = 0;
};

// The two passes may differ in feed by the effect of a wrong START and END.
timebase::RepeatOptions repeat_options() {
  timebase::RepeatOptions options;
  options.search = 0.2;
  return options;
}

// The longest lag that a significant level has: gaps only make a lag shorter.
bool find_turn(const std::vector<timebase::RepeatLevel>& levels, Found& found) {
  constexpr double kSignificance = 1e-3;  // of the agreement: one chance in a thousand
  bool significant = false;
  for (const timebase::RepeatLevel& level : levels) {
    significant = significant || level.p_agreement < kSignificance;
    if (level.lag <= found.turn) continue;
    found.turn = level.lag;
    found.turn_uncertainty = level.uncertainty;
  }
  return significant;
}

void number_samples(std::size_t count, Found& found) {
  found.sample.resize(count);
  double lost = 0;
  std::size_t next = 0;
  std::vector<std::pair<std::size_t, double>> gaps;
  for (const timebase::LagJump& jump : found.jumps) gaps.emplace_back(jump.missing_before(), jump.missing());
  std::sort(gaps.begin(), gaps.end());
  for (std::size_t i = 0; i < count; ++i) {
    while (next < gaps.size() && gaps[next].first <= i) lost += gaps[next++].second;
    found.sample[i] = static_cast<double>(i) + lost;
  }
}

// Reading at a sample number, NaN outside the record and in its gaps.
double at_sample(const Eigen::MatrixXd& series, const std::vector<double>& sample, double number) {
  const auto after = std::lower_bound(sample.begin(), sample.end(), number);
  if (after == sample.end() || (after == sample.begin() && *after > number)) return std::nan("");
  const auto k = static_cast<Index>(after - sample.begin());
  if (k == 0) return series(0, 0);
  const double step = sample[static_cast<std::size_t>(k)] - sample[static_cast<std::size_t>(k) - 1];
  if (step > 1.5) return std::nan("");
  const double part = (*after - number) / step;
  return series(k, 0) * (1 - part) + series(k - 1, 0) * part;
}

// The record and its later pass on one list of sample numbers.
struct PairOfPasses {
  Eigen::MatrixXd first, second;  // NaN if one has no reading
};

PairOfPasses pair_passes(const Eigen::MatrixXd& series, const std::vector<double>& sample, double turn) {
  PairOfPasses pair;
  Index rows = 0;
  while (rows < series.rows() && sample[static_cast<std::size_t>(rows)] + turn <= sample.back()) ++rows;
  pair.first = series.topRows(rows);
  pair.second.resize(rows, 1);
  for (Index i = 0; i < rows; ++i)
    pair.second(i, 0) = at_sample(series, sample, sample[static_cast<std::size_t>(i)] + turn);
  return pair;
}

PassAgreement agreement(const PairOfPasses& pair, Index from, Index block) {
  PassAgreement result;
  double squares = 0, level = 0, sum = 0, count = 0;
  for (Index i = from; i + block <= pair.first.rows(); i += block) {
    const auto a = timebase::stretch(pair.first, i, block), b = timebase::stretch(pair.second, i, block);
    if (!a || !b) continue;
    squares += (*a - *b).squaredNorm();
    level += (pair.first.middleRows(i, block) - pair.second.middleRows(i, block)).squaredNorm();
    sum += timebase::concordance(*a, *b);
    count += 1;
    result.samples += static_cast<std::size_t>(block);
  }
  if (count == 0) return result;
  const auto n = static_cast<double>(result.samples);
  result.difference_um = std::sqrt(squares / n);
  result.level_um = std::sqrt(level / n);
  result.correlation = sum / count;
  return result;
}

// Blocks at the beginning whose level the second pass does not repeat: the machine was still feeding in. The
// limit is derived from the better quarter of the blocks.
std::size_t feed_in(const PairOfPasses& pair, Index block) {
  std::vector<double> difference;
  for (Index i = 0; i + block <= pair.first.rows(); i += block) {
    const auto part = (pair.first.middleRows(i, block) - pair.second.middleRows(i, block)).eval();
    difference.push_back(part.allFinite() ? std::sqrt(part.squaredNorm() / static_cast<double>(block)) : 0);
  }
  if (difference.size() < 4) return 0;
  std::vector<double> sorted = difference;
  std::sort(sorted.begin(), sorted.end());
  const double limit = 4 * sorted[sorted.size() / 4];
  std::size_t leading = 0;
  while (leading < difference.size() && difference[leading] > limit) ++leading;
  return leading * static_cast<std::size_t>(block);
}

constexpr Index kBlock = 50;  // samples, for the agreement of passes

std::optional<Found> examine(const BallbarRun& run, RunRepair& repair) {
  repair.label = run.label;
  repair.turn_before = 360 / (run.last_deg - run.first_deg) * static_cast<double>(run.end - run.start + 1);
  repair.turn_after = repair.turn_before;
  const Eigen::MatrixXd series = readings_um(run);
  if (static_cast<double>(series.rows()) < 1.5 * repair.turn_before) {
    repair.why_not = "the record has less than one and a half turns, so no part of it repeats";
    return std::nullopt;
  }
  const Eigen::VectorXd implied = Eigen::VectorXd::Constant(series.rows(), repair.turn_before);
  Found found;
  found.blocks = timebase::compare_repeats(series, implied, repeat_options());
  if (!find_turn(timebase::repeat_levels(found.blocks, repeat_options()), found)) {
    repair.why_not = "the second pass does not repeat the first at any lag";
    return std::nullopt;
  }
  found.jumps = timebase::lag_jumps(series, found.blocks, repeat_options());
  number_samples(run.reading_mm.size(), found);
  const PairOfPasses pair = pair_passes(series, found.sample, found.turn);
  found.feed_in = feed_in(pair, kBlock);
  std::vector<double> plain(run.reading_mm.size());
  for (std::size_t i = 0; i < plain.size(); ++i) plain[i] = static_cast<double>(i);
  const auto from = static_cast<Index>(found.feed_in);
  repair.before = agreement(pair_passes(series, plain, repair.turn_before), from, kBlock);
  repair.after = agreement(pair, from, kBlock);
  return found;
}

void report(const Found& found, RunRepair& repair) {
  repair.repaired = true;
  repair.turn_after = found.turn;
  repair.turn_uncertainty = found.turn_uncertainty;
  repair.feed_in = found.feed_in;
  repair.feed_out = found.feed_out;
  for (const timebase::LagJump& jump : found.jumps)
    repair.gaps.push_back({jump.missing_before(), jump.row_uncertainty, jump.missing(), jump.uncertainty});
}

// Angles from the sample numbers; START keeps the angle that it has, half a sample after angle 0.
RunClock clock_of(const BallbarRun& run, const Found& found) {
  RunClock clock;
  clock.sample = found.sample;
  clock.turn_samples = found.turn;
  for (std::size_t i = 0; i < found.sample.size(); ++i) {
    clock.turned_deg.push_back((found.sample[i] - found.sample[run.start] + 0.5) * 360 / found.turn);
    clock.on_circle.push_back(i >= found.feed_in && i + found.feed_out < found.sample.size() ? 1 : 0);
  }
  return clock;
}

// The first whole turn on the circle is the analysed one.
void choose_turn(BallbarRun& run) {
  const RunClock& clock = *run.clock;
  run.start = static_cast<std::size_t>(std::find(clock.on_circle.begin(), clock.on_circle.end(), 1) -
                                       clock.on_circle.begin());
  run.end = run.start;
  while (run.end + 1 < clock.turned_deg.size() &&
         clock.turned_deg[run.end + 1] < clock.turned_deg[run.start] + 360)
    ++run.end;
}

// Turns the angles of a run so that its repeating error agrees with the reference's.
void anchor(const BallbarRun& reference, BallbarRun& run, RunRepair& repair) {
  const auto shift = profile_shift(angle_profile(reference), angle_profile(run));
  constexpr double kLeast = 0.5;  // correlation of two profiles of one circle
  repair.start_correlation = shift.correlation;
  if (shift.correlation < kLeast) return;
  // A profile runs from +A towards +B for both directions.
  for (double& turned : run.clock->turned_deg) turned -= run.direction * shift.deg;
  repair.start_shift_deg = -shift.deg;
  repair.start_uncertainty_deg = shift.uncertainty_deg;
  repair.start_from = reference.label;
}

}  // namespace

TimeRepair repair_time_base(const BallbarFile& file) {
  TimeRepair repair{file, std::vector<RunRepair>(file.runs.size())};
  std::optional<std::size_t> reference;
  const auto wrong = [&](std::size_t k) {
    return std::abs(repair.runs[k].turn_after / repair.runs[k].turn_before - 1);
  };
  for (std::size_t k = 0; k < file.runs.size(); ++k) {
    const auto found = examine(file.runs[k], repair.runs[k]);
    if (!found) continue;
    report(*found, repair.runs[k]);
    repair.file.runs[k].clock = clock_of(file.runs[k], *found);
    if (!reference || wrong(k) < wrong(*reference)) reference = k;
  }
  for (std::size_t k = 0; k < file.runs.size(); ++k) {
    BallbarRun& run = repair.file.runs[k];
    if (!run.clock) continue;
    if (k != *reference) anchor(repair.file.runs[*reference], run, repair.runs[k]);
    choose_turn(run);
  }
  return repair;
}

}  // namespace vernier::importer
