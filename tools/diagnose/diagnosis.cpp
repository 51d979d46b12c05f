#include "tools/diagnose/diagnosis.h"

#include <fmt/format.h>

#include <Eigen/QR>
#include <algorithm>
#include <cmath>

#include "tools/diagnose/acceptance.h"
#include "tools/diagnose/pool.h"
#include "tools/diagnose/structure.h"
#include "tools/diagnose/time_base.h"
#include "tools/fit/statistics.h"
#include "tools/model/chain.h"

namespace vernier {
namespace {

/// Fall of the criterion that counts as evidence (Kass and Raftery 1995: strong), and the distance a rival
/// must keep for a name to be given with confidence.
constexpr double kEvidence = 6, kDistance = 6;
/// Of what an effect removes from the rows it was fitted to, this much must be removed from runs left out.
constexpr double kHeldOutShare = 0.2;
/// chi^2 per degree of freedom up to this many of its own standard deviations above 1 is noise.
constexpr double kNoiseSigmas = 4;

/// One diagnosis, step by step.
class Diagnoser {
 public:
  Diagnoser(const std::string& text, const Machine& machine, const Measurement& measurement,
            const DiagnoseOptions& options)
      : options_(options),
        measurement_(measurement),
        machine_(machine),
        base_(fit_first(machine, measurement)),
        text_(update_machine_text(text, base_.machine, true)),
        evidence_(base_.machine, measurement),
        list_(enumerate_candidates(evidence_, options.effects)),
        scanner_(evidence_, list_),
        pool_(evidence_, scanner_) {}

  Diagnosis run() {
    result_.base = base_;
    StructureOptions structure;
    structure.fitted_parameters = static_cast<std::size_t>(base_.observability.rank);
    result_.failure = failure_picture(base_.machine, measurement_, base_.residual, structure);
    result_.searched = list_.size();
    search();
    weigh_correlation();
    accept();
    if (!linear_down_to_noise()) {
      search_products();
      accept();
    }
    walk_ladder();
    if (!chosen_.empty()) rivals_ = rivals_of(chosen_.front());
    list_candidates();
    decide();
    return std::move(result_);
  }

 private:
  FitResult fit_first(const Machine& machine, const Measurement& m) {
    options_.progress(0, "fitting the model");
    return fit(machine, m);
  }

  // ---- search ----

  void scan_beside(const std::vector<std::size_t>& items, double from, double to, std::size_t first = 0) {
    const Eigen::MatrixXd beside = orthonormal(pool_.columns(items), 1e-6, nullptr);
    const auto scored = scanner_.scan(
        beside,
        [&](double share) {
          options_.progress(from + share * (to - from), fmt::format("{} candidates", list_.size()));
        },
        first);
    constexpr std::size_t kMostAtOnce = 50;
    pool_.add(scored, kMostAtOnce, beside);
  }

  /// Beyond the catalogue: products of recorded quantities, pairs first, then a third factor on the best.
  void search_products() {
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
    select_again();
  }

  /// The products that lower the criterion most, alone.
  std::vector<Product> best_products() {
    problem_ = pool_.problem(entry_item_);
    problem_.correlation_time = correlation_time_;
    std::vector<std::pair<double, std::size_t>> order;
    for (std::size_t i = 0; i < pool_.size(); ++i)
      if (pool_.candidate(i).choice.effect == &custom_effect()) order.emplace_back(-score_alone(i), i);
    std::sort(order.begin(), order.end());
    std::vector<Product> best;
    constexpr std::size_t kExtended = 25;
    for (std::size_t i = 0; i < std::min(kExtended, order.size()); ++i) {
      const Choice& choice = pool_.candidate(order[i].second).choice;
      best.push_back({*choice.place, choice.term, choice.inputs, choice.units});
    }
    return best;
  }

  void select_again() {
    problem_ = pool_.problem(entry_item_);
    problem_.correlation_time = correlation_time_;
    const Selection selection = select(problem_, options_.most_effects);
    chosen_.clear();
    for (const std::size_t entry : selection.chosen) chosen_.push_back(entry_item_[entry]);
    criterion_ = selection.criterion;
    chi_square_ = selection.chi_square;
    simplify();
  }

