// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/check/evidence_of_change.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <optional>

#include "tools/maths/chance.h"
#include "tools/maths/decompositions.h"
#include "tools/text/assurance.h"

namespace vernier::check {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

/// Smallest part of the readings' information on a tested parameter that remains after the uncertainty of the
/// fit. Below it the parameter is not seen.
constexpr double kSeen = 1e-6;
/// Part of the rate of false alarms that the test of the readings' scatter has; the evidence has the rest.
constexpr double kScatterShare = 0.2;
/// Standard deviations of a change that a check is sure to show.
constexpr double kShown = 5;
/// Chance of the scatter below which it reduces the evidence of its check. Scatter by chance would hide one
/// change in 40 (measured with Checks.AChangeIsNamedWithItsSize).
constexpr double kLoudChance = 1e-3;
/// Sizes of a change, in standard deviations of the first check that could show it, that are mixed with equal
/// weight.
constexpr std::array kSizes = {2.0, 4.0, 8.0, 16.0, 32.0, 64.0};

/// Evidence on one tested parameter from a certain check onwards.
struct Information {
  double amount = 0, score = 0;  // of a change by 1; its most likely value is score / amount
  /// scatter: square of the readings' noise over their stated uncertainty, at least 1. It reduces the
  /// evidence only: the expected ratio without a change stays below 1.
  double log_ratio(double size, double scatter) const {
    const double share = size * size * amount;
    return -0.5 * std::log1p(share) + 0.5 * size * size * score * score / (1 + share) / scatter;
  }
};

/// Chance below which the scatter of the k-th check (from 1) is reported.
double scatter_limit(double false_alarms, double k) { return kScatterShare * false_alarms / (k * (k + 1)); }

double log_sum(const std::vector<double>& logs) {
  if (logs.empty()) return -1e300;
  const double most = *std::max_element(logs.begin(), logs.end());
  double sum = 0;
  for (const double one : logs) sum += std::exp(one - most);
  return most + std::log(sum);
}

class Judge {
 public:
  Judge(const model::Machine& machine, const std::vector<CheckRecord>& checks,
        std::vector<std::string> left_out, double false_alarms)
      : checks_(checks), last_(checks.back()), left_out_(std::move(left_out)), false_alarms_(false_alarms) {
    answer_.alarm = 1 / ((1 - kScatterShare) * false_alarms);
    for (const CheckedQuantity& one : last_.quantities) unmeasured_.push_back(is_unmeasured(machine, one));
    const MatrixXd spread = spread_of_fit(machine, last_.quantities, last_.parameters);
    const auto p = static_cast<Index>(last_.parameters);
    from_.resize(checks.size());
    for (std::size_t k = checks.size(); k-- > 0;) {
      from_[k].gram = checks[k].gram;
      from_[k].moment = checks[k].moment;
      if (k + 1 == checks.size()) continue;
      from_[k].gram += from_[k + 1].gram;
      from_[k].moment += from_[k + 1].moment;
    }
    // Uncertainty of the fit, reduced by the checks up to each one: L (1 + L' G L)^-1 L'.
    const auto doubt_beside = [&](const MatrixXd& gram) -> MatrixXd {
      const MatrixXd inner =
          MatrixXd::Identity(spread.cols(), spread.cols()) + spread.transpose() * gram * spread;
      return spread * maths::solve_positive(inner, spread.transpose());
    };
    MatrixXd told = MatrixXd::Zero(p, p);
    for (const CheckRecord& check : checks) {
      told += check.gram.topLeftCorner(p, p);
      doubt_after_.push_back(doubt_beside(told));
      doubt_of_.push_back(doubt_beside(check.gram.topLeftCorner(p, p)));
    }
  }

  CheckAnswer answer() {
    look_at_noise();
    weigh();
    decide();
    return std::move(answer_);
  }

 private:
  struct Sum {
    MatrixXd gram;
    VectorXd moment;
  };

  VectorXd parameters_of(const MatrixXd& gram, Index quantity) const {
    return gram.col(quantity).head(static_cast<Index>(last_.parameters));
  }

