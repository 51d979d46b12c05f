// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/diagnose/propose/scan.h"

#include <algorithm>
#include <cmath>
#include <future>
#include <map>
#include <thread>
#include <utility>

#include "tools/maths/golden.h"

namespace vernier::diagnose {
namespace {

/// Columns that are projected together: one product of matrices instead of many of vectors.
constexpr Eigen::Index kBatch = 192;
/// Returns 1/value of the neighbours of a tested value.
std::pair<double, double> neighbours(const ScannedCandidate& item, std::size_t unknown, double value) {
  if (item.fine.holds(value)) return {1 / value - item.fine.step, 1 / value + item.fine.step};
  const std::vector<double>& grid = item.grid[unknown];
  const auto at = static_cast<std::size_t>(std::lower_bound(grid.begin(), grid.end(), value) - grid.begin());
  return {1 / grid[std::min(at + 1, grid.size() - 1)], 1 / grid[at > 0 ? at - 1 : 0]};
}

}  // namespace

std::vector<std::vector<double>> grid_points(const std::vector<std::vector<double>>& lists) {
  std::vector<std::vector<double>> points(1);
  for (const std::vector<double>& list : lists) {
    std::vector<std::vector<double>> next;
    for (const auto& point : points)
      for (const double value : list) {
        next.push_back(point);
        next.back().push_back(value);
      }
    points = std::move(next);
  }
  return points;
}

Scanner::Scanner(const Evidence& evidence, const std::vector<ScannedCandidate>& candidates)
    : evidence_(evidence), thresholds_(evidence.thresholds().pool), candidates_(candidates) {}

namespace {

/// Is a column only rounding relative to the others of its candidate? An example is the sine of a
/// wave of two even steps.
bool vanishes(const Eigen::RowVectorXd& norms, Eigen::Index column) {
  constexpr double kRounding = 1e-9;  // of the longest column of its candidate
  return norms[column] <= kRounding * norms.maxCoeff();
}

}  // namespace

bool Scanner::score(const ProjectedPoint& point, const Eigen::MatrixXd& beside,
                    const Eigen::VectorXd& residual, Scored& scored) const {
  const ScannedCandidate& item = candidates_[scored.candidate];
  scored.own_share = 1;
  Eigen::MatrixXd own = point.columns;
  if (beside.cols() > 0) own -= beside * (beside.transpose() * own);
  Eigen::Index vanished = 0;
  for (Eigen::Index j = 0; j < own.cols(); ++j) {
    if (own.cols() > 1 && vanishes(point.norms, j)) {
      own.col(j).setZero();
      ++vanished;
      continue;
    }
    const double before = point.norms[j], after = own.col(j).norm();
    if (!(before > 0) || !std::isfinite(after) || after < thresholds_.least_own * before) {
      if (!item.may_lose_columns) return false;
      own.col(j).setZero();
      continue;
    }
    scored.own_share = std::min(scored.own_share, after / before);
  }
  std::vector<std::size_t> kept;
  const Eigen::MatrixXd basis = maths::orthonormal(own, thresholds_.least_independent, &kept);
  if (basis.cols() == 0) return false;
  if (!item.may_lose_columns && basis.cols() < own.cols() - vanished) return false;
  scored.gain = (basis.transpose() * residual).squaredNorm();
  scored.unknowns = basis.cols() + static_cast<Eigen::Index>(item.grid.size());
  return true;
}

Eigen::VectorXd Scanner::residual_beside(const Eigen::MatrixXd& beside) const {
  Eigen::VectorXd residual = evidence_.residual();
  if (beside.cols() > 0) residual -= beside * (beside.transpose() * residual);
  return residual;
}

ProjectedPoint Scanner::projected_at(ColumnMaker& maker, std::size_t candidate,
                                     const std::vector<double>& scanned) const {
  const Eigen::MatrixXd& q = evidence_.absorbed();
  const Eigen::MatrixXd raw = maker.columns(candidates_[candidate].candidate, scanned);
  return {scanned, raw - q * (q.transpose() * raw), raw.colwise().norm()};
}

double Scanner::gain_at(ColumnMaker& maker, const Scored& scored, const std::vector<double>& scanned,
                        const Eigen::MatrixXd& beside, const Eigen::VectorXd& residual) const {
  Scored trial = scored;
  return score(projected_at(maker, scored.candidate, scanned), beside, residual, trial) ? trial.gain : 0.0;
}

/// The candidates that one thread scans.
class Scanner::Part {
 public:
  Part(const Scanner& scanner, ProjectedColumns& kept, const Eigen::MatrixXd& beside,
       const Eigen::VectorXd& residual, std::vector<Scored>& best)
      : scanner_(scanner),
        kept_(kept),
        beside_(beside),
        residual_(residual),
        best_(best),
        maker_(scanner.evidence_) {}

