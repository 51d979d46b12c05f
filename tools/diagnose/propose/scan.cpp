// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/diagnose/propose/scan.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <memory>
#include <mutex>
#include <set>
#include <utility>

#include "tools/maths/golden.h"
#include "tools/maths/threads.h"

namespace vernier::diagnose {
namespace {

/// Columns that are projected together: one product of matrices instead of many of vectors.
constexpr Eigen::Index kBatch = 192;
/// Accepted columns that depend on each other to this share are one column.
constexpr double kIndependent = 1e-6;

/// Returns 1/value of the neighbours of a tested value.
std::pair<double, double> neighbours(const ScannedCandidate& item, std::size_t unknown, double value) {
  if (item.fine.holds(value)) return {1 / value - item.fine.step, 1 / value + item.fine.step};
  const std::vector<double>& grid = item.grid[unknown];
  const auto at = static_cast<std::size_t>(std::lower_bound(grid.begin(), grid.end(), value) - grid.begin());
  return {1 / grid[std::min(at + 1, grid.size() - 1)], 1 / grid[at > 0 ? at - 1 : 0]};
}

}  // namespace

Scanner::Scanner(const Evidence& evidence, const std::vector<ScannedCandidate>& candidates)
    : evidence_(evidence),
      thresholds_(evidence.thresholds().pool),
      candidates_(candidates),
      families_(candidates),
      by_rows_(evidence) {}

namespace {

/// Is a column only rounding relative to the others of its candidate? An example is the sine of a
/// wave of two even steps.
bool vanishes(const Eigen::RowVectorXd& norms, Eigen::Index column) {
  constexpr double kRounding = 1e-9;  // of the longest column of its candidate
  return norms[column] <= kRounding * norms.maxCoeff();
}

}  // namespace

AcceptedColumns::AcceptedColumns(const Eigen::MatrixXd& all) {
  std::vector<std::size_t> kept;
  basis = maths::orthonormal(all, kIndependent, &kept);
  columns = all(Eigen::all, kept);
}

ScanTarget Scanner::target(const Eigen::MatrixXd& beside) const {
  ScanTarget target{Eigen::MatrixXd(evidence_.residual().size(), beside.cols() + 1), evidence_.residual()};
  if (beside.cols() > 0) {
    target.residual -= beside * (beside.transpose() * target.residual);
    target.directions.leftCols(beside.cols()) = beside;
  }
  target.directions.rightCols(1) = target.residual;
  return target;
}

bool Scanner::score(const ProjectedBatch& batch, std::size_t at, const Eigen::MatrixXd& products,
                    Scored& scored) const {
  const GridPoint& point = batch.points[at];
  const ScannedCandidate& item = candidates_[point.candidate];
  const Eigen::Index accepted = products.rows() - 1, count = point.count;
  const auto along = products.block(0, point.first, accepted, count);
  const auto of_residual = products.row(accepted).segment(point.first, count);
  const auto norms = batch.norms.segment(point.first, count);
  const Eigen::MatrixXd own = batch.grams[at] - along.transpose() * along;

  scored.own_share = 1;
  Eigen::Index vanished = 0;
  std::vector<Eigen::Index> usable;
  for (Eigen::Index j = 0; j < count; ++j) {
    if (count > 1 && vanishes(norms, j)) {
      ++vanished;
      continue;
    }
    const double before = norms[j], after = std::sqrt(std::max(0.0, own(j, j)));
    if (!(before > 0) || !std::isfinite(own(j, j)) || after < thresholds_.least_own * before) {
      if (!item.may_lose_columns) return false;
      continue;
    }
    scored.own_share = std::min(scored.own_share, after / before);
    usable.push_back(j);
  }
  // Cholesky factor of the usable columns, in their order. A column that repeats the columns before it is
  // left out. The same steps give the scalar products of the residual with the orthonormal columns.
  const double least = thresholds_.least_independent * thresholds_.least_independent;
  Eigen::MatrixXd factor(count, count);
  std::vector<Eigen::Index> kept;
  scored.gain = 0;
  Eigen::VectorXd share(count);
  for (const Eigen::Index j : usable) {
    const auto rank = static_cast<Eigen::Index>(kept.size());
    double pivot = own(j, j), rest = of_residual[j];
    for (Eigen::Index k = 0; k < rank; ++k) {
      double value = own(j, kept[static_cast<std::size_t>(k)]);
      for (Eigen::Index i = 0; i < k; ++i) value -= factor(rank, i) * factor(k, i);
      value /= factor(k, k);
      factor(rank, k) = value;
      pivot -= value * value;
      rest -= value * share[k];
    }
    if (!(pivot >= least * own(j, j)) || !(pivot > 0)) continue;
    factor(rank, rank) = std::sqrt(pivot);
    share[rank] = rest / factor(rank, rank);
    scored.gain += share[rank] * share[rank];
    kept.push_back(j);
  }
  const auto rank = static_cast<Eigen::Index>(kept.size());
  if (rank == 0 || (!item.may_lose_columns && rank < count - vanished)) return false;
  scored.unknowns = rank + static_cast<Eigen::Index>(item.grid.size());
  return true;
}

ProjectedBatch Scanner::projected_at(ColumnMaker& maker, std::size_t candidate,
                                     const std::vector<double>& scanned) const {
  Eigen::MatrixXd raw = maker.columns(candidates_[candidate].candidate, scanned);
  const Eigen::Index count = raw.cols();
  return project(evidence_, {{candidate, scanned, 0, count}}, std::move(raw));
}

Scored Scanner::score_at(ColumnMaker& maker, std::size_t candidate, const std::vector<double>& scanned,
                         const ScanTarget& target) const {
  const ProjectedBatch batch = projected_at(maker, candidate, scanned);
  Scored scored{candidate, scanned, 0, 0, 0};
  return score(batch, 0, target.directions.transpose() * batch.columns, scored) ? scored : Scored{};
}

/// The candidates that one thread scans.
class Scanner::Part {
 public:
  /// `room`: numbers that the thread may keep.
  Part(Scanner& scanner, Eigen::Index room, const ScanTarget& target, std::vector<Scored>& best)
      : scanner_(scanner), room_(room), target_(target), best_(best), maker_(scanner.evidence_) {}