  /// A form that holds a simpler one is taken only where what it has more is evidence by itself; of forms
  /// with the same columns the one nearest to the axis.
  void simplify() {
    for (std::size_t i = 0; i < chosen_.size(); ++i) {
      std::optional<std::size_t> simplest;
      Selection best;
      for (const std::size_t other : entry_item_) {
        if (std::find(chosen_.begin(), chosen_.end(), other) != chosen_.end()) continue;
        std::vector<std::size_t> set = chosen_;
        set[i] = other;
        const Selection trial = evaluate(set);
        if (trial.criterion - criterion_ >= kEvidence) continue;
        if (simplest && trial.criterion >= best.criterion) continue;
        // The same columns from a place further from the axis are only the longer way to say it.
        const bool same_but_nearer = pool_.same_kind(chosen_[i], other) &&
                                     pool_.penalty(pool_[other].scored.candidate) <
                                         pool_.penalty(pool_[chosen_[i]].scored.candidate) &&
                                     pool_.same_columns(chosen_[i], other);
        if (!same_but_nearer && !pool_.contains(chosen_[i], other)) continue;
        simplest = other;
        best = trial;
      }
      if (!simplest) continue;
      chosen_[i] = *simplest;
      criterion_ = best.criterion;
      chi_square_ = best.chi_square;
    }
  }

  void search() {
    scan_beside({}, 0.05, 0.3);
    select_again();
    constexpr int kMostScans = 6;
    for (int round = 0; round < kMostScans && !chosen_.empty(); ++round) {
      const std::vector<std::size_t> before = chosen_;
      const double criterion = criterion_;
      scan_beside(chosen_, 0.3 + 0.08 * round, 0.34 + 0.08 * round);
      // Rivals of each accepted one, the others given.
      if (chosen_.size() > 1)
        for (const std::size_t item : before) {
          std::vector<std::size_t> others;
          for (const std::size_t other : before)
            if (other != item) others.push_back(other);
          scan_beside(others, 0.34 + 0.08 * round, 0.38 + 0.08 * round);
        }
      select_again();
      if (criterion_ > criterion - 1e-6) break;
    }
  }

  /// Where neighbouring readings hang together even after the richest explanation, they count for less.
  void weigh_correlation() {
    const Eigen::MatrixXd all = orthonormal(pool_.columns(chosen_), 1e-6, nullptr);
    const Eigen::VectorXd left = evidence_.residual() - all * (all.transpose() * evidence_.residual());
    // A little of it (several points at one pose, out and back) is the model's misfit; more is oversampling.
    constexpr double kOversampled = 2.5;
    const double time = evidence_.correlation_time(left);
    if (time < kOversampled) return;
    correlation_time_ = time;
    select_again();
  }

  // ---- acceptance ----

  std::vector<std::size_t> without(std::size_t item) const {
    std::vector<std::size_t> others;
    for (const std::size_t other : chosen_)
      if (other != item) others.push_back(other);
    return others;
  }

  Selection evaluate(const std::vector<std::size_t>& items) const {
    std::vector<std::size_t> entries;
    for (const std::size_t item : items)
      entries.push_back(static_cast<std::size_t>(std::find(entry_item_.begin(), entry_item_.end(), item) -
                                                 entry_item_.begin()));
    return evaluate_selection(problem_, entries);
  }

  /// The first test of acceptance that an accepted item fails; empty where it passes all.
  std::string failed_test(std::size_t item) const {
    const Selection rest = evaluate(without(item));
    if (rest.criterion - criterion_ < kEvidence) return "evidence: the fall of the criterion is below 6";
    const Eigen::Index count = pool_[item].columns.cols();
    std::vector<std::size_t> others = without(item), all = {item};
    all.insert(all.end(), others.begin(), others.end());
    const bool of_run = !pool_.candidate(item).choice.runs.empty();
    const HeldOut with = leave_runs_out(evidence_, pool_.columns(all), 0, count, of_run);
    const HeldOut less = leave_runs_out(evidence_, pool_.columns(others), 0, 0, of_run);
    const double gain = rest.chi_square - chi_square_;
    if (less.chi_square - with.chi_square < kHeldOutShare * gain)
      return "held out: it does not help on runs that were left out";
    std::size_t agree = 0;
    for (const double cosine : with.agreement) agree += cosine > 0.5 ? 1 : 0;
    if (static_cast<double>(agree) < 0.75 * static_cast<double>(with.agreement.size()))
      return "stability: its coefficients change when a run is left out";
    return too_large(item);
  }

