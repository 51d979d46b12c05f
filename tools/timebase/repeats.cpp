// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/timebase/repeats.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <optional>

#include "tools/maths/chance.h"
#include "tools/timebase/stretch.h"

namespace vernier::timebase {
namespace {

using Block = Eigen::MatrixXd;
using Index = Eigen::Index;

double rms(const Block& values) {
  return std::sqrt(values.squaredNorm() / static_cast<double>(values.size()));
}

// Concordance of a block at the lags lowest, lowest + 1, ...; NaN if there is nothing to compare
// with.
struct LagScan {
  Index lowest = 0;
  std::vector<double> concordance;

  double at(Index lag) const {
    const Index k = lag - lowest;
    const bool inside = k >= 0 && k < static_cast<Index>(concordance.size());
    return inside ? concordance[static_cast<std::size_t>(k)] : std::nan("");
  }
};

LagScan scan_lags(const Eigen::MatrixXd& series, Index first, const Block& a, double implied, double search) {
  LagScan scan;
  constexpr double kLeastWidth = 12;  // rows: six times the tolerance of a lag
  const double width = std::max(kLeastWidth, search * std::abs(implied));
  scan.lowest = std::max<Index>(a.rows() / 2, static_cast<Index>(std::floor(implied - width)));
  for (Index lag = scan.lowest; static_cast<double>(lag) <= implied + width; ++lag) {
    const auto b = stretch(series, first + lag, a.rows());
    scan.concordance.push_back(b ? concordance(a, *b) : std::nan(""));
  }
  return scan;
}

// Vertex of the parabola through the best lag and its neighbours.
double refine(const LagScan& scan, Index best) {
  const double l = scan.at(best - 1), m = scan.at(best), r = scan.at(best + 1);
  const double bend = l - 2 * m + r;
  if (!(bend < 0)) return static_cast<double>(best);
  return static_cast<double>(best) + std::clamp(0.5 * (l - r) / bend, -0.5, 0.5);
}

std::optional<Index> best_of(const LagScan& scan, double from, double to) {
  std::optional<Index> best;
  for (std::size_t k = 0; k < scan.concordance.size(); ++k) {
    const Index lag = scan.lowest + static_cast<Index>(k);
    if (static_cast<double>(lag) < from || static_cast<double>(lag) > to || std::isnan(scan.concordance[k]))
      continue;
    if (!best || scan.concordance[k] > scan.at(*best)) best = lag;
  }
  return best;
}

std::optional<RepeatBlock> compare_block(const Eigen::MatrixXd& series, Index first, Index rows,
                                         double implied, const RepeatOptions& options) {
  const auto a = stretch(series, first, rows);
  if (!a) return std::nullopt;
  const LagScan scan = scan_lags(series, first, *a, implied, options.search);
  const auto best =
      best_of(scan, -std::numeric_limits<double>::infinity(), std::numeric_limits<double>::infinity());
  const auto near = best_of(scan, implied - options.tolerance, implied + options.tolerance);
  if (!best || !near) return std::nullopt;
  const Block there = *stretch(series, first + *best, rows), expected = *stretch(series, first + *near, rows);
  RepeatBlock block;
  block.first = static_cast<std::size_t>(first);
  block.last = static_cast<std::size_t>(first + rows - 1);
  block.lag = refine(scan, *best);
  block.implied_lag = implied;
  block.correlation = scan.at(*best);
  block.implied_correlation = scan.at(*near);
  block.difference = rms(*a - there);
  block.implied_difference = rms(*a - expected);
  const Block left = *a - there;
  const double independent = effective_rows(*a, there);
  // Number of tested lags that are not neighbours.
  const double tried = std::max(
      1.0, static_cast<double>(scan.concordance.size()) * independent / static_cast<double>(a->size()));
  block.p_agreement = chance_of_agreement(block.correlation, independent);
  block.p_at_lag = std::max(block.p_agreement, chance_of_ratio(block.implied_difference, block.difference,
                                                               effective_rows(left, left)));
  block.tried = tried;
  block.p_value = std::min(1.0, tried * block.p_at_lag);
  return block;
}

Index rows_of_block(double implied, const RepeatOptions& options) {
  if (options.block > 0) return static_cast<Index>(options.block);
  // A pass has sixteen blocks, so that the place of a jump is visible. A block has rows enough for a
  // correlation (60 independent rows: its uncertainty is 0.13), and not more than are needed for it.
  constexpr double kBlocks = 16, kFewest = 60, kMost = 400;
  return static_cast<Index>(std::clamp(implied / kBlocks, kFewest, kMost));
}

bool agree(const RepeatBlock& a, const RepeatBlock& b, const RepeatOptions& options) {
  return std::abs((a.lag - a.implied_lag) - (b.lag - b.implied_lag)) <= options.tolerance;
}

// Sum of squared differences of single rows at a lag, less its mean over the stretch.
Eigen::VectorXd squares_at(const Eigen::MatrixXd& series, Index first, Index rows, double lag) {
  const Index whole = static_cast<Index>(std::lround(lag));
  const Eigen::MatrixXd difference = series.middleRows(first, rows) - series.middleRows(first + whole, rows);
  const Eigen::RowVectorXd mean = difference.colwise().mean();
  return (difference.rowwise() - mean).rowwise().squaredNorm();
}

// Finds the row at which a change from one lag to the other gives the smallest residual, and the
// range that fits nearly as well.
void place_jump(const Eigen::MatrixXd& series, const RepeatBlock& a, const RepeatBlock& b, LagJump& jump) {
  const auto first = static_cast<Index>(a.first);
  const auto end = std::min<Index>(static_cast<Index>(b.last) + 1,
                                   series.rows() - static_cast<Index>(std::max(jump.before, jump.after) + 1));
  const Index rows = end - first;
  const Eigen::VectorXd at_before = squares_at(series, first, rows, jump.before);
  const Eigen::VectorXd at_after = squares_at(series, first, rows, jump.after);
  const Index skipped = jump.in_later_pass() ? static_cast<Index>(std::lround(jump.missing())) : 0;
  if (rows <= skipped) return;
  double cost = at_after.tail(rows - skipped).sum();
  std::vector<double> costs = {cost};
  for (Index i = 0; i + skipped < rows; ++i) costs.push_back(cost += at_before[i] - at_after[i + skipped]);
  const auto least = std::min_element(costs.begin(), costs.end());
  jump.row = a.first + static_cast<std::size_t>(least - costs.begin());
  // Twice the usual chi^2 step of 4 in units of the residual variance at the best row. kRounding: of sums in
  // double precision, if the repeats agree exactly.
  constexpr double kStep = 8, kRounding = 1e-12;
  const double limit = *least * (1 + kStep / static_cast<double>(rows)) + kRounding * at_before.sum();
  const auto within = [&](double value) { return value <= limit; };
  const auto from = std::find_if(costs.begin(), costs.end(), within);
  const auto to = std::find_if(costs.rbegin(), costs.rend(), within).base();
  jump.row_uncertainty = std::max(1.0, static_cast<double>(to - from) / 2);
}

}  // namespace

std::vector<RepeatBlock> compare_repeats(const Eigen::MatrixXd& series, const Eigen::VectorXd& implied_lag,
                                         const RepeatOptions& options) {
  std::vector<RepeatBlock> blocks;
  Index first = 0;
  while (first < series.rows()) {
    if (!std::isfinite(implied_lag[first])) {
      ++first;
      continue;
    }
    const Index rows = rows_of_block(implied_lag[first], options);
    if (first + rows > series.rows()) break;
    const Eigen::ArrayXd implied = implied_lag.segment(first, rows).array();
    // At another speed the second pass does not repeat row by row.
    if (implied.allFinite() && implied.maxCoeff() - implied.minCoeff() <= options.tolerance) {
      if (auto block = compare_block(series, first, rows, implied.mean(), options)) blocks.push_back(*block);
    }
    first += rows;
  }
  return blocks;
}

std::vector<std::size_t> trusted_blocks(const std::vector<RepeatBlock>& blocks,
                                        const RepeatOptions& options) {
  // Blocks that agree by chance seldom agree closely, or with their neighbour on the lag.
  constexpr double kAgreement = 0.7;
  std::vector<std::size_t> trusted;
  const auto good = [&](std::size_t i) { return blocks[i].correlation >= kAgreement; };
  for (std::size_t i = 0; i < blocks.size(); ++i) {
    const bool left = i > 0 && good(i - 1) && agree(blocks[i], blocks[i - 1], options);
    const bool right = i + 1 < blocks.size() && good(i + 1) && agree(blocks[i], blocks[i + 1], options);
    if (good(i) && (left || right)) trusted.push_back(i);
  }
  return trusted;
}

namespace {

// Stouffer's combined probability of the blocks of a level, times the number of choices.
double joint_chance(const std::vector<RepeatBlock>& all, const RepeatLevel& level,
                    double RepeatBlock::*chance) {
  double z = 0, tried = 1;
  for (const std::size_t i : level.blocks) {
    const double p = all[i].*chance;
    constexpr double kSmallest = 1e-300;  // whose logarithm is finite
    z += p < 0.5 ? maths::upper_quantile(std::max(p, kSmallest)) : 0;
    tried = std::max(tried, all[i].tried);
  }
  const auto n = static_cast<double>(level.blocks.size()), count = static_cast<double>(all.size());
  return n > 1 ? std::min(1.0, maths::upper_tail(z / std::sqrt(n)) * tried * count * count / 2) : 1;
}

void finish(const std::vector<RepeatBlock>& all, RepeatLevel& level) {
  const auto n = static_cast<double>(level.blocks.size());
  double squares = 0;
  for (const std::size_t i : level.blocks) {
    level.lag += all[i].lag / n;
    level.shift += (all[i].lag - all[i].implied_lag) / n;
  }
  for (const std::size_t i : level.blocks) squares += std::pow(all[i].lag - level.lag, 2);
  constexpr double kLeast = 0.1;  // rows: the vertex of a parabola through three lags is not better
  level.uncertainty = n > 1 ? std::max(std::sqrt(squares / (n - 1) / n), kLeast) : 1;
  level.p_agreement = joint_chance(all, level, &RepeatBlock::p_agreement);
  level.p_value = joint_chance(all, level, &RepeatBlock::p_at_lag);
}

}  // namespace

std::vector<RepeatLevel> repeat_levels(const std::vector<RepeatBlock>& blocks, const RepeatOptions& options) {
  std::vector<RepeatLevel> levels;
  for (const std::size_t i : trusted_blocks(blocks, options)) {
    const bool same = !levels.empty() && agree(blocks[levels.back().blocks.back()], blocks[i], options);
    if (!same) levels.emplace_back();
    levels.back().blocks.push_back(i);
  }
  for (auto& level : levels) finish(blocks, level);
  return levels;
}

std::vector<LagJump> lag_jumps(const Eigen::MatrixXd& series, const std::vector<RepeatBlock>& blocks,
                               const RepeatOptions& options) {
  std::vector<LagJump> jumps;
  const auto levels = repeat_levels(blocks, options);
  for (std::size_t k = 1; k < levels.size(); ++k) {
    LagJump jump;
    jump.before = levels[k - 1].lag;
    jump.after = levels[k].lag;
    jump.uncertainty = std::hypot(levels[k - 1].uncertainty, levels[k].uncertainty);
    if (jump.missing() <= options.tolerance) continue;
    place_jump(series, blocks[levels[k - 1].blocks.back()], blocks[levels[k].blocks.front()], jump);
    jumps.push_back(jump);
  }
  return jumps;
}

}  // namespace vernier::timebase