  /// Information on a tested parameter, given parameters that are uncertain by `doubt`.
  double amount_beside(const MatrixXd& gram, Index quantity, const MatrixXd& doubt) const {
    const VectorXd with = parameters_of(gram, quantity);
    return gram(quantity, quantity) - with.dot(doubt * with);
  }

  Information information(std::size_t since, Index quantity) const {
    const MatrixXd& doubt = doubt_after_.back();
    const VectorXd through = doubt * parameters_of(from_[since].gram, quantity);
    return {amount_beside(from_[since].gram, quantity, doubt),
            from_[since].moment[quantity] - through.dot(from_[0].moment.head(through.size()))};
  }

  bool is_seen(std::size_t since, Index quantity, const Information& one) const {
    const double full = from_[since].gram(quantity, quantity);
    return full > 0 && one.amount > kSeen * full;
  }

  /// The first check from `since` on that could show a change of this parameter; `nullopt`: no check so far.
  std::optional<std::size_t> first_look(std::size_t since, Index quantity) const {
    for (std::size_t k = since; k < checks_.size(); ++k) {
      const MatrixXd& gram = checks_[k].gram;
      const double full = gram(quantity, quantity);
      if (full > 0 && amount_beside(gram, quantity, doubt_after_[k]) > kSeen * full) return k;
    }
    return std::nullopt;
  }

  /// A change since a check, of a parameter that this check or an earlier one tested. Weights are fixed
  /// before the readings that they weigh: a parameter that a later check adds changes no weight.
  std::vector<Index> quantities_at(std::size_t since) const {
    std::vector<Index> known;
    for (Index j = 0; j < static_cast<Index>(last_.quantities.size()); ++j)
      for (std::size_t k = 0; k <= since; ++k)
        if (checks_[k].gram(j, j) > 0) {
          known.push_back(j);
          break;
        }
    return known;
  }

  void weigh() {
    std::vector<double> all;
    std::map<Index, std::vector<std::pair<double, std::size_t>>> of_quantity;
    for (std::size_t since = 0; since < checks_.size(); ++since) {
      const auto k = static_cast<double>(since + 1);
      const std::vector<Index> known = quantities_at(since);
      // A change at any later check has its share: 1/2, 1/6, 1/12 ...
      const double whole = -std::log(k * (k + 1));
      if (known.empty()) all.push_back(whole);  // no information: a ratio of one
      const double share = whole - std::log(static_cast<double>(std::max<std::size_t>(1, known.size())));
      for (const Index j : known) {
        const Information one = information(since, j);
        const auto first = first_look(since, j);
        if (!first || unmeasured_[static_cast<std::size_t>(j)] || !is_seen(since, j, one)) {
          all.push_back(share);
          continue;
        }
        std::vector<double> sizes;
        for (const double size : kSizes)
          sizes.push_back(one.log_ratio(size / std::sqrt(first_amount(*first, j)), scatter_since(since)));
        const double ratio = share + log_sum(sizes) - std::log(static_cast<double>(kSizes.size()));
        all.push_back(text::decisive(
            ratio, "the evidence for a change of " + last_.quantities[static_cast<std::size_t>(j)].name));
        of_quantity[j].emplace_back(ratio, since);
      }
    }
    // The remaining weight is on changes that are still to come.
    all.push_back(-std::log(static_cast<double>(checks_.size() + 1)));
    const double total = log_sum(all);
    answer_.evidence = text::decisive(std::exp(std::min(total, 700.0)), "the evidence for a change");
    for (const auto& [j, ratios] : of_quantity) {
      std::vector<double> logs;
      for (const auto& one : ratios) logs.push_back(one.first);
      const std::size_t since = std::max_element(ratios.begin(), ratios.end())->second;
      const Information one = information(since, j);
      ranked_.push_back({last_.quantities[static_cast<std::size_t>(j)], one.score / one.amount,
                         std::sqrt(scatter_since(since) / one.amount), std::exp(log_sum(logs) - total),
                         since});
    }
    std::sort(ranked_.begin(), ranked_.end(),
              [](const Change& a, const Change& b) { return a.weight > b.weight; });
    for (Index j = 0; j < static_cast<Index>(last_.parameters); ++j) {
      const Information one = information(checks_.size() - 1, j);
      const CheckedQuantity& quantity = last_.quantities[static_cast<std::size_t>(j)];
      if (unmeasured_[static_cast<std::size_t>(j)] || !is_seen(checks_.size() - 1, j, one))
        answer_.not_seen.push_back(quantity.name);
      else
        answer_.resolved.push_back({quantity, 0, 1 / std::sqrt(one.amount), 0, checks_.size() - 1});
    }
  }