  /// Is the term larger than any machine shows it?
  std::string too_large(std::size_t item) const {
    const Candidate& candidate = pool_.candidate(item);
    const Eigen::VectorXd k = own_coefficients(item);
    std::size_t linear = 0;
    for (const CandidateUnknown& unknown : candidate.unknowns) {
      if (unknown.kind != UnknownKind::kLinear) continue;
      const auto kept = std::find(pool_[item].kept.begin(), pool_[item].kept.end(), linear++);
      if (kept == pool_[item].kept.end() || unknown.limit <= 0) continue;
      const double size =
          std::abs(k[kept - pool_[item].kept.begin()]) * typical_size(candidate, linear - 1, item);
      if (size > unknown.limit)
        return fmt::format("size: the term would reach {:.3g}, no machine shows more than {:g}", size,
                           unknown.limit);
    }
    return {};
  }

  /// Largest value over the fit rows that a linear unknown of 1 gives its term, mm or deg.
  double typical_size(const Candidate& candidate, std::size_t linear, std::size_t item) const {
    Machine scratch = evidence_.machine();
    std::size_t index = 0, scanned = 0;
    for (const CandidateUnknown& unknown : candidate.unknowns) {
      Static value;
      value.name = unknown.name;
      value.value = unknown.kind == UnknownKind::kLinear ? (index++ == linear ? 1 : 0)
                                                         : pool_[item].scored.scanned[scanned++];
      scratch.statics.push_back(value);
    }
    double largest = 0;
    for (const CandidateTerm& term : candidate.terms) {
      const Column column = evaluate_term(scratch, term.text);
      for (const std::size_t row : evidence_.rows())
        largest = std::max(largest, std::abs(column[static_cast<Eigen::Index>(row)]));
    }
    return largest;
  }

  Column evaluate_term(const Machine& scratch, const std::string& text) const;

  /// Coefficients of an item's columns within the accepted set, in the unit of its unknowns.
  Eigen::VectorXd own_coefficients(std::size_t item) const {
    std::vector<std::size_t> entries, set = chosen_;
    if (std::find(set.begin(), set.end(), item) == set.end()) set = {item};
    Eigen::Index first = 0, at = 0;
    for (const std::size_t one : set) {
      if (one == item) first = at;
      at += pool_[one].columns.cols();
      entries.push_back(static_cast<std::size_t>(std::find(entry_item_.begin(), entry_item_.end(), one) -
                                                 entry_item_.begin()));
    }
    if (std::find(entries.begin(), entries.end(), entry_item_.size()) != entries.end()) {
      const Eigen::MatrixXd c = pool_[item].columns;
      return c.colPivHouseholderQr().solve(evidence_.residual());
    }
    const Eigen::VectorXd all = coefficients(problem_, entries);
    Eigen::VectorXd own = all.segment(first, pool_[item].columns.cols());
    for (Eigen::Index j = 0; j < own.size(); ++j) own[j] /= pool_[item].columns.col(j).norm();
    return own;
  }

  void accept() {
    constexpr int kMostRounds = 12;
    for (int round = 0; round < kMostRounds; ++round) {
      bool all_pass = true;
      for (const std::size_t item : std::vector<std::size_t>(chosen_.rbegin(), chosen_.rend())) {
        const std::string failed = failed_test(item);
        if (failed.empty()) continue;
        pool_.ban(item, failed);
        all_pass = false;
        break;
      }
      if (all_pass) return;
      select_again();
    }
    chosen_.clear();
  }

  // ---- fits in earnest ----

  struct Fitted {
    std::string text;
    FitResult fit;
    std::vector<Candidate> candidates;  // with their final names
  };