  void scan(std::size_t candidate) {
    if (const std::vector<ProjectedPoint>* points = kept_.points(candidate)) {
      for (const ProjectedPoint& point : *points) take(candidate, point);
      return;
    }
    for (std::vector<double>& scanned : grid_points(scanner_.candidates_[candidate].grid)) {
      Eigen::MatrixXd columns = maker_.columns(scanner_.candidates_[candidate].candidate, scanned);
      width_ += columns.cols();
      raw_.push_back({candidate, {std::move(scanned), std::move(columns), {}}});
      if (width_ >= kBatch) project();
    }
  }
  /// Scores what is left.
  void end() {
    project();
    keep();
  }

 private:
  struct Raw {
    std::size_t candidate;
    ProjectedPoint point;
  };

  void take(std::size_t candidate, const ProjectedPoint& point) {
    Scored scored{candidate, point.scanned, 0, 0, 0};
    if (!scanner_.score(point, beside_, residual_, scored)) return;
    Scored& so_far = best_[candidate];
    if (so_far.unknowns == 0 || scored.gain > so_far.gain) so_far = std::move(scored);
  }

  void project() {
    if (raw_.empty()) return;
    Eigen::MatrixXd batch(residual_.size(), width_);
    Eigen::Index at = 0;
    for (const Raw& raw : raw_) {
      batch.middleCols(at, raw.point.columns.cols()) = raw.point.columns;
      at += raw.point.columns.cols();
    }
    const Eigen::RowVectorXd norms = batch.colwise().norm();
    const Eigen::MatrixXd& q = scanner_.evidence_.absorbed();
    const Eigen::MatrixXd part = q.transpose() * batch;
    batch.noalias() -= q * part;
    at = 0;
    for (Raw& raw : raw_) {
      const Eigen::Index count = raw.point.columns.cols();
      raw.point.columns = batch.middleCols(at, count);
      raw.point.norms = norms.segment(at, count);
      at += count;
      take(raw.candidate, raw.point);
      if (raw.candidate != made_of_) keep();
      made_of_ = raw.candidate;
      numbers_ += raw.point.columns.size();
      if (kept_.has_room(numbers_))
        made_.push_back(std::move(raw.point));
      else
        made_.clear();  // and stays so: the candidate is made anew each time
    }
    raw_.clear();
    width_ = 0;
  }

  void keep() {
    kept_.keep(made_of_, std::move(made_));
    made_.clear();
    numbers_ = 0;
  }