  /// Scans a batch. `products`: scalar products of the target's directions with the columns of the batch.
  void scan(const ProjectedBatch& batch, const Eigen::MatrixXd& products) {
    for (std::size_t i = 0; i < batch.points.size(); ++i) {
      const GridPoint& point = batch.points[i];
      Scored scored{point.candidate, point.scanned, 0, 0, 0};
      if (!scanner_.score(batch, i, products, scored)) continue;
      Scored& so_far = best_[point.candidate];
      if (so_far.unknowns == 0 || scored.gain > so_far.gain) so_far = std::move(scored);
    }
  }
  /// Computes the columns of candidates of one family. They are scanned with the next ones, in one batch.
  void scan(std::size_t family, const std::vector<std::size_t>& candidates) {
    if (candidates.empty()) return;
    const std::shared_ptr<const RowFunctions> functions = scanner_.families_.functions(family, maker_);
    for (const std::size_t candidate : candidates) add(candidate, *functions);
  }
  /// Scans candidates of one family by the rows. `combine`: as of Sources.
  void scan_by_rows(std::size_t family, const std::vector<std::size_t>& candidates,
                    const Eigen::MatrixXd& combine) {
    ByRows& by_rows = scanner_.by_rows_;
    const auto is_complete = [&](std::size_t candidate) { return by_rows.is_complete(candidate); };
    if (!std::all_of(candidates.begin(), candidates.end(), is_complete)) {
      const std::shared_ptr<const RowFunctions> functions = scanner_.families_.functions(family, maker_);
      for (const std::size_t candidate : candidates)
        by_rows.complete(candidate, scanner_.candidates_[candidate].candidate, *functions);
    }
    for (const std::size_t candidate : candidates)
      scan(by_rows.batch(candidate), combine * by_rows.products(candidate));
  }
  /// Scans what is left, and returns the batches for the next scans.
  std::vector<ProjectedBatch> end() {
    end_batch();
    return std::move(made_);
  }

 private:
  void add(std::size_t candidate, const RowFunctions& functions) {
    Eigen::MatrixXd raw =
        scanner_.evidence_.at_observations(scanner_.candidates_[candidate].candidate, functions.of_term);
    scanner_.evidence_.whiten(raw);
    for (std::size_t i = 0; i < functions.points.size(); ++i) {
      points_.push_back({candidate, functions.points[i], width_, functions.unknowns});
      width_ += functions.unknowns;
    }
    raw_.push_back(std::move(raw));
    if (width_ >= kBatch) end_batch();
  }
  void end_batch() {
    if (points_.empty()) return;
    ProjectedBatch batch =
        project(scanner_.evidence_, std::move(points_), maths::side_by_side(target_.residual.size(), raw_));
    scan(batch, target_.directions.transpose() * batch.columns);
    if (batch.columns.size() <= room_) {
      room_ -= batch.columns.size();
      made_.push_back(std::move(batch));
    }
    raw_.clear();
    points_.clear();
    width_ = 0;
  }