  /// The machine with several items added and fitted, from the linear estimate.
  Fitted fit_with(const std::vector<std::size_t>& items) const {
    Fitted result;
    result.text = text_;
    Machine machine = parse_machine(text_, machine_.file);
    std::map<std::string, double> start;
    for (const std::size_t item : items) {
      Choice choice = pool_.candidate(item).choice;
      set_starts(choice, item);
      const Candidate candidate = make_candidate(machine, choice);
      const Eigen::VectorXd k = own_coefficients(item);
      std::size_t linear = 0;
      for (const CandidateUnknown& unknown : candidate.unknowns) {
        if (unknown.kind != UnknownKind::kLinear) continue;
        const auto kept = std::find(pool_[item].kept.begin(), pool_[item].kept.end(), linear++);
        if (kept != pool_[item].kept.end()) start[unknown.name] = k[kept - pool_[item].kept.begin()];
      }
      result.text = add_to_machine_text(result.text, machine, candidate);
      machine = parse_machine(result.text, machine_.file);
      result.candidates.push_back(candidate);
    }
    for (Static& item : machine.statics)
      if (const auto found = start.find(item.name); found != start.end()) item.value = found->second;
    const Measurement rows = rebind(measurement_, base_.machine, machine);
    result.fit = fit(machine, rows);
    if (hold_runaways(items, result, machine)) result.fit = fit(machine, rows);
    result.text = update_machine_text(result.text, result.fit.machine, true);
    return result;
  }

  /// A period or time constant that the fit drove out of the range in which it was looked for is held at the
  /// value found there. True where there was one.
  bool hold_runaways(const std::vector<std::size_t>& items, const Fitted& fitted, Machine& machine) const {
    bool any = false;
    for (std::size_t i = 0; i < items.size(); ++i) {
      const auto& grid = list_[pool_[items[i]].scored.candidate].grid;
      std::size_t scanned = 0;
      for (const CandidateUnknown& unknown : fitted.candidates[i].unknowns) {
        if (unknown.kind == UnknownKind::kLinear) continue;
        const std::vector<double>& range = grid[scanned++];
        const auto at = fitted.fit.machine.find_static(unknown.name);
        const double value = fitted.fit.machine.statics[*at].value;
        if (value >= range.front() / 2 && value <= range.back() * 2) continue;
        machine.statics[*machine.find_static(unknown.name)].hidden = true;
        any = true;
      }
    }
    return any;
  }

  void set_starts(Choice& choice, std::size_t item) const {
    std::size_t scanned = 0;
    for (const CandidateUnknown& unknown : pool_.candidate(item).unknowns)
      if (unknown.kind != UnknownKind::kLinear)
        choice.start[unknown.rule] = pool_[item].scored.scanned[scanned++];
  }

  std::string add_string_of(std::size_t item) const {
    Candidate candidate = pool_.candidate(item);
    set_starts(candidate.choice, item);
    return add_string(evidence_.machine(), candidate);
  }

  void walk_ladder() {
    LadderStep start;
    start.rms_um = base_.after.rms_um;
    start.check_rms_um = base_.check.rms_um;
    start.chi_square_per_freedom = base_.chi_square / std::max<double>(1, static_cast<double>(base_.freedom));
    start.text = text_;
    result_.ladder.push_back(start);
    result_.machine_text = text_;
    result_.end = base_;
    for (std::size_t count = 1; count <= chosen_.size(); ++count) {
      options_.progress(0.8 + 0.1 * static_cast<double>(count) / static_cast<double>(chosen_.size()),
                        "fitting the ladder");
      const std::vector<std::size_t> items(chosen_.begin(),
                                           chosen_.begin() + static_cast<std::ptrdiff_t>(count));
      const Fitted fitted = fit_with(items);
      LadderStep step;
      step.effect = pool_.candidate(items.back()).choice.effect->id;
      step.add = add_string_of(items.back());
      step.label = pool_.candidate(items.back()).label;
      step.rms_um = fitted.fit.after.rms_um;
      step.check_rms_um = fitted.fit.check.rms_um;
      step.chi_square_per_freedom =
          fitted.fit.chi_square / std::max<double>(1, static_cast<double>(fitted.fit.freedom));
      step.text = fitted.text;
      result_.ladder.push_back(step);
      result_.machine_text = fitted.text;
      result_.end = fitted.fit;
    }
  }