  /// Information of the first check alone that could show a change since then. It is known before the
  /// readings of the check, as required for the size of the change that is searched.
  double first_amount(std::size_t first, Index quantity) const {
    return amount_beside(checks_[first].gram, quantity, doubt_after_[first]);
  }

  /// chi^2 of one check that remains beside the uncertainty of the fit and the change of any one tested
  /// parameter. Without a change it is at most that of its degrees of freedom.
  struct Remainder {
    double square = 0, freedom = 0;
  };
  Remainder beside_one_change(std::size_t k) const {
    const CheckRecord& check = checks_[k];
    if (!(check.square > 0) || check.beyond_set_up < 2) return {};
    const MatrixXd& doubt = doubt_of_[k];
    const VectorXd moment = check.moment.head(doubt.rows());
    const double whole = std::max(0.0, check.square - moment.dot(doubt * moment));
    double best = whole;
    for (Index j = 0; j < check.gram.rows(); ++j) {
      const VectorXd with = parameters_of(check.gram, j);
      const double amount = check.gram(j, j) - with.dot(doubt * with);
      if (unmeasured_[static_cast<std::size_t>(j)] || !(amount > kSeen * check.gram(j, j))) continue;
      const double score = check.moment[j] - with.dot(doubt * moment);
      best = std::min(best, whole - score * score / amount);
    }
    return {std::max(0.0, best), check.beyond_set_up - 1};
  }

  /// Square of the noise over the stated uncertainty, of the worst check since then.
  double scatter_since(std::size_t since) const {
    return *std::max_element(scatter_.begin() + static_cast<std::ptrdiff_t>(since), scatter_.end());
  }

  /// Two tests of the scatter have half of its share each: the readings beside all tested parameters, and
  /// beside the most likely change of one of them.
  void look_at_noise() {
    for (std::size_t k = 0; k < checks_.size(); ++k) {
      const Remainder one = beside_one_change(k);
      const bool loud = one.freedom > 0 && maths::chi_square_tail(one.square, one.freedom) < kLoudChance;
      scatter_.push_back(loud ? std::max(1.0, one.square / one.freedom) : 1.0);
    }
    if (last_.freedom >= 1) rest_p_ = std::min(1.0, 2 * maths::chi_square_tail(last_.rest, last_.freedom));
    double chance = rest_p_;
    if (const Remainder one = beside_one_change(checks_.size() - 1); one.freedom > 0)
      chance = std::min(chance, 2 * maths::chi_square_tail(one.square, one.freedom));
    answer_.noise_p = text::decisive(chance, "the probability of the scatter of the readings");
  }