  const Scanner& scanner_;
  ProjectedColumns& kept_;
  const Eigen::MatrixXd& beside_;
  const Eigen::VectorXd& residual_;
  std::vector<Scored>& best_;
  ColumnMaker maker_;
  std::vector<Raw> raw_;
  Eigen::Index width_ = 0, numbers_ = 0;
  std::size_t made_of_ = 0;
  std::vector<ProjectedPoint> made_;  // of that candidate
};

std::vector<Scored> Scanner::scan(const Eigen::MatrixXd& beside, const std::function<void(double)>& progress,
                                  std::size_t first_candidate) {
  const Eigen::VectorXd residual = residual_beside(beside);
  kept_.renew(evidence_, candidates_.size());
  std::vector<Scored> best(candidates_.size());
  // Each thread writes the entries of its own candidates only.
  const std::size_t threads = std::max(1U, std::min(4U, std::thread::hardware_concurrency()));
  const auto scan_every = [&](std::size_t first, const std::function<void(double)>& tell) {
    Part part(*this, kept_, beside, residual, best);
    for (std::size_t c = first; c < candidates_.size(); c += threads) {
      part.scan(c);
      if (tell) tell(static_cast<double>(c) / static_cast<double>(candidates_.size()));
    }
    part.end();
  };
  std::vector<std::future<void>> others;  // each passes on the exception of its part
  for (std::size_t k = 1; k < threads; ++k)
    others.push_back(std::async(std::launch::async, [&, k] { scan_every(first_candidate + k, {}); }));
  scan_every(first_candidate, progress);
  for (std::future<void>& part : others) part.get();
  std::vector<Scored> seen;
  for (Scored& scored : best)
    if (scored.unknowns > 0) seen.push_back(std::move(scored));
  return seen;
}

double Scanner::alike_within(double left) const {
  const double spread = left / std::max(1.0, evidence_.freedom());
  return evidence_.thresholds().fine.told_apart * (evidence_.noise_known() ? std::max(1.0, spread) : spread);
}

Scored Scanner::best_period(std::size_t candidate, const std::vector<double>& periods,
                            const Eigen::MatrixXd& beside, const Eigen::VectorXd& residual) const {
  std::vector<Scored> seen;
  double most = 0;
  ColumnMaker maker(evidence_);
  for (const double period : periods) {
    Scored scored{candidate, {period}, 0, 0, 0};
    if (!score(projected_at(maker, candidate, scored.scanned), beside, residual, scored)) continue;
    most = std::max(most, scored.gain);
    seen.push_back(std::move(scored));
  }
  const double near = most - alike_within(residual.squaredNorm() - most);
  Scored best;
  for (Scored& scored : seen)
    if (scored.gain >= near && (best.unknowns == 0 || scored.scanned[0] > best.scanned[0])) best = scored;
  return best;
}

std::vector<Scored> Scanner::scan_fine(const Eigen::MatrixXd& beside, std::size_t first_candidate) {
  const Eigen::VectorXd residual = residual_beside(beside);
  kept_.renew(evidence_, candidates_.size());
  std::map<std::size_t, std::vector<std::size_t>> of_axis;
  for (std::size_t c = first_candidate; c < candidates_.size(); ++c)
    if (candidates_[c].fine.any()) of_axis[candidates_[c].fine.axis].push_back(c);
  std::vector<Scored> found;
  for (const auto& [axis, list] : of_axis) {
    std::vector<const FinePeriods*> fine;
    for (const std::size_t c : list) fine.push_back(&candidates_[c].fine);
    const std::vector<std::vector<double>> periods =
        promising_periods(evidence_, fine, beside, residual, &kept_, list);
    for (std::size_t i = 0; i < list.size(); ++i) {
      Scored best = best_period(list[i], periods[i], beside, residual);
      if (best.unknowns > 0) found.push_back(std::move(best));
    }
  }
  return found;
}

void Scanner::refine(Scored& scored, const Eigen::MatrixXd& beside) const {
  const ScannedCandidate& item = candidates_[scored.candidate];
  if (item.grid.empty()) return;
  const Eigen::VectorXd residual = residual_beside(beside);
  ColumnMaker maker(evidence_);
  for (std::size_t i = 0; i < item.grid.size(); ++i) {
    // In 1/value between the neighbours: phases of a period change evenly there.
    const auto [low, high] = neighbours(item, i, scored.scanned[i]);
    constexpr int kSections = 14;  // of a golden search: to a thousandth of the grid's step
    std::vector<double> point = scored.scanned;
    const maths::Peak best = maths::golden_peak(
        [&](double inverse) {
          point[i] = 1 / inverse;
          return gain_at(maker, scored, point, beside, residual);
        },
        low, high, kSections);
    if (best.value > scored.gain) {
      scored.gain = best.value;
      scored.scanned[i] = 1 / best.at;
    }
  }
}

std::vector<double> Scanner::possible_aliases(const Scored& scored, double own, double most, double mine,
                                              const Eigen::MatrixXd& beside,
                                              const Eigen::VectorXd& residual) const {
  const effects::Candidate& candidate = candidates_[scored.candidate].candidate;
  const std::size_t axis = *candidate.choice.axis;
  const Evidence::Range range = evidence_.range_of(axis);
  const double length = range.high - range.low;
  std::vector<double> possible;
  for (const double shift : alias_frequencies(evidence_, axis, most + own))
    for (const double middle : {shift - own, shift + own}) possible.push_back(std::abs(middle));
  // At few positions a wave can be like another one that is no alias of it by their window alone.
  constexpr double kPerRange = 5;  // tested frequencies for each that the range distinguishes
  const double step = 1 / (kPerRange * length), first = 0.5 / length;
  const auto count = static_cast<Eigen::Index>((most - first) / step) + 1;
  const FinePeriods both{axis, 2 * first, most, step, length, {}};
  const WaveOfAxis wave{axis, carrier_of(evidence_, candidate, both)};
  if (wave.carrier.size() == 0 || !is_affordable(evidence_, count, beside)) return possible;
  constexpr double kKept = 0.8;  // least share of a peak's height at the nearest tested frequency
  const Eigen::VectorXd gains = wave_gains(evidence_, wave, first, step, count, beside, residual);
  for (Eigen::Index k = 1; k + 1 < count; ++k)
    if (gains[k] > kKept * mine && gains[k] >= gains[k - 1] && gains[k] > gains[k + 1])
      possible.push_back(first + static_cast<double>(k) * step);
  return possible;
}

std::vector<double> Scanner::aliases(const Scored& scored, const Eigen::MatrixXd& beside) const {
  const effects::Candidate& candidate = candidates_[scored.candidate].candidate;
  std::size_t scanned = 0;
  for (const effects::CandidateUnknown& unknown : candidate.unknowns) {
    if (unknown.kind == effects::UnknownKind::kPeriod) ++scanned;
    if (unknown.kind != effects::UnknownKind::kPeriod && unknown.kind != effects::UnknownKind::kLinear)
      return {};
  }
  if (scanned != 1 || scored.scanned.size() != 1 || !candidate.choice.axis) return {};
  const std::size_t axis = *candidate.choice.axis;
  const Evidence::Range range = evidence_.range_of(axis);
  const double length = range.high - range.low, own = 1 / scored.scanned[0];
  const FinePeriodThresholds& limits = evidence_.thresholds().fine;
  const double most = limits.most_periods / length;

  const Eigen::VectorXd residual = residual_beside(beside);
  ColumnMaker maker(evidence_);
  const auto gain_of = [&](double frequency) {
    return gain_at(maker, scored, {1 / frequency}, beside, residual);
  };
  const double mine = gain_of(own), left = residual.squaredNorm() - mine;
  const double near = mine - alike_within(left);
  const auto known = [&](const std::vector<double>& list, double frequency) {
    return std::any_of(list.begin(), list.end(),
                       [&](double other) { return std::abs(other - frequency) * length < 0.5; });
  };
  std::vector<double> frequencies = {own};
  for (const double frequency : possible_aliases(scored, own, most, mine, beside, residual)) {
    if (frequency > most || frequency * length < 0.5 || known(frequencies, frequency)) continue;
    constexpr int kSections = 10;  // of a golden search
    const double width = 0.25 / length;
    // The centre itself is exact if positions are even to the last digit.
    const double there = gain_of(frequency);
    if (there < mine / 2) continue;
    const maths::Peak best = maths::golden_peak(gain_of, frequency - width, frequency + width, kSections);
    if (std::max(there, best.value) >= near) frequencies.push_back(there >= best.value ? frequency : best.at);
  }
  std::vector<double> periods;
  for (std::size_t i = 1; i < frequencies.size(); ++i) periods.push_back(1 / frequencies[i]);
  std::sort(periods.begin(), periods.end(), std::greater<>());
  return periods;
}

Eigen::MatrixXd Scanner::projected(const Scored& scored, std::vector<std::size_t>* kept) const {
  ColumnMaker maker(evidence_);
  const auto [at, own, norms] = projected_at(maker, scored.candidate, scored.scanned);
  std::vector<std::size_t> chosen;
  Eigen::MatrixXd usable = own;
  for (Eigen::Index j = 0; j < own.cols(); ++j)
    if (own.col(j).norm() < thresholds_.least_own * norms[j] || (own.cols() > 1 && vanishes(norms, j)))
      usable.col(j).setZero();
  maths::orthonormal(usable, thresholds_.least_independent, &chosen);
  Eigen::MatrixXd result(own.rows(), static_cast<Eigen::Index>(chosen.size()));
  for (std::size_t j = 0; j < chosen.size(); ++j)
    result.col(static_cast<Eigen::Index>(j)) = own.col(static_cast<Eigen::Index>(chosen[j]));
  if (kept != nullptr) *kept = chosen;
  return result;
}

}  // namespace vernier::diagnose