  /// Items in the order in which they are shown: the accepted ones, then by what each does alone.
  std::vector<std::size_t> shown_items() const {
    std::vector<std::pair<double, std::size_t>> rest;
    for (std::size_t i = 0; i < pool_.size(); ++i) {
      if (std::find(chosen_.begin(), chosen_.end(), i) != chosen_.end()) continue;
      rest.emplace_back(score_alone(i), i);
    }
    std::sort(rest.begin(), rest.end(), [](const auto& a, const auto& b) { return a.first > b.first; });
    // The cause, those that cannot be told from it, then the others of the ladder.
    std::vector<std::size_t> items;
    std::set<std::string> seen;
    const auto take = [&](std::size_t item) {
      if (seen.insert(pool_.candidate(item).label).second) items.push_back(item);
    };
    if (!chosen_.empty()) take(chosen_.front());
    for (const std::size_t item : rivals_.close)
      if (items.size() < options_.shown) take(item);
    for (const std::size_t item : chosen_) take(item);
    for (const auto& [score, item] : rest) {
      if (items.size() >= options_.shown) break;
      if (seen.insert(pool_.candidate(item).label).second) items.push_back(item);
    }
    return items;
  }

  double score_alone(std::size_t item) const {
    const auto entry = std::find(entry_item_.begin(), entry_item_.end(), item);
    if (entry == entry_item_.end()) return -1e300;
    return evaluate_selection(problem_, {}).criterion -
           evaluate_selection(problem_, {static_cast<std::size_t>(entry - entry_item_.begin())}).criterion;
  }

  void list_candidates() {
    const std::vector<std::size_t> items = shown_items();
    for (std::size_t i = 0; i < items.size(); ++i) {
      options_.progress(0.9 + 0.1 * static_cast<double>(i) / static_cast<double>(items.size()),
                        "fitting the candidates");
      const std::size_t item = items[i];
      CandidateFinding finding;
      const Fitted fitted = fit_with({item});
      finding.candidate = fitted.candidates[0];
      set_starts(finding.candidate.choice, item);
      finding.add = add_string_of(item);
      const Choice& choice = finding.candidate.choice;
      finding.axis = choice.axis;
      if (!finding.axis && choice.place) finding.axis = axis_of(machine_, *choice.place);
      for (const CandidateUnknown& unknown : finding.candidate.unknowns)
        for (const ParameterEstimate& estimate : fitted.fit.estimates)
          if (estimate.name == unknown.name) finding.parameters.push_back(estimate);
      finding.rms_after_um = fitted.fit.after.rms_um;
      finding.check_rms_before_um = base_.check.rms_um;
      finding.check_rms_after_um = fitted.fit.check.rms_um;
      if (base_.chi_square > 0) finding.share = 1 - fitted.fit.chi_square / base_.chi_square;
      finding.score = score_alone(item);
      finding.p_value = p_value(item);
      finding.accepted = std::find(chosen_.begin(), chosen_.end(), item) != chosen_.end();
      finding.why_not = pool_[item].why_not;
      result_.candidates.push_back(std::move(finding));
      shown_.push_back(item);
    }
  }

  /// Chance of such a gain on noise alone, times the number of candidates looked at.
  double p_value(std::size_t item) const {
    const Eigen::MatrixXd basis = orthonormal(pool_[item].columns, 1e-6, nullptr);
    const double gain = (basis.transpose() * evidence_.residual()).squaredNorm();
    const double left = evidence_.chi_square() - gain;
    double variance = left / std::max(1.0, evidence_.freedom() - static_cast<double>(basis.cols()));
    if (evidence_.noise_known()) variance = std::max(1.0, variance);
    const double unknowns =
        static_cast<double>(basis.cols()) + static_cast<double>(pool_[item].scored.scanned.size());
    return std::min(1.0, static_cast<double>(list_.size()) *
                             chi_square_tail(gain / std::max(variance, 1e-300), unknowns));
  }

  // ---- verdict ----

