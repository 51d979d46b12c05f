// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/diagnose/finder.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "tools/diagnose/acceptance.h"
#include "tools/diagnose/between_stations.h"
#include "tools/fit/least_squares/statistics.h"
#include "tools/maths/chance.h"
#include "tools/maths/decompositions.h"
#include "tools/model/chain/chain.h"
#include "tools/model/chain/evaluate.h"

namespace vernier::diagnose {
namespace {

/// Are two noise models the same to within this share of the noise?
bool is_alike(const fit::NoiseModel& a, const fit::NoiseModel& b, double share) {
  const double same = share * std::max(a.total(), b.total());
  return std::abs(a.own - b.own) < same && std::abs(a.pose - b.pose) < same &&
         std::abs(a.run - b.run) < same && std::abs(a.drift - b.drift) < same && a.drifts == b.drifts &&
         a.steps == b.steps;
}

std::vector<fit::NoiseStep> set_ups_in(const fit::NoiseModel& noise) {
  std::vector<fit::NoiseStep> steps = noise.steps;
  std::erase_if(steps, [](const fit::NoiseStep& step) { return !step.of_set_up(); });
  return steps;
}

/// The same except for the independent noise.
bool hangs_alike(fit::NoiseModel a, const fit::NoiseModel& b, double share) {
  const double scale = b.own / a.own;
  a.own = b.own;
  a.pose *= scale;
  a.run *= scale;
  a.drift *= scale;
  return is_alike(a, b, share);
}

}  // namespace

Finder::Finder(const model::Machine& fitted, const model::Measurement& measurement,
               const std::vector<effects::Effect>& effects, std::size_t most_effects,
               std::function<void(double, const std::string&)> progress, const DiagnoseThresholds& thresholds)
    : effects_(effects),
      most_effects_(most_effects),
      progress_(std::move(progress)),
      evidence_(fitted, measurement, thresholds),
      thresholds_(evidence_.thresholds().acceptance),
      list_(enumerate_candidates(evidence_, effects)),
      scanner_(evidence_, list_),
      pool_(evidence_, scanner_) {}

void Finder::find() {
  search();
  share_poses();
  accept();
  // Several thermal effects may be pieces of one response, also if they reach the noise together.
  const std::size_t thermal = fit::has_uncertainty(evidence_.measurement()) ? thermal_items() : 0;
  if (thermal > 1 || (thermal > 0 && !linear_down_to_noise())) {
    search_responses();
    accept();
  }
  if (!linear_down_to_noise()) {
    search_products();
    accept();
  }
  weigh_correlation();
  if (!fit::has_uncertainty(evidence_.measurement())) name_simplest();
  if (!evidence_.noise().independent()) order_by_size();
}

void Finder::find_without(const std::vector<Contradicted>& items) {
  contradicted_.insert(contradicted_.end(), items.begin(), items.end());
  ban_contradicted();
  select_again();
  // A contradicted effect took part of what another one explains, which no scan found beside it.
  search_beside_chosen();
  accept();
  if (!fit::has_uncertainty(evidence_.measurement())) name_simplest();
  if (!evidence_.noise().independent()) order_by_size();
}

void Finder::ban_contradicted() {
  for (const Contradicted& one : contradicted_)
    for (std::size_t other = 0; other < pool_.size(); ++other)
      if (!pool_[other].banned && (other == one.item || pool_.same_columns(one.item, other)))
        pool_.ban(other, one.why);
}

void Finder::order_by_size() {
  std::vector<std::size_t> rest = chosen_;
  chosen_.clear();
  while (!rest.empty()) {
    const auto left_with = [&](std::size_t item) {
      std::vector<std::size_t> set = chosen_;
      set.push_back(item);
      return evidence_.left_in_full(raw_columns(set));
    };
    std::vector<double> left;
    for (const std::size_t item : rest) left.push_back(left_with(item));
    const auto best = std::min_element(left.begin(), left.end()) - left.begin();
    chosen_.push_back(rest[static_cast<std::size_t>(best)]);
    rest.erase(rest.begin() + best);
  }
}

void Finder::name_simplest() {
  const std::vector<std::size_t> found = chosen_;
  const double criterion = criterion_, chi_square = chi_square_;
  simplify(evidence_.thresholds().pool.simple_share);
  if (std::all_of(chosen_.begin(), chosen_.end(),
                  [&](std::size_t item) { return failed_test(item).empty(); }))
    return;
  chosen_ = found;
  criterion_ = criterion;
  chi_square_ = chi_square;
}

void Finder::scan_beside(const std::vector<std::size_t>& items, double from, double to, std::size_t first) {
  const AcceptedColumns accepted(pool_.columns(items));
  std::vector<Scored> scored = scanner_.scan(
      accepted,
      [&](double share) {
        progress_(from + share * (to - from), fmt::format("{} candidates", list_.size()));
      },
      first);
  for (Scored& fine : scanner_.scan_fine(accepted.basis, first)) scored.push_back(std::move(fine));
  pool_.add(scored, accepted.basis);
  ban_contradicted();
}

std::size_t Finder::thermal_items() const {
  return static_cast<std::size_t>(std::count_if(chosen_.begin(), chosen_.end(), [this](std::size_t item) {
    return has_input(item, effects::InputClass::kTemperature);
  }));
}

void Finder::search_responses() {
  std::vector<std::size_t> others;
  for (const std::size_t item : chosen_)
    if (!has_input(item, effects::InputClass::kTemperature)) others.push_back(item);
  const std::size_t first = list_.size();
  for (ScannedCandidate& item :
       enumerate_responses(evidence_, effects_, maths::orthonormal(pool_.columns(others), 1e-6, nullptr)))
    list_.push_back(std::move(item));
  if (list_.size() == first) return;
  scan_beside(others, 0.65, 0.7, first);
  select_again();
}

void Finder::search_products() {
  std::vector<Product> best;
  for (int round = 0; round < 2; ++round) {
    const std::size_t first = list_.size();
    for (ScannedCandidate& item : enumerate_products(evidence_, best)) list_.push_back(std::move(item));
    for (const std::vector<std::size_t>& beside : {std::vector<std::size_t>{}, chosen_}) {
      scan_beside(beside, 0.7, 0.75, first);
      if (chosen_.empty()) break;
    }
    best = best_products();
  }
  ban_hollow_products();
  select_again();
}

void Finder::pose_problem() { problem_ = pool_.problem(entry_item_); }

std::optional<std::size_t> Finder::entry_of(std::size_t item) const {
  const auto entry = std::find(entry_item_.begin(), entry_item_.end(), item);
  if (entry == entry_item_.end()) return std::nullopt;
  return static_cast<std::size_t>(entry - entry_item_.begin());
}

std::vector<Product> Finder::best_products() {
  pose_problem();
  std::vector<std::pair<double, std::size_t>> order;
  for (std::size_t i = 0; i < pool_.size(); ++i)
    if (pool_.is_custom(i) && !pool_[i].banned) order.emplace_back(-score_alone(i), i);
  std::sort(order.begin(), order.end());
  std::vector<Product> best;
  for (std::size_t i = 0; i < std::min(evidence_.thresholds().search.pool.extended, order.size()); ++i) {
    const effects::Choice& choice = pool_.candidate(order[i].second).choice;
    best.push_back({*choice.place, model::parse_expression(choice.term), choice.inputs, choice.units});
  }
  return best;
}

void Finder::select_again() {
  pose_problem();
  std::vector<std::vector<std::size_t>> starts;
  for (const std::vector<std::size_t>& items : starts_) {
    starts.emplace_back();
    for (const std::size_t item : items)
      if (const auto entry = entry_of(item)) starts.back().push_back(*entry);  // none: the item failed a test
  }
  const Selection selection = select(problem_, most_effects_, starts);
  chosen_.clear();
  for (const std::size_t entry : selection.chosen) chosen_.push_back(entry_item_[entry]);
  criterion_ = selection.criterion;
  chi_square_ = selection.chi_square;
  simplify();
  name_usual_pairs();
  join_reversals();
}

void Finder::join_reversals() {
  constexpr double kRounding = 1e-6;  // of the BIC
  for (const std::size_t item : std::vector<std::size_t>(chosen_)) {
    const effects::Choice& choice = pool_.candidate(item).choice;
    if (std::find(chosen_.begin(), chosen_.end(), item) == chosen_.end()) continue;
    if (!choice.axis || !is_of_axis_alone(item, *choice.axis)) continue;
    if (!depends_on(item, model::SymbolKind::kDirection)) continue;
    std::vector<std::size_t> others, curves;
    for (const std::size_t one : chosen_)
      if (!is_of_axis_alone(one, *choice.axis) || pool_.candidate(one).choice.place != choice.place)
        others.push_back(one);
      else if (pool_.is_function_of_an_axis(one))
        curves.push_back(one);
    if (others.size() + 1 >= chosen_.size()) continue;  // no second piece
    std::vector<std::vector<std::size_t>> besides = {{}, curves};
    if (const auto line = most_usual(item, false)) besides.push_back({*line});
    for (const std::size_t one : entry_item_) {
      if (!is_of_axis_alone(one, *choice.axis) || pool_.candidate(one).choice.place != choice.place ||
          !depends_on(one, model::SymbolKind::kSince))
        continue;
      for (const std::vector<std::size_t>& beside : besides) {
        std::vector<std::size_t> set = others;
        set.insert(set.end(), beside.begin(), beside.end());
        set.push_back(one);
        const Selection joined = evaluate(set);
        if (joined.criterion >= criterion_ - kRounding) continue;
        chosen_ = set;
        criterion_ = joined.criterion;
        chi_square_ = joined.chi_square;
      }
    }
  }
}

void Finder::name_usual_pairs() {
  for (const std::size_t item : std::vector<std::size_t>(chosen_)) {
    const effects::Choice& choice = pool_.candidate(item).choice;
    if (!choice.axis || !is_of_axis_alone(item, *choice.axis)) continue;
    const auto drivers = drivers_of(evidence_.machine(), pool_.candidate(item));
    if (!std::any_of(drivers.begin(), drivers.end(), [](const auto& driver) {
          return driver.first == static_cast<int>(model::SymbolKind::kVisit);
        }))
      continue;
    const std::optional<std::size_t> line = most_usual(item, false), reversal = most_usual(item, true);
    if (!line || !reversal) continue;
    const Eigen::MatrixXd usual = maths::orthonormal(pool_.columns({*line, *reversal}), 1e-6, nullptr);
    const Eigen::MatrixXd& own = pool_[item].columns;
    if (own.squaredNorm() - (usual.transpose() * own).squaredNorm() >
        evidence_.thresholds().pool.held_share * own.squaredNorm())
      continue;
    std::vector<std::size_t> set = without(item);
    for (const std::size_t one : {*line, *reversal})
      if (std::find(set.begin(), set.end(), one) == set.end()) set.push_back(one);
    const Selection pair = evaluate(set);
    if (set.size() > most_effects_ || pair.criterion > criterion_ + thresholds_.instrument_distance) continue;
    chosen_ = set;
    criterion_ = pair.criterion;
    chi_square_ = pair.chi_square;
  }
}

void Finder::simplify(double share) {
  const double most_price = 2 * std::log(static_cast<double>(entry_item_.size()));
  for (std::size_t i = 0; i < chosen_.size();) {
    std::optional<std::size_t> simplest;
    Selection best;
    const double apart = evaluate(without(chosen_[i])).chi_square;
    const std::optional<std::size_t> limit = limit_of(chosen_[i]);
    for (const std::size_t other : entry_item_) {
      if (std::find(chosen_.begin(), chosen_.end(), other) != chosen_.end()) continue;
      std::vector<std::size_t> set = chosen_;
      set[i] = other;
      const Selection trial = evaluate(set);
      const bool does_it = apart - trial.chi_square >= share * (apart - chi_square_);
      if (!does_it && trial.criterion - criterion_ >= thresholds_.evidence + most_price) continue;
      if (simplest && trial.criterion >= best.criterion) continue;
      // The same columns from a location further from the axis, or from a term without a name, are
      // only a longer form of the same term.
      const bool named = pool_.is_custom(chosen_[i]) && !pool_.is_custom(other);
      const bool same_but_nearer =
          pool_.same_kind(chosen_[i], other) &&
          (named || pool_.penalty(pool_[other].scored) < pool_.penalty(pool_[chosen_[i]].scored)) &&
          pool_.same_columns(chosen_[i], other);
      if (!same_but_nearer && limit != other && !pool_.contains(chosen_[i], other)) continue;
      // One of many forms that contain it fits better by chance, so it must lower the BIC by more.
      const double price = same_but_nearer ? 0 : 2 * std::log(std::max(1.0, holders_of(other)));
      if (!does_it && trial.criterion - criterion_ >= thresholds_.evidence + price) continue;
      simplest = other;
      best = trial;
    }
    if (!simplest) {
      ++i;
      continue;
    }
    chosen_[i] = *simplest;
    criterion_ = best.criterion;
    chi_square_ = best.chi_square;
    if (share > 1) ++i;  // else it may be simplified further
  }
}

double Finder::holders_of(std::size_t simple) const {
  double count = 0;
  for (const std::size_t other : entry_item_)
    count += pool_.contains(other, simple) || limit_of(other) == simple ? 1 : 0;
  return count;
}

std::optional<std::size_t> Finder::limit_of(std::size_t general) const {
  if (!depends_on(general, model::SymbolKind::kSince)) return std::nullopt;
  return most_usual(general, true);
}

double Finder::evidence_beyond_limit(std::size_t simple, std::size_t general) const {
  if (limit_of(general) != simple) return 0;
  return thresholds_.evidence + 2 * std::log(std::max(1.0, holders_of(simple)));
}

bool Finder::depends_on(std::size_t item, model::SymbolKind kind) const {
  const std::optional<std::size_t>& axis = pool_.candidate(item).choice.axis;
  return axis &&
         drivers_of(evidence_.machine(), pool_.candidate(item)).contains({static_cast<int>(kind), *axis});
}

bool Finder::is_of_axis_alone(std::size_t item, std::size_t axis) const {
  const effects::Candidate& candidate = pool_.candidate(item);
  if (candidate.choice.axis != axis || !candidate.choice.place || candidate.terms.size() != 1) return false;
  const auto drivers = drivers_of(evidence_.machine(), candidate);
  return std::all_of(drivers.begin(), drivers.end(), [](const auto& driver) {
    const auto kind = static_cast<model::SymbolKind>(driver.first);
    return kind == model::SymbolKind::kDirection || kind == model::SymbolKind::kSince ||
           kind == model::SymbolKind::kVisit;
  });
}

std::optional<std::size_t> Finder::most_usual(std::size_t beside, bool of_direction) const {
  const effects::Choice& choice = pool_.candidate(beside).choice;
  std::set<std::pair<int, std::size_t>> wanted;
  if (of_direction) wanted.insert({static_cast<int>(model::SymbolKind::kDirection), *choice.axis});
  std::optional<std::size_t> best;
  for (const std::size_t item : entry_item_) {
    const effects::Candidate& candidate = pool_.candidate(item);
    if (pool_[item].columns.cols() != 1 || !pool_[item].scored.scanned.empty() ||
        candidate.terms.size() != 1 || candidate.choice.axis != choice.axis ||
        candidate.choice.place != choice.place)
      continue;
    if (best && pool_.penalty(pool_[item].scored) >= pool_.penalty(pool_[*best].scored)) continue;
    if (drivers_of(evidence_.machine(), candidate) == wanted) best = item;
  }
  return best;
}

void Finder::search_beside_lines(double from, double to) {
  const std::vector<std::size_t> before = chosen_;
  for (const std::size_t item : before) {
    const effects::Choice& choice = pool_.candidate(item).choice;
    if (!choice.axis || !is_of_axis_alone(item, *choice.axis)) continue;
    const std::optional<std::size_t> line = most_usual(item, false), reversal = most_usual(item, true);
    if (!line || item == line || item == reversal) continue;
    std::vector<std::size_t> set = {*line};
    if (reversal) set.push_back(*reversal);
    for (const std::size_t other : before)
      if (!is_of_axis_alone(other, *choice.axis) ||
          !moves_alike(evidence_, *pool_.candidate(other).choice.place, *choice.place))
        set.push_back(other);
    std::sort(set.begin(), set.end());
    if (set.size() > most_effects_ || std::find(starts_.begin(), starts_.end(), set) != starts_.end())
      continue;
    scan_beside(set, from, to);
    starts_.push_back(std::move(set));
  }
}

void Finder::search() {
  starts_.clear();
  scan_beside({}, 0.05, 0.3);
  select_again();
  search_beside_chosen();
}

void Finder::search_beside_chosen() {
  constexpr int kMostScans = 6;     // of all candidates beside the chosen ones, at most
  constexpr double kSettled = 0.1;  // decrease of the BIC: far below any evidence
  for (int round = 0; round < kMostScans && !chosen_.empty(); ++round) {
    const std::vector<std::size_t> before = chosen_;
    const double criterion = criterion_;
    scan_beside(chosen_, 0.3 + 0.08 * round, 0.34 + 0.08 * round);
    // Alternatives of each accepted item, with the others unchanged.
    if (chosen_.size() > 1)
      for (const std::size_t item : before)
        scan_beside(without(item), 0.34 + 0.08 * round, 0.38 + 0.08 * round);
    search_beside_lines(0.38 + 0.08 * round, 0.38 + 0.08 * round);
    select_again();
    if (criterion_ > criterion - kSettled) break;
  }
}

Eigen::MatrixXd Finder::raw_columns(const std::vector<std::size_t>& items) const {
  std::vector<Eigen::MatrixXd> parts;
  for (const std::size_t item : items)
    parts.push_back(evidence_.raw_columns(pool_.candidate(item), pool_[item].scored.scanned));
  return maths::side_by_side(evidence_.residual().size(), parts);
}

void Finder::search_under(const fit::NoiseModel& noise) {
  evidence_.assume(noise);
  pool_.clear();
  chosen_.clear();
  search();
  accept();
}

double Finder::priced_criterion() const {
  const fit::NoiseModel& used = evidence_.noise();
  // Only the remaining part of the readings' own scale counts (restricted likelihood), as in the
  // selection's criterion.
  const auto readings = static_cast<double>(evidence_.residual().size());
  const double own = 2 * std::log(used.own) * (readings - evidence_.freedom());
  return evidence_.log_determinant() - own + criterion_ + used.price() * std::log(readings);
}

double Finder::settle_noise_from(fit::NoiseModel noise) {
  constexpr int kMostRounds = 4;  // at most
  for (int round = 0; round < kMostRounds; ++round) {
    search_under(noise);
    const fit::NoiseModel next = evidence_.estimate(raw_columns(chosen_), set_ups_in(noise));
    if (is_alike(next, noise, thresholds_.same_noise)) return priced_criterion();
    noise = next;
  }
  return std::numeric_limits<double>::infinity();
}

fit::NoiseModel Finder::noise() const {
  fit::NoiseModel noise = evidence_.noise_of_file();
  if (!noise.independent()) return noise;
  const fit::NoiseModel estimated = evidence_.estimate(raw_columns(chosen_));
  noise.own = estimated.own;
  noise.support = estimated.support;
  return noise;
}

void Finder::share_poses() {
  if (evidence_.poses_are_visits()) return;
  const Eigen::MatrixXd all = maths::orthonormal(pool_.columns(chosen_), 1e-6, nullptr);
  const Eigen::VectorXd left = evidence_.residual() - all * (all.transpose() * evidence_.residual());
  const auto search_with = [this](double share) {
    evidence_.weigh_poses(share);
    pool_.clear();
    chosen_.clear();
    search();
  };
  if (const double share = evidence_.shared_pose_error(left, all); share > 0) return search_with(share);
  if (chosen_.empty()) return;
  // There are few positions with independent errors, and enough effects to fit them all. The named
  // effects are then an alternative to those errors. The better account of the readings is used.
  const double share = evidence_.shared_pose_error(evidence_.residual(),
                                                   Eigen::MatrixXd::Zero(evidence_.residual().size(), 0));
  if (share <= 0) return;
  const double named = priced_criterion();
  search_with(share);
  const double readings = static_cast<double>(evidence_.residual().size());
  if (priced_criterion() + std::log(readings) >= named) search_with(0);
}

void Finder::weigh_correlation() {
  // The instrument is an alternative to every named cause. Correlated errors may be its own drift,
  // or the remainder of an effect. The search runs both from all that a search can explain and
  // from nothing explained. The better result is used.
  const fit::NoiseModel white = evidence_.noise();
  const fit::NoiseModel after_all = evidence_.estimate(raw_columns(chosen_));
  const fit::NoiseModel after_none =
      chosen_.empty() ? after_all : evidence_.estimate(Eigen::MatrixXd(evidence_.residual().size(), 0));
  // A set of effects is valid only together with the noise of its residual.
  const double same = thresholds_.same_noise;
  const bool stands = hangs_alike(after_all, white, same);
  const std::optional<fit::NoiseModel> set_ups = touched_anew(after_all);
  // A drift can absorb an effect that is as slow. Its alternative is the drift beside the other
  // effects only.
  const std::vector<std::size_t> quick = quick_ones();
  const fit::NoiseModel after_quick =
      quick.size() < chosen_.size() ? evidence_.estimate(raw_columns(quick)) : after_all;
  if (stands && !set_ups && hangs_alike(after_none, white, same) && hangs_alike(after_quick, white, same))
    return;
  const Eigen::Index quick_columns = raw_columns(quick).cols();
  double best = stands ? priced_criterion() : std::numeric_limits<double>::infinity();
  fit::NoiseModel kept = white;
  bool is_current = true;  // are search and evidence in the state of `kept`?
  std::vector<fit::NoiseModel> starts = {after_all};
  if (!is_alike(after_none, after_all, same)) starts.push_back(after_none);
  if (!is_alike(after_quick, after_all, same) && !is_alike(after_quick, after_none, same))
    starts.push_back(after_quick);
  if (set_ups) starts.push_back(*set_ups);
  for (const fit::NoiseModel& start : starts) {
    if (hangs_alike(start, white, same)) continue;
    double value = settle_noise_from(start);
    // The instrument is preferred to causes that a drift could absorb. The other causes must stay
    // as they were.
    const bool for_slow_ones = !chosen_.empty() && quick_ones().size() == chosen_.size() &&
                               raw_columns(chosen_).cols() >= quick_columns;
    if (for_slow_ones || (chosen_.empty() && !is_one_offset(start))) value -= thresholds_.instrument_distance;
    is_current = value < best;
    if (!is_current) continue;
    best = value;
    kept = evidence_.noise();
  }
  if (is_current) return;
  search_under(kept);
  if (is_alike(kept, white, same) && !linear_down_to_noise()) {
    search_products();
    accept();
  }
}

std::vector<std::size_t> Finder::quick_ones() const {
  std::vector<std::size_t> quick;
  for (const std::size_t item : chosen_) {
    const Eigen::MatrixXd columns = raw_columns({item});
    double steps = 0, all = 0;
    for (const fit::NoiseSeries& series : evidence_.layout().series) {
      const Eigen::MatrixXd own = columns(series.reading, Eigen::all);
      if (own.rows() < 2) continue;
      const Eigen::RowVectorXd mean = own.colwise().mean();
      all += (own.rowwise() - mean).squaredNorm();
      steps += (own.bottomRows(own.rows() - 1) - own.topRows(own.rows() - 1)).squaredNorm();
    }
    if (steps > 2 * thresholds_.slow_share * all) quick.push_back(item);
  }
  return quick;
}

std::optional<fit::NoiseModel> Finder::touched_anew(const fit::NoiseModel& explained) const {
  std::vector<fit::NoiseStep> steps = fit::set_up_steps(evidence_.layout());
  if (steps.empty()) return std::nullopt;
  const Eigen::MatrixXd none(evidence_.residual().size(), 0);
  const Eigen::MatrixXd columns = fit::step_columns(evidence_.layout(), steps, none.rows());
  const double fall = evidence_.left_in_full(none) - evidence_.left_in_full(columns);
  const double price = static_cast<double>(steps.size()) * std::log(static_cast<double>(none.rows()));
  if (fall < (price + thresholds_.instrument_distance) * explained.own * explained.own) return std::nullopt;
  // From independent readings: other correlation may be a cause that is not yet found.
  fit::NoiseModel start = evidence_.estimate(none, std::move(steps));
  start.own = explained.own;
  start.pose = start.run = start.drift = 0;
  return start;
}

bool Finder::is_one_offset(const fit::NoiseModel& noise) const {
  if (noise.run <= 0 && noise.drift <= 0) return false;
  const fit::NoiseModel beside = evidence_.estimate(evidence_.offset_columns());
  return beside.run <= 0 && beside.drift <= 0;
}

std::vector<std::size_t> Finder::without(std::size_t item) const {
  std::vector<std::size_t> others;
  for (const std::size_t other : chosen_)
    if (other != item) others.push_back(other);
  return others;
}

Selection Finder::evaluate(const std::vector<std::size_t>& items) const {
  std::vector<std::size_t> entries;
  for (const std::size_t item : items) entries.push_back(entry_of(item).value());
  return evaluate_selection(problem_, entries);
}

void Finder::ban_hollow_products() {
  for (std::size_t i = 0; i < pool_.size(); ++i) {
    if (!pool_.is_custom(i) || pool_[i].banned) continue;
    if (pool_.witnesses(i) < thresholds_.witnesses)
      pool_.ban(i, "test `witnesses`: only a few readings show this effect");
    for (std::size_t failed = 0; failed < pool_.size() && !pool_[i].banned; ++failed)
      if (pool_[failed].banned && !pool_.is_custom(failed) &&
          pool_.common_share(i, failed) > thresholds_.copy_of_failed)
        pool_.ban(i, "the effect is nearly the same as " + pool_.candidate(failed).label +
                         ", which failed: " + pool_[failed].why_not);
  }
}

std::vector<int> Finder::runs_to_hold_out(std::size_t item) const {
  const bool of_run = !pool_.candidate(item).choice.runs.empty() || shows_in_one_block(item);
  return of_run ? evidence_.parts_of_runs() : evidence_.blocks();
}

std::string Finder::failed_test(std::size_t item) const {
  const Selection rest = evaluate(without(item));
  if (rest.criterion - criterion_ < thresholds_.evidence)
    return fmt::format("evidence: the BIC decreases by less than {:g}", thresholds_.evidence);
  const double gain = rest.chi_square - chi_square_;
  if (std::string failed = failed_on_runs(item, gain); !failed.empty()) return failed;
  if (std::string failed = failed_on_levels(item, gain); !failed.empty()) return failed;
  if (std::string failed = failed_on_positions(item, gain); !failed.empty()) return failed;
  if (std::string failed = failed_between_stations(item); !failed.empty()) return failed;
  return too_large(item);
}

std::string Finder::failed_between_stations(std::size_t item) const {
  const std::optional<double> period = pool_.period_of(item);
  if (!period) return {};
  const CurveBetweenStations curve = curve_between_stations(evidence_, pool_.candidate(item));
  // A table follows a wave of two of its intervals and longer.
  if (curve.columns.cols() == 0 || *period >= 2 * curve.spacing) return {};
  const Eigen::MatrixXd others = pool_.columns(without(item));
  Eigen::MatrixXd beside(curve.columns.rows(), others.cols() + curve.columns.cols());
  beside << others, curve.columns;
  if (chance_beside(item, beside) < thresholds_.between_stations) return {};
  const model::Axis& axis = evidence_.machine().axes[*pool_.candidate(item).choice.axis];
  return fmt::format(
      "{}: the table of {} has stations {:.4g} {} apart, and a curve between them explains these readings as "
      "well",
      kTestBetweenStations, axis.name, curve.spacing, axis.rotary ? "deg" : "mm");
}

std::string Finder::failed_on_runs(std::size_t item, double gain) const {
  const Eigen::Index count = pool_[item].columns.cols();
  std::vector<std::size_t> others = without(item), all = {item};
  all.insert(all.end(), others.begin(), others.end());
  const std::vector<int> runs = runs_to_hold_out(item);
  const HeldOut with = leave_blocks_out(evidence_, pool_.columns(all), 0, count, runs);
  const HeldOut less = leave_blocks_out(evidence_, pool_.columns(others), 0, 0, runs);
  if (less.chi_square - with.chi_square < thresholds_.held_out_share * gain)
    return "test `held out`: the effect does not reduce the residual of held-out runs";
  std::size_t agree = 0;
  for (const double cosine : with.agreement) agree += cosine > thresholds_.stable_cosine ? 1 : 0;
  if (static_cast<double>(agree) < thresholds_.stable_runs * static_cast<double>(with.agreement.size()))
    return "test `stability`: the coefficients of the effect change if the fit does not use one of the runs";
  return {};
}

std::string Finder::failed_on_levels(std::size_t item, double gain) const {
  if (!has_input(item, effects::InputClass::kFeature)) return {};
  for (const std::vector<int>& levels : level_blocks(evidence_))
    if (held_out_decrease(item, levels) < thresholds_.held_out_share * gain)
      return "test `held out`: the effect does not reduce the residual of readings at held-out feeds or "
             "temperatures";
  return {};
}

std::string Finder::failed_on_positions(std::size_t item, double gain) const {
  // Other rows at the same positions cannot contradict what a term does between them.
  const bool found = pool_.is_custom(item);
  const double least =
      found ? thresholds_.held_out_share * gain : 2 * kEvidenceOfNothing * variance_of_reading();
  std::vector<std::size_t> others = without(item), all = {item};
  all.insert(all.end(), others.begin(), others.end());
  for (const std::vector<int>& places : place_blocks(evidence_, pool_.candidate(item).choice.axis)) {
    const HeldOut less = leave_blocks_out(evidence_, pool_.columns(others), 0, 0, places),
                  with = leave_blocks_out(evidence_, pool_.columns(all), 0, 0, places);
    if (less.chi_square - with.chi_square >= least) continue;
    // Where the other positions determine a table badly, its error is larger than that of the readings, and
    // the difference of two sums of squares shows this error alone: -2 log of the density decides.
    const double density =
        less.predicted_square - with.predicted_square +
        variance_of_reading() * (less.predicted_log_determinant - with.predicted_log_determinant);
    if (density < thresholds_.held_out_share * gain)
      return "test `held out`: the effect does not reduce the residual of readings at held-out positions";
  }
  return {};
}

double Finder::variance_of_reading() const {
  const double variance = chi_square_ / std::max(1.0, evidence_.freedom());
  return evidence_.noise_known() ? std::max(1.0, variance) : std::max(variance, 1e-300);
}

double Finder::held_out_decrease(std::size_t item, const std::vector<int>& blocks) const {
  std::vector<std::size_t> others = without(item), all = {item};
  all.insert(all.end(), others.begin(), others.end());
  return held_out_square(others, blocks) - held_out_square(all, blocks);
}

double Finder::held_out_evidence(std::size_t item) const {
  return held_out_decrease(item, runs_to_hold_out(item)) / (2 * variance_of_reading());
}

double Finder::held_out_square(const std::vector<std::size_t>& items, const std::vector<int>& blocks) const {
  return leave_blocks_out(evidence_, pool_.columns(items), 0, 0, blocks).chi_square;
}

void Finder::add_divisions(std::size_t of, std::vector<Division>& divisions) const {
  for (std::vector<int>& places : place_blocks(evidence_, pool_.candidate(of).choice.axis)) {
    const bool known = std::any_of(divisions.begin(), divisions.end(),
                                   [&](const Division& one) { return one.blocks == places; });
    if (known) continue;
    const double accepted = held_out_square(chosen_, places);
    divisions.push_back({std::move(places), accepted});
  }
}

bool Finder::predicts_worse(std::size_t alternative, std::size_t item,
                            const std::vector<Division>& of_item) const {
  std::vector<Division> divisions = of_item;
  add_divisions(alternative, divisions);
  std::vector<std::size_t> set = without(item);
  set.push_back(alternative);
  // The worst of several divisions, which share readings and leave out whole stretches, is often beyond the
  // evidence that one of them would need.
  const double limit =
      2 * (evidence_.thresholds().proof.contradiction + std::log(static_cast<double>(divisions.size()))) *
      variance_of_reading();
  return std::any_of(divisions.begin(), divisions.end(), [&](const Division& one) {
    return held_out_square(set, one.blocks) - one.accepted > limit;
  });
}

bool Finder::has_input(std::size_t item, effects::InputClass wanted) const {
  const model::Machine& machine = evidence_.machine();
  const std::vector<std::string>& inputs = pool_.candidate(item).choice.inputs;
  return std::any_of(inputs.begin(), inputs.end(), [&](const std::string& name) {
    const auto input = machine.find_input(name);
    return input && effects::class_of_input(machine.inputs[*input]) == wanted;
  });
}

Eigen::VectorXd Finder::contribution(std::size_t item) const {
  return pool_[item].columns * own_coefficients(item);
}

bool Finder::shows_in_one_block(std::size_t item) const {
  const Eigen::VectorXd part = contribution(item);
  std::map<int, double> of_block;
  for (Eigen::Index i = 0; i < part.size(); ++i)
    of_block[evidence_.blocks()[static_cast<std::size_t>(i)]] += part[i] * part[i];
  return std::any_of(of_block.begin(), of_block.end(), [&](const auto& block) {
    return block.second > thresholds_.in_one_block * part.squaredNorm();
  });
}

std::string Finder::too_large(std::size_t item) const {
  const effects::Candidate& candidate = pool_.candidate(item);
  const std::vector<double> k = coefficient_of_each_unknown(item);
  std::size_t linear = 0;
  for (const effects::CandidateUnknown& unknown : effects::linear_unknowns(candidate)) {
    const std::size_t at = linear++;
    if (k[at] == 0) continue;
    if (!unknown.plausible.contains(k[at]))
      return fmt::format(
          "size: the coefficient {} would be {:.3g} {}, outside the plausible range {:g} to {:g}",
          unknown.name, k[at], unknown.unit, unknown.plausible.low, unknown.plausible.high);
    if (unknown.limit <= 0) continue;
    const double size = std::abs(k[at]) * typical_size(candidate, at, item);
    const double limit = std::max(unknown.limit, thresholds_.size_share * extent_of(candidate));
    if (size > limit)
      return fmt::format("size: the term would reach {:.3g}, more than the largest plausible value {:g}",
                         size, limit);
  }
  // Effects that cancel each other are not determined one by one.
  if (const double times = contribution(item).norm() / std::max(evidence_.residual().norm(), 1e-300);
      times > thresholds_.most_of_error)
    return fmt::format(
        "size: the effect would be {:.2g} times as large as the error, and other effects would cancel it",
        times);
  const double share =
      evidence_.share_of_touch_error(candidate, pool_[item].scored.scanned, own_coefficients(item));
  if (share > thresholds_.share_of_touch_error)
    return fmt::format(
        "size: the slope of the term is {:.2g}, so the term depends on the error of the touches in the "
        "recorded positions",
        share);
  return {};
}

double Finder::extent_of(const effects::Candidate& candidate) const {
  const model::Machine& machine = evidence_.machine();
  const auto& place = candidate.choice.place;
  if (place && effects::is_angle(machine, *place)) {
    const auto axis = candidate.choice.axis;
    if (!axis || !machine.axes[*axis].rotary) return 0;
    const Evidence::Range range = evidence_.range_of(*axis);
    return range.high - range.low;
  }
  return evidence_.reach_mm();
}

double Finder::typical_size(const effects::Candidate& candidate, std::size_t linear, std::size_t item) const {
  // At the read positions, and all along the axis that drives it: a curve may be large between
  // them.
  const model::States& read = evidence_.measurement().states;
  double largest = largest_value(candidate, linear, item, read);
  if (candidate.choice.axis) {
    const Evidence::Range range = evidence_.range_of(*candidate.choice.axis);
    model::States along = model::select_states(read, evidence_.rows());
    model::Column& position = along.axis[*candidate.choice.axis];
    constexpr double kGolden =
        0.61803398874989485;  // of a turn: evenly distributed over the range in any order of rows
    for (Eigen::Index i = 0; i < position.size(); ++i) {
      const double at = static_cast<double>(i) * kGolden;
      position[i] = range.low + (at - std::floor(at)) * (range.high - range.low);
    }
    largest = std::max(largest, largest_value(candidate, linear, item, along));
  }
  return largest;
}

double Finder::largest_value(const effects::Candidate& candidate, std::size_t linear, std::size_t item,
                             const model::States& states) const {
  model::Machine scratch = evidence_.machine();
  const std::vector<std::size_t> statics =
      effects::add_unknowns(scratch, candidate, pool_[item].scored.scanned);
  scratch.statics[statics[linear]].value = 1;
  double largest = 0;
  for (const effects::CandidateTerm& term : candidate.terms) {
    const model::Column column =
        ::vernier::model::evaluate(scratch, *model::parse_expression_for(scratch, term.text), states);
    largest = std::max(largest, column.abs().maxCoeff());
  }
  return largest;
}

std::vector<double> Finder::coefficient_of_each_unknown(std::size_t item) const {
  const Eigen::VectorXd k = own_coefficients(item);
  std::vector<double> each(
      static_cast<std::size_t>(std::ranges::distance(effects::linear_unknowns(pool_.candidate(item)))));
  for (std::size_t i = 0; i < pool_[item].kept.size(); ++i)
    each[pool_[item].kept[i]] = k[static_cast<Eigen::Index>(i)];
  return each;
}

Eigen::VectorXd Finder::own_coefficients(std::size_t item) const {
  std::vector<std::size_t> entries, set = chosen_;
  if (std::find(set.begin(), set.end(), item) == set.end()) set = {item};
  Eigen::Index first = 0, at = 0;
  for (const std::size_t one : set) {
    const std::optional<std::size_t> entry = entry_of(one);
    if (!entry) {  // banned
      const Eigen::MatrixXd c = pool_[item].columns;
      return maths::least_squares(c, evidence_.residual());
    }
    if (one == item) first = at;
    at += pool_[one].columns.cols();
    entries.push_back(*entry);
  }
  const Eigen::VectorXd all = coefficients(problem_, entries);
  Eigen::VectorXd own = all.segment(first, pool_[item].columns.cols());
  for (Eigen::Index j = 0; j < own.size(); ++j) own[j] /= pool_[item].columns.col(j).norm();
  return own;
}

void Finder::accept() {
  // Every round bans an item, so the loop terminates with a set that passes, or with an empty set.
  while (!chosen_.empty()) {
    const auto failing = std::find_if(chosen_.rbegin(), chosen_.rend(),
                                      [&](std::size_t item) { return !failed_test(item).empty(); });
    if (failing == chosen_.rend()) return;
    pool_.ban(*failing, failed_test(*failing));
    ban_hollow_products();
    select_again();
  }
}

double Finder::score_alone(std::size_t item) const {
  const SelectionProblem alone = pool_.problem_of({item});
  return evaluate_selection(alone, {}).criterion - evaluate_selection(alone, {0}).criterion;
}

double Finder::p_value(std::size_t item) const {
  return chance_of(item, pool_[item].columns, evidence_.residual(), evidence_.freedom());
}

double Finder::p_value_beside(std::size_t item, const std::vector<std::size_t>& others) const {
  return chance_beside(item, pool_.columns(others));
}

double Finder::chance_beside(std::size_t item, const Eigen::MatrixXd& others) const {
  const Eigen::MatrixXd beside = maths::orthonormal(others, 1e-6, nullptr);
  const Eigen::VectorXd left = evidence_.residual() - beside * (beside.transpose() * evidence_.residual());
  Eigen::MatrixXd own = pool_[item].columns - beside * (beside.transpose() * pool_[item].columns);
  // The small difference between a copy and its original is rounding, or the curvature of a
  // period.
  constexpr double kCopy = 1e-3;  // of its squares
  if (own.squaredNorm() < kCopy * pool_[item].columns.squaredNorm()) return 1;
  return chance_of(item, own, left, evidence_.freedom() - static_cast<double>(beside.cols()));
}

double Finder::chance_of(std::size_t item, const Eigen::MatrixXd& columns, const Eigen::VectorXd& residual,
                         double freedom) const {
  const Eigen::MatrixXd basis = maths::orthonormal(columns, 1e-6, nullptr);
  const double gain = (basis.transpose() * residual).squaredNorm();
  double variance =
      (residual.squaredNorm() - gain) / std::max(1.0, freedom - static_cast<double>(basis.cols()));
  if (evidence_.noise_known()) variance = std::max(1.0, variance);
  const Scored& scored = pool_[item].scored;
  const double unknowns = static_cast<double>(basis.cols()) + static_cast<double>(scored.scanned.size());
  const FinePeriods& fine = list_[scored.candidate].fine;
  const double tries = scored.scanned.size() == 1 && fine.holds(scored.scanned[0]) ? fine.tries() : 1;
  return std::min(1.0, tries * static_cast<double>(list_.size()) *
                           maths::chi_square_tail(gain / std::max(variance, 1e-300), unknowns));
}

std::vector<std::size_t> Alternatives::within(double distance) const {
  constexpr double kRounding = 1e-3;  // of two fits; a rare form of the same columns is at the limit itself
  std::vector<std::size_t> items;
  for (const Alternative& one : other)
    if (one.distance < distance - kRounding) items.push_back(one.item);
  return items;
}

Alternatives Finder::alternatives_to(std::size_t item) const {
  Alternatives found;
  const std::vector<std::size_t> others = without(item);
  std::vector<Division> divisions = {{evidence_.blocks(), held_out_square(chosen_, evidence_.blocks())}};
  add_divisions(item, divisions);
  for (const std::size_t alternative : entry_item_) {
    if (alternative == item || std::find(others.begin(), others.end(), alternative) != others.end()) continue;
    std::vector<std::size_t> set = others;
    set.push_back(alternative);
    const double distance = evaluate(set).criterion - criterion_;
    if (distance < thresholds_.distance_of_fits) {
      // A form that contains this one and additional terms needs evidence of its own. It is not an
      // alternative.
      if (pool_.contains(alternative, item)) continue;
      const effects::Choice &mine = pool_.candidate(item).choice,
                            &other = pool_.candidate(alternative).choice;
      const bool alike =
          (mine.effect == other.effect && mine.inputs == other.inputs) || pool_.same_kind(alternative, item);
      if (alike && pool_.same_columns(item, alternative)) {
        found.same.push_back(alternative);
        continue;
      }
    }
    if (pool_.same_cause(item, alternative) || !too_large(alternative).empty()) continue;
    if (distance < thresholds_.distance_of_fits && predicts_worse(alternative, item, divisions)) continue;
    found.other.push_back({alternative, distance});
  }
  std::sort(found.other.begin(), found.other.end(),
            [](const Alternative& a, const Alternative& b) { return a.distance < b.distance; });
  // One cause with several forms, travels or time constants counts once; another period is another cause.
  std::vector<Alternative> once;
  for (const Alternative& one : found.other)
    if (std::none_of(once.begin(), once.end(), [&](const Alternative& nearer) {
          return pool_.same_cause(nearer.item, one.item) && !pool_.period_of(one.item) &&
                 pool_.candidate(nearer.item).choice.place == pool_.candidate(one.item).choice.place;
        }))
      once.push_back(one);
  found.other = std::move(once);
  return found;
}

double Finder::share_left(std::size_t item) const {
  return evaluate({item}).chi_square / evaluate({}).chi_square;
}

double Finder::criterion_of_fit(const std::vector<std::size_t>& items, double ratio) const {
  const Selection linear = evaluate(items);
  return linear.criterion - likelihood_part(problem_, linear.chi_square) +
         likelihood_part(problem_, ratio * chi_square_);
}

bool Finder::replace(std::size_t item, std::size_t by) {
  const std::vector<std::size_t> before = chosen_;
  const double criterion = criterion_, chi_square = chi_square_;
  std::replace(chosen_.begin(), chosen_.end(), item, by);
  const Selection now = evaluate(chosen_);
  criterion_ = now.criterion;
  chi_square_ = now.chi_square;
  const bool passes = std::all_of(chosen_.begin(), chosen_.end(),
                                  [this](std::size_t one) { return failed_test(one).empty(); });
  if (passes) return true;
  chosen_ = before;
  criterion_ = criterion;
  chi_square_ = chi_square;
  return false;
}

double Finder::evidence_for(std::size_t item) const {
  return (evaluate(without(item)).criterion - criterion_) / 2;
}

double Finder::evidence_for(std::size_t item, const std::vector<double>& scanned) const {
  const double loss = gain_at(item, pool_[item].scored.scanned) - gain_at(item, scanned);
  return evidence_for(item) - (likelihood_part(problem_, std::max(0.0, chi_square_ + loss)) -
                               likelihood_part(problem_, chi_square_)) /
                                  2;
}

double Finder::gain_at(std::size_t item, const std::vector<double>& scanned) const {
  const Eigen::MatrixXd beside = maths::orthonormal(pool_.columns(without(item)), 1e-6, nullptr);
  Eigen::MatrixXd columns =
      evidence_.beside_model(ColumnMaker(evidence_).columns(pool_.candidate(item), scanned));
  columns -= beside * (beside.transpose() * columns);
  return (maths::orthonormal(columns, 1e-6, nullptr).transpose() * evidence_.residual()).squaredNorm();
}

std::vector<double> Finder::aliases_of(std::size_t item) const {
  return scanner_.aliases(pool_[item].scored,
                          maths::orthonormal(pool_.columns(without(item)), 1e-6, nullptr));
}

double Finder::growth_without(std::size_t item) const {
  return evaluate(without(item)).chi_square / std::max(chi_square_, 1e-300);
}

bool Finder::linear_down_to_noise() const {
  if (!evidence_.noise_known()) return true;
  const double freedom = std::max(1.0, evidence_.freedom());
  return chi_square_ / freedom < 1 + evidence_.thresholds().verdict.noise_sigmas * std::sqrt(2 / freedom);
}

}  // namespace vernier::diagnose