  /// Numbers beyond the set-up of all checks. With fewer than three, any of them may belong to any tested
  /// parameter.
  void state_rules() {
    double beyond = 0;
    for (const CheckRecord& check : checks_) beyond += check.beyond_set_up;
    const bool any_of_machine = std::any_of(ranked_.begin(), ranked_.end(),
                                            [](const Change& one) { return !one.quantity.of_instrument; });
    const auto k = static_cast<double>(checks_.size());
    constexpr double kFewest = 3;  // readings
    text::Assurance& word = answer_.assurance;
    word.at_least("scatter", answer_.noise_p, scatter_limit(false_alarms_, k),
                  "p-value of the scatter: probability that readings with the stated uncertainty scatter at "
                  "least as much as the readings of this check.");
    word.at_least("readings", beyond, kFewest,
                  "Number of readings of all checks, less the number of parameters of the set-up.");
    word.require("sensitivity", any_of_machine, "The readings depend on at least one error of the machine.");
    word.at_most("evidence", answer_.evidence, answer_.alarm,
                 "Evidence (e-value) for a change of the machine or the instrument.");
    if (!answer_.not_seen.empty())
      word.not_covered(
          fmt::format("No change can be detected of these quantities, because the readings do not depend on "
                      "them or the fit did not measure them: {}.",
                      fmt::join(answer_.not_seen, ", ")));
    for (const Change& one : answer_.resolved)
      word.not_covered(fmt::format("A change of {} by less than about {:.2g} {} (five standard deviations).",
                                   one.quantity.name, kShown * one.std, one.quantity.unit));
    for (const std::string& label : left_out_)
      word.not_covered(fmt::format("Check \"{}\": its readings scatter more than stated.", label));
  }

  bool fails(const char* rule) const {
    const auto failed = answer_.assurance.because();
    return !answer_.assurance.holds() &&
           std::any_of(failed.begin(), failed.end(), [&](const auto& one) { return one.rule == rule; });
  }

  void decide() {
    state_rules();
    const bool alarm = fails("evidence");
    const bool scatters = fails("scatter");
    const bool beside_all = rest_p_ < scatter_limit(false_alarms_, static_cast<double>(checks_.size()));
    // A change that is evident beside the larger noise is reported.
    if (beside_all || (scatters && !alarm) ||
        (alarm && !ranked_.empty() && ranked_.front().quantity.of_instrument))
      return report_instrument(scatters && (beside_all || !alarm), beside_all);
    if (fails("readings") || fails("sensitivity")) {
      answer_.verdict = CheckVerdict::kTooLittle;
      answer_.explanation =
          "The readings determine only the set-up of the instrument. Measure more points with larger "
          "distances between them.";
      return;
    }
    if (alarm) return report_change();
    answer_.verdict = CheckVerdict::kValid;
    answer_.explanation = fmt::format("No evidence for a change ({:.3g}, alarm threshold {:g}).",
                                      answer_.evidence, answer_.alarm);
    if (!answer_.not_seen.empty())
      answer_.explanation += fmt::format(
          " {}. The check cannot report a change of the quantities in this list.", not_seen_words());
  }

  /// Parameters on which the readings give no evidence, the first of a long list.
  std::string not_seen_words() const {
    constexpr std::size_t kNamed = 8;  // names that a person reads in a sentence
    const std::size_t count = std::min(kNamed, answer_.not_seen.size());
    const std::vector<std::string> first(answer_.not_seen.begin(),
                                         answer_.not_seen.begin() + static_cast<std::ptrdiff_t>(count));
    return fmt::format(
        "The readings do not depend on these quantities, or the fit did not measure them: {}{}",
        fmt::join(first, ", "),
        answer_.not_seen.size() > count ? fmt::format(" and {} more", answer_.not_seen.size() - count) : "");
  }

  void report_instrument(bool scatters, bool beside_all) {
    answer_.verdict = CheckVerdict::kInstrument;
    if (!scatters) {
      answer_.explanation =
          fmt::format("{} by {:.3g} {} +- {:.2g}.", ranked_.front().quantity.name, ranked_.front().change,
                      ranked_.front().quantity.unit, ranked_.front().std);
      return;
    }
    answer_.explanation = fmt::format(
        "The readings scatter by {:.2g} times their stated uncertainty, {} (probability that noise alone "
        "causes this scatter: {:.1g}).",
        std::sqrt(beside_all ? last_.rest / last_.freedom : scatter_.back()),
        beside_all ? "also after a fit of all tested parameters"
                   : "and no change of a single parameter explains this scatter",
        answer_.noise_p);
  }