  struct Rivals {
    std::vector<std::size_t> close;  // other causes that fit nearly as well
    std::vector<std::size_t> same;   // the same columns from the same drivers
    double distance = 1e300;         // of the best other cause
    std::optional<std::size_t> best;
  };

  Rivals rivals_of(std::size_t item) const {
    Rivals rivals;
    std::vector<std::pair<double, std::size_t>> close;
    const std::vector<std::size_t> others = without(item);
    for (const std::size_t rival : entry_item_) {
      if (rival == item || std::find(others.begin(), others.end(), rival) != others.end()) continue;
      std::vector<std::size_t> set = others;
      set.push_back(rival);
      const double distance = evaluate(set).criterion - criterion_;
      if (distance < kDistance) {
        // A form that holds this one and more would need evidence of its own: no rival.
        if (pool_.contains(rival, item)) continue;
        const Choice &mine = pool_.candidate(item).choice, &other = pool_.candidate(rival).choice;
        const bool alike =
            (mine.effect == other.effect && mine.inputs == other.inputs) || pool_.same_kind(rival, item);
        if (alike && pool_.same_columns(item, rival)) {
          rivals.same.push_back(rival);
          continue;
        }
      }
      if (pool_.same_cause(item, rival)) continue;
      if (distance < rivals.distance) {
        rivals.distance = distance;
        rivals.best = rival;
      }
      if (distance < kDistance) close.emplace_back(distance, rival);
    }
    std::sort(close.begin(), close.end());
    for (const auto& [distance, rival] : close) rivals.close.push_back(rival);
    return rivals;
  }

  /// Does what the accepted effects leave look like noise, by the linear estimate?
  bool linear_down_to_noise() const {
    if (!evidence_.noise_known()) return true;
    const double freedom = std::max(1.0, evidence_.freedom());
    return chi_square_ / freedom < 1 + kNoiseSigmas * std::sqrt(2 / freedom);
  }

  /// Does the fit at the end of the ladder leave noise? By chi^2 where the uncertainty is given; where chi^2
  /// is above it by so little that the uncertainty itself may be in doubt, and where none is given, by
  /// whether what is left has any structure.
  bool down_to_noise() {
    const Machine& machine = result_.end.machine;
    const Measurement rows = rebind(measurement_, base_.machine, machine);
    StructureOptions structure;
    structure.fitted_parameters = static_cast<std::size_t>(result_.end.observability.rank);
    result_.left = failure_picture(machine, rows, result_.end.residual, structure);
    constexpr double kStructure = 1e-4, kDoubtfulUncertainty = 1.5, kMostlyExplained = 0.5;
    const bool structured = result_.left.omnibus_p < kStructure;
    const double freedom = std::max<double>(1, static_cast<double>(result_.end.freedom));
    const double reduced = result_.end.chi_square / freedom;
    if (!evidence_.noise_known())
      return !structured ||
             (!chosen_.empty() && result_.end.chi_square < (1 - kMostlyExplained) * base_.chi_square);
    if (reduced < 1 + kNoiseSigmas * std::sqrt(2 / freedom)) return !chosen_.empty() || !structured;
    return reduced < kDoubtfulUncertainty && !structured;
  }

  /// Rows with a reading far from all others of a fit, by line number; `spread` of the others.
  static std::vector<std::size_t> far_rows(const Measurement& rows, const Eigen::VectorXd& residual,
                                           bool noise_known) {
    const Eigen::VectorXd weights = fit_weights(rows);
    std::vector<double> sizes;
    for (Eigen::Index i = 0; i < weights.size(); ++i)
      if (weights[i] > 0) sizes.push_back(std::abs(weights[i] * residual[i]));
    if (sizes.empty()) return {};
    std::nth_element(sizes.begin(), sizes.begin() + static_cast<std::ptrdiff_t>(sizes.size() / 2),
                     sizes.end());
    // The median of |x| of a normal variable is 0.6745 of its standard deviation.
    double spread = sizes[sizes.size() / 2] / 0.6745;
    if (noise_known) spread = std::max(spread, 1.0);
    constexpr double kFar = 6;
    std::vector<std::size_t> far;
    for (Eigen::Index i = 0; i < weights.size(); ++i)
      if (std::abs(weights[i] * residual[i]) > kFar * spread) {
        const std::size_t row = rows.observations[static_cast<std::size_t>(i)].row;
        if (far.empty() || far.back() != row) far.push_back(row);
      }
    return far;
  }