  Scanner& scanner_;
  Eigen::Index room_;
  const ScanTarget& target_;
  std::vector<Scored>& best_;
  ColumnMaker maker_;
  std::vector<Eigen::MatrixXd> raw_;
  std::vector<GridPoint> points_;
  Eigen::Index width_ = 0;
  std::vector<ProjectedBatch> made_;
};

/// The directions of a target as linear combinations of columns that stay the same from scan to scan: the
/// accepted columns, and the residual of the evidence.
struct Scanner::Sources {
  Eigen::MatrixXd columns;
  Eigen::MatrixXd combine;  // directions^T = combine * columns^T
};

Scanner::Sources Scanner::sources(const AcceptedColumns& accepted) const {
  const Eigen::MatrixXd& beside = accepted.basis;
  const Eigen::Index count = beside.cols();
  Sources sources{Eigen::MatrixXd(evidence_.residual().size(), count + 1),
                  Eigen::MatrixXd::Zero(count + 1, count + 1)};
  sources.columns.rightCols(1) = evidence_.residual();
  sources.combine(count, count) = 1;
  if (count == 0) return sources;
  sources.columns.leftCols(count) = accepted.columns;
  // columns = beside * upper, so beside^T = upper^-T * columns^T.
  const Eigen::MatrixXd upper = beside.transpose() * accepted.columns;
  const Eigen::MatrixXd inverse =
      upper.triangularView<Eigen::Upper>().transpose().solve(Eigen::MatrixXd::Identity(count, count));
  sources.combine.topLeftCorner(count, count) = inverse;
  sources.combine.block(count, 0, 1, count) =
      -(beside.transpose() * evidence_.residual()).transpose() * inverse;
  return sources;
}

bool Scanner::scans_by_rows() const {
  return evidence_.observations_are_independent() ||
         !ProjectedColumns::have_room(evidence_.residual().size() *
                                      static_cast<Eigen::Index>(candidates_.size()));
}

std::vector<std::size_t> Scanner::prepare(const Sources& sources, std::size_t first_candidate) {
  families_.extend();
  if (!scans_by_rows()) {
    kept_.renew(evidence_, candidates_.size());
    return kept_.products().prepare(sources.columns, kept_.batches().size());
  }
  std::set<std::size_t> places;
  for (std::size_t c = first_candidate; c < candidates_.size(); ++c)
    for (const effects::CandidateTerm& term : candidates_[c].candidate.terms)
      places.insert(evidence_.index_of(term.place));
  by_rows_.prepare({places.begin(), places.end()}, sources.columns, candidates_.size());
  return {};
}

std::vector<Scored> Scanner::scan(const AcceptedColumns& accepted,
                                  const std::function<void(double)>& progress, std::size_t first_candidate) {
  const ScanTarget target = this->target(accepted.basis);
  const Sources sources = this->sources(accepted);
  const std::vector<std::size_t> prepared = prepare(sources, first_candidate);
  const bool by_rows = scans_by_rows();
  std::vector<Scored> best(candidates_.size());
  // Each thread writes the entries of its own candidates only.
  std::mutex mutex;
  std::map<std::size_t, std::vector<ProjectedBatch>> made;  // by thread
  maths::in_threads([&](std::size_t thread, std::size_t threads) {
    Part part(*this, kept_.room() / static_cast<Eigen::Index>(threads), target, best);
    for (std::size_t i = thread; !by_rows && i < kept_.batches().size(); i += threads) {
      const ProjectedBatch& batch = kept_.batches()[i];
      if (batch.points.back().candidate < first_candidate) continue;
      part.scan(batch, sources.combine * kept_.products_of(prepared, i));
    }
    for (std::size_t family = thread; family < families_.size(); family += threads) {
      std::vector<std::size_t> members;
      for (const std::size_t c : families_.members(family))
        if (c >= first_candidate && (by_rows || !kept_.holds(c))) members.push_back(c);
      if (by_rows)
        part.scan_by_rows(family, members, sources.combine);
      else
        part.scan(family, members);
      if (thread == 0 && progress)
        progress(static_cast<double>(family) / static_cast<double>(families_.size()));
    }
    std::vector<ProjectedBatch> batches = part.end();
    const std::lock_guard<std::mutex> lock(mutex);
    made[thread] = std::move(batches);
  });
  for (auto& [thread, batches] : made)
    for (ProjectedBatch& batch : batches) kept_.keep(std::move(batch));
  std::vector<Scored> seen;
  for (std::size_t c = first_candidate; c < best.size(); ++c)
    if (best[c].unknowns > 0) seen.push_back(std::move(best[c]));
  return seen;
}

double Scanner::alike_within(double left) const {
  const double spread = left / std::max(1.0, evidence_.freedom());
  return evidence_.thresholds().fine.told_apart * (evidence_.noise_known() ? std::max(1.0, spread) : spread);
}

Scored Scanner::best_period(std::size_t candidate, const std::vector<double>& periods,
                            const ScanTarget& target) const {
  std::vector<Scored> seen;
  double most = 0;
  ColumnMaker maker(evidence_);
  for (const double period : periods) {
    Scored scored = score_at(maker, candidate, {period}, target);
    if (scored.unknowns == 0) continue;
    most = std::max(most, scored.gain);
    seen.push_back(std::move(scored));
  }
  const double near = most - alike_within(target.residual.squaredNorm() - most);
  Scored best;
  for (Scored& scored : seen)
    if (scored.gain >= near && (best.unknowns == 0 || scored.scanned[0] > best.scanned[0])) best = scored;
  return best;
}

std::vector<Scored> Scanner::scan_fine(const Eigen::MatrixXd& beside, std::size_t first_candidate) {
  const ScanTarget target = this->target(beside);
  kept_.renew(evidence_, candidates_.size());
  std::map<std::size_t, std::vector<std::size_t>> of_axis;
  for (std::size_t c = first_candidate; c < candidates_.size(); ++c)
    if (candidates_[c].fine.any()) of_axis[candidates_[c].fine.axis].push_back(c);
  std::vector<Scored> found;
  for (const auto& [axis, list] : of_axis) {
    std::vector<const FinePeriods*> fine;
    for (const std::size_t c : list) fine.push_back(&candidates_[c].fine);
    const std::vector<std::vector<double>> periods =
        promising_periods(evidence_, fine, beside, target.residual, &kept_, list);
    for (std::size_t i = 0; i < list.size(); ++i) {
      Scored best = best_period(list[i], periods[i], target);
      if (best.unknowns > 0) found.push_back(std::move(best));
    }
  }
  return found;
}

void Scanner::refine(Scored& scored, const Eigen::MatrixXd& beside) const {
  const ScannedCandidate& item = candidates_[scored.candidate];
  if (item.grid.empty()) return;
  const ScanTarget target = this->target(beside);
  ColumnMaker maker(evidence_);
  for (std::size_t i = 0; i < item.grid.size(); ++i) {
    // In 1/value between the neighbours: phases of a period change evenly there.
    const auto [low, high] = neighbours(item, i, scored.scanned[i]);
    constexpr int kSections = 14;  // of a golden search: to a thousandth of the grid's step
    std::vector<double> point = scored.scanned;
    const maths::Peak best = maths::golden_peak(
        [&](double inverse) {
          point[i] = 1 / inverse;
          return score_at(maker, scored.candidate, point, target).gain;
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
  const double most = evidence_.thresholds().search.fine.most_periods / length;

  const ScanTarget target = this->target(beside);
  ColumnMaker maker(evidence_);
  const auto gain_of = [&](double frequency) {
    return score_at(maker, scored.candidate, {1 / frequency}, target).gain;
  };
  const double mine = gain_of(own), left = target.residual.squaredNorm() - mine;
  const double near = mine - alike_within(left);
  const auto known = [&](const std::vector<double>& list, double frequency) {
    return std::any_of(list.begin(), list.end(),
                       [&](double other) { return std::abs(other - frequency) * length < 0.5; });
  };
  std::vector<double> frequencies = {own};
  for (const double frequency : possible_aliases(scored, own, most, mine, beside, target.residual)) {
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
  const ProjectedBatch batch = projected_at(maker, scored.candidate, scored.scanned);
  const Eigen::MatrixXd& own = batch.columns;
  const Eigen::RowVectorXd& norms = batch.norms;
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