  void report_change() {
    answer_.verdict = CheckVerdict::kChanged;
    const Change& best = ranked_.front();
    answer_.changed.push_back(best);
    constexpr double kNearly = 0.05;  // of the likeliest one's weight
    for (std::size_t i = 1; i < ranked_.size(); ++i)
      if (ranked_[i].weight > kNearly * best.weight)
        answer_.not_told_apart.push_back(ranked_[i].quantity.name);
    answer_.explanation =
        fmt::format("{} has changed by {:.4g} +- {:.2g} {} since check {} ({}).", best.quantity.name,
                    best.change, best.std, best.quantity.unit, best.since + 1, checks_[best.since].label);
    constexpr double kLoud = 1.5;  // times the stated uncertainty
    if (const double loud = std::sqrt(scatter_since(best.since)); loud > kLoud)
      answer_.explanation += fmt::format(
          " In addition to this change, the readings scatter by {:.2g} times their stated uncertainty.",
          loud);
    if (!answer_.not_told_apart.empty())
      answer_.explanation += fmt::format(" The readings do not distinguish this change from a change of: {}.",
                                         fmt::join(answer_.not_told_apart, ", "));
  }

  const std::vector<CheckRecord>& checks_;
  const CheckRecord& last_;
  std::vector<std::string> left_out_;
  double false_alarms_;
  std::vector<Sum> from_;                         // over the checks from each on
  std::vector<MatrixXd> doubt_after_, doubt_of_;  // after the checks up to each; after each one alone
  std::vector<double> scatter_;                   // of each check, as scatter_since
  std::vector<bool> unmeasured_;                  // by no reading of the fit
  double rest_p_ = 1;
  std::vector<Change> ranked_;
  CheckAnswer answer_;
};

}  // namespace

const char* verdict_name(CheckVerdict verdict) {
  constexpr const char* kNames[] = {"valid", "changed", "instrument", "too-little"};
  return kNames[static_cast<std::size_t>(verdict)];
}

namespace {

/// Checks with the tested parameters of all of them, in one order. A check has no information on a parameter
/// that it did not test.
std::vector<CheckRecord> aligned(const std::vector<CheckRecord>& checks) {
  std::vector<CheckedQuantity> all = checks.back().quantities;
  for (const CheckRecord& check : checks)
    for (const CheckedQuantity& one : check.quantities)
      if (std::find(all.begin(), all.end(), one) == all.end()) all.push_back(one);
  std::vector<CheckRecord> result;
  for (const CheckRecord& check : checks) {
    CheckRecord wide = check;
    wide.quantities = all;
    wide.gram = MatrixXd::Zero(static_cast<Index>(all.size()), static_cast<Index>(all.size()));
    wide.moment = VectorXd::Zero(static_cast<Index>(all.size()));
    std::vector<Index> at;
    for (const CheckedQuantity& one : check.quantities)
      at.push_back(std::find(all.begin(), all.end(), one) - all.begin());
    wide.gram(at, at) = check.gram;
    wide.moment(at) = check.moment;
    result.push_back(std::move(wide));
  }
  return result;
}

}  // namespace

CheckAnswer judge(const model::Machine& machine, const std::vector<CheckRecord>& checks,
                  double false_alarms) {
  std::vector<CheckRecord> all = aligned(checks);
  std::vector<std::string> left_out;
  for (std::size_t i = 0; i < all.size(); ++i) {
    const auto k = static_cast<double>(i + 1);
    if (all[i].freedom < 1 ||
        2 * maths::chi_square_tail(all[i].rest, all[i].freedom) >= scatter_limit(false_alarms, k))
      continue;
    // Scatter and evidence come from different parts of the readings: the exclusion of a check favours no
    // parameter.
    all[i].gram.setZero();
    all[i].moment.setZero();
    all[i].square = 0;
    if (i + 1 < all.size()) left_out.push_back(all[i].label);
  }
  return Judge(machine, all, std::move(left_out), false_alarms).answer();
}

}  // namespace vernier::check