  /// A few readings far from all others, and the rest noise once they are left out: that is the instrument (a
  /// lost beam, a bumped target).
  bool blame_outliers() {
    if (!evidence_.noise_known()) return false;  // without u nothing says what the rest should be
    Measurement rows = rebind(measurement_, base_.machine, result_.end.machine);
    Eigen::VectorXd residual = result_.end.residual;
    constexpr double kMostOfThem = 0.03;
    constexpr int kMostRounds = 5;
    const double most = kMostOfThem * static_cast<double>(rows.rows());
    std::vector<std::size_t> lines;
    FitResult rest;
    for (int round = 0; round < kMostRounds; ++round) {
      const std::vector<std::size_t> far = far_rows(rows, residual, true);
      if (far.empty()) break;
      std::vector<std::size_t> keep;
      for (std::size_t row = 0; row < rows.rows(); ++row)
        if (std::find(far.begin(), far.end(), row) == far.end()) keep.push_back(row);
      for (const std::size_t row : far) lines.push_back(rows.line[row]);
      if (static_cast<double>(lines.size()) > most) return false;
      rows = select_rows(rows, keep);
      rest = fit(result_.end.machine, rows);
      residual = rest.residual;
    }
    if (lines.empty() || rest.freedom <= 0) return false;
    const double freedom = static_cast<double>(rest.freedom);
    if (rest.chi_square / freedom > 1 + kNoiseSigmas * std::sqrt(2 / freedom)) return false;
    std::sort(lines.begin(), lines.end());
    result_.verdict = Verdict::kInstrument;
    result_.explanation = fmt::format(
        "Outliers: without {} of {} rows (line {}{}) the residual is noise. A lost beam or a bumped target "
        "is "
        "likelier than the machine.",
        lines.size(), measurement_.rows(),
        fmt::join(lines.begin(),
                  lines.begin() + std::min<std::ptrdiff_t>(8, static_cast<std::ptrdiff_t>(lines.size())),
                  ", "),
        lines.size() > 8 ? ", ..." : "");
    return true;
  }

  void decide() {
    const TimeBaseFinding clock = examine_time_base(measurement_, base_.residual);
    if (clock.found) {
      result_.verdict = Verdict::kInstrument;
      result_.explanation = "The time base of the measurement: " + clock.why;
      result_.time_base = clock;
      return;
    }
    const bool noise_is_left = down_to_noise();
    if (!noise_is_left && blame_outliers()) return;
    if (chosen_.empty()) {
      result_.verdict = noise_is_left ? Verdict::kConsistent : Verdict::kUnexplained;
      result_.explanation =
          result_.verdict == Verdict::kConsistent
              ? "The residual is noise: there is nothing to add."
              : "There is more than noise, and nothing in the catalogue explains it." + where_left();
      return;
    }
    if (pool_.candidate(chosen_.front()).choice.effect->id == "time-base") {
      result_.verdict = Verdict::kInstrument;
      result_.explanation =
          "The time base of the measurement: the error grows with speed and with the time since the start.";
      return;
    }
    const Rivals& rivals = rivals_;
    name_confusions(rivals);
    result_.runner_up_distance = rivals.distance;
    if (!noise_is_left) {
      result_.verdict = Verdict::kUnexplained;
      result_.explanation =
          "Effects of the catalogue lower the residual, and it does not come down to the noise.";
    } else if (!rivals.close.empty()) {
      result_.verdict = Verdict::kAmbiguous;
      result_.explanation = "Several causes explain these data alike.";
    } else {
      result_.verdict = Verdict::kMissingEffect;
      result_.explanation = pool_.candidate(chosen_.front()).label;
    }
  }

