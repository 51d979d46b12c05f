// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/timebase/time_base.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>

#include "tools/format/readings.h"
#include "tools/maths/factors.h"
#include "tools/timebase/revisit.h"

namespace vernier::timebase {
namespace {

using Index = Eigen::Index;

// One run: its rows in order, and their residuals, rows x kinds, um; NaN where not measured.
struct RecordSeries {
  std::size_t run = 0;
  std::vector<std::size_t> rows;
  Eigen::MatrixXd residual_um;
};

std::vector<RecordSeries> rows_by_run(const model::Measurement& m) {
  std::vector<RecordSeries> runs(m.states.run_names.size());
  for (std::size_t row = 0; row < m.rows(); ++row) runs[m.states.run[row]].rows.push_back(row);
  for (std::size_t k = 0; k < runs.size(); ++k) runs[k].run = k;
  std::erase_if(runs, [](const RecordSeries& run) { return run.rows.empty(); });
  return runs;
}

// Returns the kinds of lengths that nearly every row of the run has, of those rows that have any.
Eigen::MatrixXd usual_kinds(const Eigen::MatrixXd& all) {
  constexpr double kUsual = 0.95;  // of all steps of a clock: the rest are pauses
  std::vector<Index> keep;
  const auto rows = static_cast<double>((all.array().isFinite().rowwise().any()).count());
  for (Index c = 0; c < all.cols(); ++c) {
    const auto present = static_cast<double>(all.col(c).array().isFinite().count());
    if (present > 0 && present >= kUsual * rows) keep.push_back(c);
  }
  return all(Eigen::all, keep);
}

std::vector<RecordSeries> series_of(const model::Measurement& m, const Eigen::VectorXd& residual,
                                    bool with_check) {
  std::vector<RecordSeries> runs = rows_by_run(m);
  Eigen::MatrixXd table = Eigen::MatrixXd::Constant(
      static_cast<Index>(m.rows()), static_cast<Index>(format::kReadingKindCount), std::nan(""));
  for (std::size_t i = 0; i < m.observations.size(); ++i) {
    const model::Observation& o = m.observations[i];
    if (!model::is_rotation(o.kind) && (with_check || !m.check[o.row]))
      table(static_cast<Index>(o.row), static_cast<Index>(o.kind)) =
          maths::kUmPerMm * residual[static_cast<Index>(i)];
  }
  for (RecordSeries& run : runs) {
    Eigen::MatrixXd mine(static_cast<Index>(run.rows.size()), table.cols());
    for (std::size_t i = 0; i < run.rows.size(); ++i)
      mine.row(static_cast<Index>(i)) = table.row(static_cast<Index>(run.rows[i]));
    run.residual_um = usual_kinds(mine);
  }
  std::erase_if(runs, [](const RecordSeries& run) { return run.residual_um.cols() == 0; });
  return runs;
}

TimeBlock block_of(const RecordSeries& run, const RepeatBlock& b) {
  return {run.run,
          run.rows[b.first],
          run.rows[b.last],
          b.lag,
          b.implied_lag,
          b.correlation,
          b.implied_correlation,
          b.difference,
          b.implied_difference,
          b.p_value};
}

// Probability of the strongest shifted level.
double chance_of_shift(const std::vector<RepeatBlock>& blocks, const RepeatOptions& options) {
  double best = 1;
  for (const RepeatLevel& level : repeat_levels(blocks, options)) {
    if (std::abs(level.shift) > options.tolerance) best = std::min(best, level.p_value);
  }
  return best;
}

struct Revisits {
  double chance = 1;
  std::vector<RepeatBlock> blocks;
};

// Passes over the same poses within one run.
Revisits examine_run(const model::Measurement& m, const RecordSeries& run, const RepeatOptions& options) {
  Revisits revisits;
  const Eigen::VectorXd implied = revisit_lags(path_points(m, run.rows));
  revisits.blocks = compare_repeats(run.residual_um, implied, options);
  revisits.chance = chance_of_shift(revisits.blocks, options);
  return revisits;
}

void add_gaps(const RecordSeries& run, const Revisits& revisits, const RepeatOptions& options,
              TimeBaseFinding& finding) {
  for (const LagJump& jump : lag_jumps(run.residual_um, revisits.blocks, options)) {
    const std::size_t row = std::min(jump.missing_before(), run.rows.size() - 1);
    finding.gaps.push_back({run.run, run.rows[row], jump.row_uncertainty, jump.missing(), jump.uncertainty});
  }
}

// The axes' own scale must be the same for both runs of a pair.
std::optional<TimeRunMatch> examine_pair(const model::Measurement& m, const RecordSeries& a,
                                         const RecordSeries& b) {
  if (a.residual_um.cols() != b.residual_um.cols() || !a.residual_um.allFinite() ||
      !b.residual_um.allFinite())
    return std::nullopt;
  std::vector<std::size_t> both = a.rows;
  both.insert(both.end(), b.rows.begin(), b.rows.end());
  const Eigen::MatrixXd points = path_points(m, both);
  const auto implied = map_paths(points.topRows(static_cast<Index>(a.rows.size())),
                                 points.bottomRows(static_cast<Index>(b.rows.size())));
  if (!implied) return std::nullopt;
  const auto match = match_runs(a.residual_um, b.residual_um, *implied);
  if (!match) return std::nullopt;
  return TimeRunMatch{a.run, b.run, *match};
}

void examine_pairs(const model::Measurement& m, const std::vector<RecordSeries>& runs,
                   const TimeBaseOptions& options, TimeBaseFinding& finding) {
  for (std::size_t i = 0; i < runs.size(); ++i) {
    for (std::size_t k = i + 1; k < runs.size() && finding.matches.size() < options.most_pairs; ++k) {
      if (const auto match = examine_pair(m, runs[i], runs[k])) finding.matches.push_back(*match);
    }
  }
}

std::string sentence_of_run(const model::Measurement& m, const RecordSeries& run, const Revisits& revisits,
                            const RepeatOptions& options) {
  const RepeatBlock* best = nullptr;
  for (const std::size_t i : trusted_blocks(revisits.blocks, options)) {
    const RepeatBlock& b = revisits.blocks[i];
    if (std::abs(b.lag - b.implied_lag) > options.tolerance && (!best || b.correlation > best->correlation))
      best = &b;
  }
  if (!best) return {};
  return fmt::format(
      "In run {} the residual repeats {:.1f} samples later (correlation {:.3f}, difference {:.1f} um), but "
      "the positions repeat {:.1f} samples later (correlation {:.2f}, difference {:.1f} um).",
      m.states.run_names[run.run], best->lag, best->correlation, best->difference, best->implied_lag,
      best->implied_correlation, best->implied_difference);
}

std::string sentence_of_match(const model::Measurement& m, const TimeRunMatch& pair) {
  return fmt::format(
      "The residuals of runs {} and {} agree sample by sample at the rate {:.3f} (correlation {:.2f}), but "
      "the positions imply the rate {:.3f} (correlation {:.2f}): the two assignments of samples differ by up "
      "to {:.0f} samples.",
      m.states.run_names[pair.first_run], m.states.run_names[pair.second_run], std::abs(pair.match.best.rate),
      pair.match.correlation, std::abs(pair.match.implied.rate), pair.match.implied_correlation,
      pair.match.shift);
}

// Number of tests; one if there was none.
double looks(std::size_t count) { return static_cast<double>(std::max<std::size_t>(1, count)); }

// Fisher's combined probability of two independent ones.
double joint(double p, double q) {
  constexpr double kSmallest = 1e-300;  // whose logarithm is finite
  const double product = std::max(p * q, kSmallest);
  return product * (1 - std::log(product));
}

// Combines the strongest of the run matches and of the closures, each corrected for the number of
// tests. An end that is similar to the start is short. It supports a match and is no proof alone.
void join_chances(TimeBaseFinding& finding, double revisits) {
  double match = 1, closure = 1;
  for (const TimeRunMatch& pair : finding.matches) match = std::min(match, pair.match.p_value);
  for (const TimeClosure& run : finding.closures) closure = std::min(closure, run.closure.p_value);
  match = std::min(1.0, match * looks(finding.matches.size()));
  closure = std::min(1.0, closure * looks(finding.closures.size()));
  constexpr double kWays = 3;  // that were tested
  finding.p_value = std::min(1.0, kWays * std::min({revisits, match, joint(match, closure)}));
}

// Evidence is reported only if it is improbable by itself, even if it does not reach the limit of
// the finding.
constexpr double kWorthTelling = 0.02;

void tell(const model::Measurement& m, TimeBaseFinding& finding) {
  const auto add = [&](const std::string& sentence) {
    finding.why += (finding.why.empty() ? "" : " ") + sentence;
  };
  for (const TimeRunMatch& pair : finding.matches) {
    if (pair.match.p_value < kWorthTelling) add(sentence_of_match(m, pair));
  }
  for (const TimeClosure& run : finding.closures) {
    if (run.closure.p_value >= kWorthTelling) continue;
    add(fmt::format(
        "The last {} samples of run {} repeat its first samples (correlation {:.2f}; at all other lags at "
        "most {:.2f}), before the path closes.",
        run.closure.rows, m.states.run_names[run.run], run.closure.correlation, run.closure.elsewhere));
  }
  for (const TimeGap& gap : finding.gaps) {
    add(fmt::format(
        "In run {} {:.1f} +- {:.1f} samples are missing before row {} (+- {:.0f}), or the other pass waited "
        "there.",
        m.states.run_names[gap.run], gap.missing, gap.uncertainty, gap.row, gap.row_uncertainty));
  }
  add("Positions and readings were recorded at different times: samples are missing, or the positions were "
      "computed with a wrong clock.");
}

void conclude(const model::Measurement& m, const TimeBaseOptions& options, TimeBaseFinding& finding) {
  finding.found = finding.p_value < options.significance;
  if (finding.found) return tell(m, finding);
  finding.gaps.clear();
  finding.why =
      finding.blocks.empty() && finding.matches.empty() && finding.closures.empty()
          ? "No path contains a pose twice in a comparable motion, so the time base cannot be tested."
          : "All repetitions of the residual agree with the repetitions of the positions.";
}

}  // namespace

TimeBaseFinding examine_time_base(const model::Measurement& measurement, const Eigen::VectorXd& residual,
                                  const TimeBaseOptions& options) {
  TimeBaseFinding finding;
  RepeatOptions repeats;
  const std::vector<RecordSeries> runs = series_of(measurement, residual, options.with_check_rows);
  double revisits = 1;
  std::size_t compared = 0;
  for (const RecordSeries& run : runs) {
    const Revisits mine = examine_run(measurement, run, repeats);
    for (const RepeatBlock& block : mine.blocks) finding.blocks.push_back(block_of(run, block));
    compared += mine.blocks.empty() ? 0 : 1;
    revisits = std::min(revisits, mine.chance);
    if (mine.chance < options.significance) {
      finding.why += (finding.why.empty() ? "" : " ") + sentence_of_run(measurement, run, mine, repeats);
      add_gaps(run, mine, repeats, finding);
    }
    if (const auto closure = examine_closure(path_points(measurement, run.rows), run.residual_um))
      finding.closures.push_back({run.run, *closure});
  }
  examine_pairs(measurement, runs, options, finding);
  join_chances(finding, std::min(1.0, revisits * looks(compared)));
  conclude(measurement, options, finding);
  return finding;
}

}  // namespace vernier::timebase