  /// Where what is left fails, in up to three sentences.
  std::string where_left() const {
    std::string text;
    constexpr std::size_t kSentences = 3;
    for (std::size_t i = 0; i < std::min(kSentences, result_.left.findings.size()); ++i)
      text += " " + result_.left.findings[i].sentence + ".";
    return text;
  }

  void name_confusions(const Rivals& rivals) {
    const auto id = [&](std::size_t item) { return pool_.candidate(item).choice.effect->id; };
    const auto note = [&](CandidateFinding& finding, const std::string& name) {
      auto& list = finding.confounded_with;
      if (std::find(list.begin(), list.end(), name) == list.end()) list.push_back(name);
    };
    std::vector<std::size_t> alike = rivals.close;
    alike.push_back(chosen_.front());
    const auto is_alike = [&](std::size_t item) {
      return std::find(alike.begin(), alike.end(), item) != alike.end();
    };
    for (std::size_t i = 0; i < shown_.size(); ++i) {
      if (rivals.best && shown_[i] == *rivals.best) result_.runner_up = i;
      if (!is_alike(shown_[i])) continue;
      for (const std::size_t other : alike)
        if (other != shown_[i]) note(result_.candidates[i], id(other));
      if (shown_[i] == chosen_.front())
        for (const std::size_t rival : rivals.same) note(result_.candidates[i], id(rival));
    }
  }

  const DiagnoseOptions& options_;
  const Measurement& measurement_;
  Machine machine_;
  FitResult base_;
  std::string text_;  // of the machine, fitted
  Evidence evidence_;
  std::vector<ScannedCandidate> list_;
  Scanner scanner_;
  Pool pool_;
  SelectionProblem problem_;
  std::vector<std::size_t> entry_item_, chosen_, shown_;
  Rivals rivals_;
  double criterion_ = 0, chi_square_ = 0, correlation_time_ = 1;
  Diagnosis result_;
};

Column Diagnoser::evaluate_term(const Machine& scratch, const std::string& text) const {
  return ::vernier::evaluate(scratch, *parse_expression_for(scratch, text), evidence_.measurement().states);
}

}  // namespace

const char* verdict_name(Verdict verdict) {
  switch (verdict) {
    case Verdict::kMissingEffect:
      return "missing-effect";
    case Verdict::kAmbiguous:
      return "ambiguous";
    case Verdict::kUnexplained:
      return "unexplained";
    case Verdict::kInstrument:
      return "instrument";
    case Verdict::kConsistent:
      break;
  }
  return "consistent";
}

Measurement rebind(const Measurement& measurement, const Machine& from, const Machine& to) {
  Measurement result = measurement;
  result.states.input.clear();
  std::vector<char> empty(measurement.rows(), 0);
  std::vector<char> used(measurement.candidates.size(), 0);
  for (const Input& input : to.inputs) {
    if (const auto known = from.find_input(input.name)) {
      result.states.input.push_back(measurement.states.input[*known]);
      continue;
    }
    Column column = Column::Constant(static_cast<Eigen::Index>(measurement.rows()), input.reference);
    for (std::size_t i = 0; i < measurement.candidates.size(); ++i) {
      if (measurement.candidates[i].name != input.name) continue;
      column = measurement.candidates[i].value;
      used[i] = 1;
      for (std::size_t row = 0; row < measurement.rows(); ++row)
        if (!std::isfinite(column[static_cast<Eigen::Index>(row)])) empty[row] = 1;
    }
    result.states.input.push_back(column);
  }
  result.candidates.clear();
  for (std::size_t i = 0; i < used.size(); ++i)
    if (used[i] == 0) result.candidates.push_back(measurement.candidates[i]);
  std::vector<std::size_t> keep;
  for (std::size_t row = 0; row < measurement.rows(); ++row)
    if (empty[row] == 0) keep.push_back(row);
  if (keep.size() == measurement.rows()) return result;
  const std::size_t excluded = measurement.excluded + measurement.rows() - keep.size();
  result = select_rows(result, keep);
  result.excluded = excluded;
  return result;
}

Diagnosis diagnose(const std::string& text, const Machine& machine, const Measurement& measurement,
                   const DiagnoseOptions& options) {
  return Diagnoser(text, machine, measurement, options).run();
}

}  // namespace vernier
