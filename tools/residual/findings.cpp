// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/residual/findings.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>

#include "tools/format/columns.h"
#include "tools/maths/chance.h"
#include "tools/maths/factors.h"
#include "tools/residual/sentence.h"

namespace vernier::residual {
namespace {

constexpr std::size_t kMostFindings = 6;  // of a kind
/// Another column that explains this part of the chosen column's effect is equivalent to it.
constexpr double kAlike = 0.97;
/// Functions that differ in less than this part of their squared length cannot be distinguished.
constexpr double kTellable = 1e-3;
/// Of the variance: a smaller share is not reported, however significant.
constexpr double kWorthSaying = 0.002;
/// Rows for each removed function, and for each tested lag: most of the information stays in the residual,
/// and a correlation is a mean over at least three quarters of the rows.
constexpr std::size_t kRowsPerFunction = 4;
/// Longest lag of a serial correlation. The sum of Bartlett's formula ends before, at the first lag without
/// a significant correlation; the limit bounds the time.
constexpr std::size_t kMostLag = 200;
/// The ends of a curve differ by this part of its whole height: the curve has no turning point that a user
/// sees.
constexpr double kMonotone = 0.9;
/// The rows of a run decide about a curve if there are at least this many. Mean and slope use two of them.
constexpr double kLeastRowsOfRun = 5;
/// A run agrees with the curve over all runs if its own size is within this factor. Its uncertainty is at
/// most 0.3 of the size, so that an agreeing run is beyond the factor by two standard deviations only.
constexpr double kAgreement = 2.5;
/// A smaller correlation of neighbours is not reported: it explains 2 % of the variance of the next row.
constexpr double kLeastCorrelation = 0.15;

/// Step of which all positions of a column are multiples, from the first position; nullopt if they are
/// scattered.
std::optional<double> step_of(const KindSample& sample, const RecordedColumn& column) {
  std::vector<double> values;
  for (const std::size_t row : sample.rows) values.push_back(column.value[static_cast<Eigen::Index>(row)]);
  std::sort(values.begin(), values.end());
  const double range = values.back() - values.front();
  constexpr double kEqual = 1e-6;   // of the range: digits of a file
  constexpr double kMostSteps = 4;  // for each position: more are digits of the file, not a step
  double step = range, positions = 1;
  for (std::size_t i = 1; i < values.size(); ++i)
    if (values[i] - values[i - 1] > kEqual * range) {
      step = std::min(step, values[i] - values[i - 1]);
      ++positions;
    }
  if (range > kMostSteps * positions * step) return std::nullopt;
  for (const double at : values) {
    const double steps = (at - values.front()) / step;
    if (std::abs(steps - std::round(steps)) > kEqual * range / step) return std::nullopt;
  }
  return step;
}

/// A selected term, with its additional functions (a period is not a function of the basis).
struct Taken {
  BasisTerm term;
  std::optional<Period> period;
  double log_p = 0;
  std::vector<double> parts = {};  // further periods of the same pattern
};

class Search {
 public:
  Search(const KindSample& sample, const FindingContext& context)
      : sample_(sample),
        context_(context),
        base_(sample.moments),
        matrix_(sample.basis->matrix),
        plain_(sample.weight.cwiseProduct(sample.residual)),
        held_(sample.held) {
    base_.least_remainder = kTellable;
    now_ = base_;
  }

  std::vector<Taken> run() {
    quick_ = quick_functions();
    take_constant();
    while (taken_.size() < kMostFindings && take_best()) {
    }
    prune();
    join_periods();
    if (!constant_needed())
      std::erase_if(taken_, [](const Taken& one) { return one.term.shape == Shape::kConstant; });
    return taken_;
  }

  /// Functions of all selected terms except `except`, the constant first. Last are the functions
  /// that products need, so that they represent only the interaction.
  maths::FunctionSet others(std::size_t except) const {
    maths::FunctionSet set{0}, own{0};
    for (std::size_t i = 0; i < taken_.size(); ++i) {
      const BasisTerm& term = taken_[i].term;
      if (term.shape == Shape::kConstant) continue;
      if (i != except) set.insert(set.end(), term.subject.begin(), term.subject.end());
      own.insert(own.end(), term.subject.begin(), term.subject.end());
    }
    for (const Taken& one : taken_)
      for (const Eigen::Index f : one.term.adjust)
        if (std::find(own.begin(), own.end(), f) == own.end()) set.push_back(f);
    return set;
  }
  const maths::Moments& moments() const { return base_; }
  /// Without the constant.
  maths::Moments centred() const {
    maths::Moments moments = base_;
    maths::condition_on(moments, {0});
    return moments;
  }
  const Eigen::VectorXd& held() const { return held_; }
  const Eigen::MatrixXd& matrix() const { return matrix_; }

 private:
  std::size_t run_of(std::size_t i) const { return context_.measurement.states.run[sample_.rows[i]]; }

  /// Sum over the pairs of rows with distance `lag` within a run, divided by the sum of squares.
  double at_lag(const Eigen::VectorXd& f, std::size_t lag) const {
    double sum = 0;
    for (std::size_t i = 0; i + lag < sample_.rows.size(); ++i)
      if (run_of(i) == run_of(i + lag))
        sum += f[static_cast<Eigen::Index>(i)] * f[static_cast<Eigen::Index>(i + lag)];
    return sum / f.squaredNorm();
  }

  /// Functions of the columns that change from row to row. Their removal does not change serial
  /// correlation.
  maths::FunctionSet quick_functions() const {
    // Correlation of neighbouring rows below which a column changes from row to row.
    constexpr double kQuick = 0.3;
    constexpr std::array kOrders{1, 2, 4};  // the coarse functions first; of curves, see recorded.cpp
    maths::FunctionSet set;
    const std::size_t most = sample_.rows.size() / kRowsPerFunction;
    for (const int order : kOrders)
      for (const BasisTerm& term : sample_.basis->terms) {
        if (term.shape == Shape::kConstant || term.shape == Shape::kProduct || term.order != order) continue;
        if (set.size() + term.subject.size() > most) continue;
        const Eigen::VectorXd first = matrix_.col(term.subject.front());
        if (at_lag((first.array() - first.mean()).matrix(), 1) > kQuick) continue;
        for (const Eigen::Index f : term.subject)
          if (std::find(set.begin(), set.end(), f) == set.end()) set.push_back(f);
      }
    return set;
  }

  /// Factor by which serial correlation increases the variance of this curve's coefficient
  /// (Bartlett). It uses the correlation of the residual beside the curve, up to the first lag at
  /// which it is not significant.
  double inflation(const Eigen::VectorXd& curve, const maths::FunctionSet& with) const {
    if (!(curve.squaredNorm() > 0)) return 1;
    maths::FunctionSet set = with;
    set.insert(set.end(), quick_.begin(), quick_.end());
    const Eigen::VectorXd rest = left(set);
    if (!(rest.squaredNorm() > 0)) return 1;
    const auto n = static_cast<double>(rest.size());
    const std::size_t most_lag = std::min(kMostLag, sample_.rows.size() / kRowsPerFunction);
    double factor = 1;
    for (std::size_t lag = 1; lag <= most_lag; ++lag) {
      const double correlation = at_lag(rest, lag);
      if (correlation < 2 / std::sqrt(n)) break;
      factor += 2 * correlation * at_lag(curve, lag);
    }
    return std::max(1.0, factor);
  }

  Eigen::VectorXd left(const maths::FunctionSet& set) const {
    const Eigen::VectorXd beta = maths::coefficients(moments(), set);
    Eigen::VectorXd rest = held_;
    for (std::size_t i = 0; i < set.size(); ++i)
      rest -= matrix_.col(set[i]) * beta[static_cast<Eigen::Index>(i)];
    return rest;
  }

  /// Selects outliers again after the selected terms, so that a strong effect on few rows is not
  /// taken for outliers.
  void refresh() {
    for (int pass = 0; pass < 2; ++pass) {
      const Eigen::VectorXd explained_part = held_ - left(with({}));
      Eigen::VectorXd rest = plain_ - explained_part;
      hold_outliers(rest);
      held_ = explained_part + rest;
      base_.score = matrix_.transpose() * held_;
      base_.sum = held_.squaredNorm();
    }
    now_ = base_;
    maths::condition_on(now_, {0});
    for (const Taken& one : taken_)
      if (one.term.shape != Shape::kConstant) maths::condition_on(now_, one.term.subject);
  }

  maths::FunctionSet with(const maths::FunctionSet& functions) const {
    maths::FunctionSet set = others(taken_.size());
    set.insert(set.end(), functions.begin(), functions.end());
    return set;
  }

  Eigen::VectorXd curve(const BasisTerm& term, const maths::Moments& in) const {
    maths::FunctionSet set = term.adjust;
    set.insert(set.end(), term.subject.begin(), term.subject.end());
    const Eigen::VectorXd beta = maths::coefficients(in, set);
    Eigen::VectorXd f = Eigen::VectorXd::Zero(sample_.held.size());
    for (std::size_t i = 0; i < set.size(); ++i)
      f += matrix_.col(set[i]) * beta[static_cast<Eigen::Index>(i)];
    return f;
  }

  double corrected(double log_p) const {
    return std::min(0.0, log_p + std::log(static_cast<double>(context_.tried)));
  }

  void take_constant() {
    const maths::Explained part = maths::explained(now_, {}, {0});
    const double stretch = inflation(matrix_.col(0), {0});
    const double p = corrected(maths::log_p(now_, part, stretch));
    if (p < std::log(context_.least_p))
      taken_.push_back({{Shape::kConstant, kNoColumn, {}, 0, {0}, {}}, {}, p});
    maths::condition_on(now_, {0});
  }

  bool take_best() {
    struct Option {
      double log_p;
      const BasisTerm* term;
    };
    std::vector<Option> options;
    for (const BasisTerm& term : sample_.basis->terms) {
      if (term.shape == Shape::kConstant) continue;
      const maths::Explained part = maths::explained(now_, term.adjust, term.subject);
      if (part.rank > 0) options.push_back({maths::log_p(now_, part), &term});
    }
    std::sort(options.begin(), options.end(),
              [](const Option& a, const Option& b) { return a.log_p < b.log_p; });
    constexpr std::size_t kMostTries =
        8;  // beyond, serial correlation has made all significant terms insignificant
    for (std::size_t i = 0; i < std::min(kMostTries, options.size()); ++i) {
      const BasisTerm& term = *options[i].term;
      if (corrected(options[i].log_p) >= std::log(context_.least_p)) break;
      const double stretch = inflation(curve(term, now_), with(term.subject));
      const double p =
          corrected(maths::log_p(now_, maths::explained(now_, term.adjust, term.subject), stretch));
      if (p >= std::log(context_.least_p)) continue;
      if (const auto period = better_period(p)) return take_period(*period);
      taken_.push_back({term, {}, p});
      refresh();
      return true;
    }
    if (const auto period = better_period(std::log(context_.least_p))) return take_period(*period);
    return false;
  }

  struct Found {
    Period period;
    std::size_t column;
    double log_p;
  };

  /// Returns the strongest sine over an axis, if its p-value is below `than`.
  std::optional<Found> better_period(double than) const {
    std::optional<Found> best;
    const Eigen::VectorXd rest = left(with({}));
    for (std::size_t i = 0; i < context_.columns.size(); ++i) {
      if (context_.columns[i].kind != ColumnKind::kAxis) continue;
      const auto period = strongest_period(sample_, context_.columns[i], rest);
      if (!period) continue;
      const auto f = sine_functions(i, period->length);
      const double stretch = inflation(f.first * period->factor[0] + f.second * period->factor[1], with({}));
      const double p = corrected(maths::log_p(now_, period->part, stretch));
      if (p < than && (!best || p < best->log_p)) best = Found{*period, i, p};
    }
    return best;
  }

  std::pair<Eigen::VectorXd, Eigen::VectorXd> sine_functions(std::size_t column, double length) const {
    const auto n = sample_.held.size();
    Eigen::VectorXd s(n), c(n);
    for (Eigen::Index i = 0; i < n; ++i) {
      const double x = context_.columns[column]
                           .value[static_cast<Eigen::Index>(sample_.rows[static_cast<std::size_t>(i)])];
      const double angle = 2 * std::numbers::pi * x / length;
      s[i] = sample_.weight[i] * std::sin(angle);
      c[i] = sample_.weight[i] * std::cos(angle);
    }
    return {s.normalized(), c.normalized()};
  }

  /// Is a mean required beside lines and parabolas through the columns' own zeros? An error that
  /// is proportional to X has a mean, but is not an offset.
  bool constant_needed() const {
    const auto n = sample_.held.size();
    std::vector<Eigen::VectorXd> functions;
    for (const Taken& one : taken_) {
      if (one.term.shape == Shape::kConstant) continue;
      if (one.term.shape != Shape::kLinear) {
        for (const Eigen::Index f : one.term.subject) functions.emplace_back(matrix_.col(f));
        continue;
      }
      Eigen::VectorXd raw(n);
      for (Eigen::Index i = 0; i < n; ++i) {
        const double x = context_.columns[one.term.column]
                             .value[static_cast<Eigen::Index>(sample_.rows[static_cast<std::size_t>(i)])];
        raw[i] = std::isnan(x) ? 0 : sample_.weight[i] * x;
      }
      functions.push_back(raw.normalized());
    }
    maths::Moments small;
    Eigen::MatrixXd matrix(n, static_cast<Eigen::Index>(functions.size()) + 1);
    maths::FunctionSet all;
    for (std::size_t i = 0; i < functions.size(); ++i) {
      matrix.col(static_cast<Eigen::Index>(i)) = functions[i];
      all.push_back(static_cast<Eigen::Index>(i));
    }
    matrix.rightCols(1) = matrix_.col(0);
    small.gram = matrix.transpose() * matrix;
    small.score = matrix.transpose() * held_;
    small.sum = held_.squaredNorm();
    small.freedom = sample_.moments.freedom;
    const maths::Explained part = maths::explained(small, all, {matrix.cols() - 1});
    return corrected(maths::log_p(small, part)) < std::log(context_.least_p);
  }

  /// Adds a period as two functions to the basis.
  bool take_period(const Found& found) {
    Period period = found.period;
    period.length = refined_period(sample_, context_.columns[found.column], left(with({})), period.length);
    const auto [s, c] = sine_functions(found.column, period.length);
    const Eigen::Index first = matrix_.cols();
    Eigen::MatrixXd both(matrix_.rows(), 2);
    both << s, c;
    const Eigen::MatrixXd cross = matrix_.transpose() * both;
    base_.gram.conservativeResize(first + 2, first + 2);
    base_.gram.block(0, first, first, 2) = cross;
    base_.gram.block(first, 0, 2, first) = cross.transpose();
    base_.gram.block(first, first, 2, 2) = both.transpose() * both;
    base_.score.conservativeResize(first + 2);
    base_.score.tail(2) = both.transpose() * held_;
    matrix_.conservativeResize(Eigen::NoChange, first + 2);
    matrix_.rightCols(2) = both;
    BasisTerm term{Shape::kPeriodic, found.column, {}, 0, {first, first + 1}, {}};
    taken_.push_back({term, period, found.log_p, {}});
    refresh();
    return true;
  }

  /// Are two periods of a column parts of one pattern? Neighbours within one cycle over the range describe a
  /// sine whose amplitude or period changes along the axis; multiples of a frequency describe a pattern that
  /// is no sine. At positions that are multiples of a step, a multiple appears at its alias.
  static bool of_one_pattern(double one, double other, double range, std::optional<double> step) {
    constexpr double kNeighbour = 1, kMultiple = 0.1;  // cycles over the range
    constexpr int kMostMultiple = 6;
    const double first = range / one, second = range / other;
    if (std::abs(first - second) < kNeighbour) return true;
    for (int times = 2; times <= kMostMultiple; ++times) {
      const double tolerance = kMultiple * times;
      if (std::abs(first - times * second) < tolerance) return true;
      double multiple = times * first;
      if (step) multiple = std::abs(std::remainder(multiple, range / *step));
      if (std::abs(multiple - second) < tolerance) return true;
    }
    return false;
  }

  /// Joins the periods of one pattern to one term, that of the strongest period.
  void join_periods() {
    for (std::size_t i = 0; i < taken_.size(); ++i) {
      if (!taken_[i].period) continue;
      const auto [low, high] = range_of(sample_, context_.columns[taken_[i].term.column]);
      const double range = high - low;
      const std::optional<double> step = step_of(sample_, context_.columns[taken_[i].term.column]);
      for (std::size_t k = taken_.size() - 1; k > i; --k) {
        const Taken& part = taken_[k];
        if (!part.period || part.term.column != taken_[i].term.column ||
            !of_one_pattern(taken_[i].period->length, part.period->length, range, step))
          continue;
        taken_[i].term.subject.insert(taken_[i].term.subject.end(), part.term.subject.begin(),
                                      part.term.subject.end());
        taken_[i].parts.insert(taken_[i].parts.begin(), part.period->length);
        taken_.erase(taken_.begin() + static_cast<std::ptrdiff_t>(k));
      }
    }
  }

  /// Removes terms that the others have made superfluous, weakest first.
  void prune() {
    for (bool again = true; again;) {
      again = false;
      std::size_t weakest = taken_.size();
      double most = std::log(context_.least_p);
      for (std::size_t i = 0; i < taken_.size(); ++i) {
        if (taken_[i].term.shape == Shape::kConstant) continue;
        const maths::Explained part = maths::explained(moments(), others(i), taken_[i].term.subject);
        double p = corrected(maths::log_p(moments(), part));
        // A term too small to report is removed before a term that may be chance.
        if (part.sum < kWorthSaying * base_.sum) p = 1 - part.sum / base_.sum;
        if (p <= most) continue;
        most = p;
        weakest = i;
      }
      if (weakest == taken_.size()) break;
      taken_.erase(taken_.begin() + static_cast<std::ptrdiff_t>(weakest));
      again = true;
    }
  }

  const KindSample& sample_;
  const FindingContext& context_;
  maths::Moments base_;     // with the selected periods
  maths::Moments now_;      // beyond the selected terms
  Eigen::MatrixXd matrix_;  // as base_
  Eigen::VectorXd plain_;   // weighted residual
  Eigen::VectorXd held_;    // with limited outliers
  maths::FunctionSet quick_;
  std::vector<Taken> taken_;
};

double adjusted_share(double sum, double rank, double whole, double freedom) {
  if (!(whole > 0) || freedom - rank <= 0) return 0;
  return std::clamp(1 - (1 - sum / whole) * freedom / (freedom - rank), 0.0, 1.0);
}

/// Fills a finding from the selected term: curve, range, runs, sentence.
class Describer {
 public:
  Describer(const KindSample& sample, const FindingContext& context, const Search& search,
            const std::vector<Taken>& taken)
      : sample_(sample), context_(context), search_(search), taken_(taken) {
    maths::FunctionSet all = search.others(taken.size());
    const Eigen::VectorXd beta = maths::coefficients(search.moments(), all);
    rest_ = search.held();
    for (std::size_t i = 0; i < all.size(); ++i)
      rest_ -= search.matrix().col(all[i]) * beta[static_cast<Eigen::Index>(i)];
    scale_ = model::is_rotation(sample.kind) ? maths::kUradPerDeg : maths::kUmPerMm;
    std::size_t from = 1;
    for (const Taken& one : taken) {
      Eigen::VectorXd curve = Eigen::VectorXd::Zero(sample.held.size());
      const bool constant = one.term.shape == Shape::kConstant;
      for (std::size_t k = 0; k < one.term.subject.size(); ++k)
        curve += search.matrix().col(one.term.subject[k]) *
                 beta[static_cast<Eigen::Index>(constant ? 0 : from + k)];
      if (!constant) from += one.term.subject.size();
      curves_.push_back(curve);
    }
    limit_curves();
  }

  Finding finding(std::size_t at) const {
    const Taken& one = taken_[at];
    Finding f;
    SentenceFacts facts;
    f.observation = sample_.name();
    f.shape = one.term.shape;
    f.p_value = std::exp(one.log_p);
    shares(at, f);
    const Eigen::VectorXd curve = scale_ * curves_[at].cwiseQuotient(sample_.weight);
    const double mean = one.term.shape == Shape::kConstant ? 0 : curve.mean();
    f.rms_um = std::sqrt((curve.array() - mean).square().mean());
    f.low_um = curve.minCoeff() - mean;
    f.high_um = curve.maxCoeff() - mean;
    if (one.period) {
      f.period = one.period->length;
      f.parts = one.parts;
      find_aliases(one, f, facts);
    }
    if (one.term.shape == Shape::kPeriodic && !one.period) f.period = 360.0 / one.term.order;
    if (one.term.shape != Shape::kConstant) {
      f.column = context_.columns[one.term.column].name;
      facts.unit = context_.columns[one.term.column].unit;
      if (one.term.second) {
        f.second_column = context_.columns[*one.term.second].name;
        facts.second_unit = context_.columns[*one.term.second].unit;
      }
      along(one.term, (curve.array() - mean).matrix(), facts);
      alike(at, f);
    }
    by_run(at, f, facts);
    f.sentence = sentence_of(f, facts);
    return f;
  }

 private:
  /// Range of the values of a weighted column, without the weight.
  double reach(const Eigen::VectorXd& weighted) const {
    const Eigen::VectorXd values = weighted.cwiseQuotient(sample_.weight);
    return values.maxCoeff() - values.minCoeff();
  }

  /// Two terms of nearly equal columns can cancel each other: each is then larger than anything in the
  /// residual. Such a term is described as it fits the residual alone.
  void limit_curves() {
    const double most = reach(search_.held());
    for (std::size_t i = 0; i < taken_.size(); ++i) {
      if (taken_[i].term.shape == Shape::kConstant || reach(curves_[i]) <= most) continue;
      maths::FunctionSet alone{0};
      alone.insert(alone.end(), taken_[i].term.subject.begin(), taken_[i].term.subject.end());
      const Eigen::VectorXd beta = maths::coefficients(search_.moments(), alone);
      curves_[i].setZero();
      for (std::size_t k = 1; k < alone.size(); ++k)
        curves_[i] += search_.matrix().col(alone[k]) * beta[static_cast<Eigen::Index>(k)];
    }
  }

  /// The shorter periods that give the same readings, if the positions are multiples of one step: the
  /// frequencies 1/step - f and 1/step + f.
  void find_aliases(const Taken& one, Finding& f, SentenceFacts& facts) const {
    const auto found = step_of(sample_, context_.columns[one.term.column]);
    if (!found) return;
    const double step = *found;
    const double frequency = 1 / one.period->length, of_step = 1 / step;
    facts.step = step;
    f.aliases = {1 / (of_step - frequency), 1 / (of_step + frequency)};
  }

  void shares(std::size_t at, Finding& f) const {
    const Taken& one = taken_[at];
    if (one.term.shape == Shape::kConstant) {
      const maths::Moments& m = search_.moments();
      f.share_alone = f.share_after = adjusted_share(maths::explained(m, {}, {0}).sum, 1, m.sum, m.freedom);
      return;
    }
    const maths::Moments m = search_.centred();
    const maths::Explained alone = maths::explained(m, {}, one.term.subject);
    f.share_alone = adjusted_share(alone.sum, alone.rank, m.sum, m.freedom);
    const maths::Explained after = maths::explained(search_.moments(), search_.others(at), one.term.subject);
    f.share_after = m.sum > 0 ? std::clamp(after.sum / m.sum, 0.0, 1.0) : 0;
  }

  double value(const BasisTerm& term, std::size_t i) const {
    return context_.columns[term.column].value[static_cast<Eigen::Index>(sample_.rows[i])];
  }

  /// Describes the curve over its column.
  void along(const BasisTerm& term, const Eigen::VectorXd& curve, SentenceFacts& facts) const {
    std::vector<std::pair<double, double>> points;
    for (std::size_t i = 0; i < sample_.rows.size(); ++i)
      if (const double x = value(term, i); !std::isnan(x))
        points.emplace_back(x, curve[static_cast<Eigen::Index>(i)]);
    std::sort(points.begin(), points.end());
    facts.low = points.front().first;
    facts.high = points.back().first;
    facts.at_low_um = points.front().second;
    facts.at_high_um = points.back().second;
    const auto by_height = [](const auto& a, const auto& b) { return a.second < b.second; };
    facts.highest_at = std::max_element(points.begin(), points.end(), by_height)->first;
    facts.lowest_at = std::min_element(points.begin(), points.end(), by_height)->first;
    const double reach = curve.maxCoeff() - curve.minCoeff();
    facts.monotone = std::abs(facts.at_high_um - facts.at_low_um) > kMonotone * reach;
    const ColumnKind kind = context_.columns[term.column].kind;
    facts.time = kind == ColumnKind::kTime || kind == ColumnKind::kVisit;
    facts.direction = kind == ColumnKind::kDirection;
    if (kind != ColumnKind::kRun) return;
    const auto& names = context_.measurement.states.run_names;
    facts.highest_run = names[static_cast<std::size_t>(facts.highest_at)];
    facts.lowest_run = names[static_cast<std::size_t>(facts.lowest_at)];
  }

  static bool shares_column(const BasisTerm& product, const BasisTerm& term) {
    return !term.second && (product.column == term.column || product.second == term.column);
  }

  /// Is the curve, as fitted over all runs, correct within each run? A run counts if its own rows
  /// would show the curve.
  void by_run(std::size_t at, Finding& f, SentenceFacts& facts) const {
    if (f.shape == Shape::kJumps || f.shape == Shape::kConstant || f.column == format::columns::kRun ||
        f.second_column == format::columns::kRun)
      return;
    const auto& states = context_.measurement.states;
    struct RunSums {
      double n = 0, w = 0, c = 0, y = 0, cc = 0, cy = 0, rr = 0;
    };
    std::vector<RunSums> sums(states.run_names.size());
    for (std::size_t i = 0; i < sample_.rows.size(); ++i) {
      const auto k = static_cast<Eigen::Index>(i);
      RunSums& s = sums[states.run[sample_.rows[i]]];
      const double w = sample_.weight[k], c = curves_[at][k] / w;
      double y = c + rest_[k] / w;
      for (std::size_t other = 0; other < taken_.size(); ++other)
        if (other != at && taken_[other].term.second && shares_column(taken_[other].term, taken_[at].term))
          y += curves_[other][k] / w;
      s.n += 1, s.w += w * w, s.c += w * w * c, s.y += w * w * y, s.cc += w * w * c * c,
          s.cy += w * w * c * y;
      s.rr += rest_[k] * rest_[k];
    }
    const double variance = rest_.squaredNorm() / std::max(1.0, sample_.moments.freedom);
    for (std::size_t run = 0; run < sums.size(); ++run) {
      const RunSums& s = sums[run];
      if (s.n < kLeastRowsOfRun) continue;
      const double cc = s.cc - s.c * s.c / s.w, cy = s.cy - s.c * s.y / s.w;
      const double spread = std::sqrt(std::max(variance, s.rr / s.n) / std::max(cc, 1e-300));
      constexpr double kShown = 0.3;  // of the whole effect: below, the run's rows cannot show it
      if (cc <= 0 || spread > kShown) continue;
      ++f.runs;
      const double slope = cy / cc;
      if (slope > 1 / kAgreement && slope < kAgreement && slope > 2 * spread)
        ++f.runs_agreeing;
      else
        facts.disagreeing.push_back(states.run_names[run]);
    }
    f.in_all_runs = f.runs > 1 && f.runs == f.runs_agreeing;
  }

  /// Finds columns of which one term would fit as well.
  void alike(std::size_t at, Finding& f) const {
    const Taken& one = taken_[at];
    const maths::FunctionSet others = search_.others(at);
    const double own = maths::explained(search_.moments(), others, one.term.subject).sum;
    for (const BasisTerm& term : sample_.basis->terms) {
      if (term.shape == Shape::kConstant || term.second || term.column == one.term.column ||
          term.subject.size() > std::max<std::size_t>(2, one.term.subject.size()))
        continue;
      const std::string& name = context_.columns[term.column].name;
      if (std::find(f.alike.begin(), f.alike.end(), name) != f.alike.end() || name == f.second_column)
        continue;
      if (maths::explained(search_.moments(), others, term.subject).sum > kAlike * own)
        f.alike.push_back(name);
    }
  }

  const KindSample& sample_;
  const FindingContext& context_;
  const Search& search_;
  const std::vector<Taken>& taken_;
  std::vector<Eigen::VectorXd> curves_;  // weighted
  Eigen::VectorXd rest_;                 // weighted
  double scale_ = 1;
};

/// True if a row and the next one are much nearer to each other, in the positions of the axes, than two rows
/// of the survey are on average: as in a bed that is probed row by row. The order of the rows is then also an
/// order in space.
bool follow_each_other_in_space(const KindSample& sample, const model::Measurement& m) {
  constexpr double kMuchNearer = 0.25;  // squares of distances: half of the distance
  double next = 0, any = 0;
  for (const model::Column& axis : m.states.axis) {
    const Eigen::VectorXd at =
        axis(std::vector<Eigen::Index>(sample.rows.begin(), sample.rows.end())).matrix();
    const double spread = (at.array() - at.mean()).square().mean();
    if (!(spread > 0)) continue;
    const Eigen::Index n = at.size();
    next += (at.tail(n - 1) - at.head(n - 1)).squaredNorm() / static_cast<double>(n - 1) / spread;
    any += 2;  // mean square of the difference of two independent values, in units of their variance
  }
  return any > 0 && next < kMuchNearer * any;
}

/// Adds a finding if neighbours in time are correlated after all findings are removed.
void add_wandering(const KindSample& sample, const FindingContext& context, const Search& search,
                   const std::vector<Taken>& taken, std::vector<Finding>& findings) {
  const maths::FunctionSet all = search.others(taken.size());
  const Eigen::VectorXd beta = maths::coefficients(search.moments(), all);
  Eigen::VectorXd rest = search.held();
  for (std::size_t i = 0; i < all.size(); ++i)
    rest -= search.matrix().col(all[i]) * beta[static_cast<Eigen::Index>(i)];
  PairTest best;
  for (const std::size_t phase : {0u, 1u}) {
    const PairTest test = serial_pairs(sample, context.measurement, rest, phase);
    if (test.log_p < best.log_p) best = test;
  }
  const double p = std::exp(std::min(0.0, best.log_p + std::log(static_cast<double>(context.tried))));
  if (p >= context.least_p || best.correlation < kLeastCorrelation) return;
  Finding f;
  f.observation = sample.name();
  f.column = format::columns::kVisit;
  f.shape = Shape::kWanders;
  f.p_value = p;
  const double scale = model::is_rotation(sample.kind) ? maths::kUradPerDeg : maths::kUmPerMm;
  // The part that a row has in common with the next one.
  f.share_alone = f.share_after =
      std::clamp(best.correlation * rest.squaredNorm() / search.centred().sum, 0.0, 1.0);
  f.rms_um = scale * std::sqrt(best.correlation * rest.cwiseQuotient(sample.weight).squaredNorm() /
                               static_cast<double>(rest.size()));
  SentenceFacts facts;
  facts.at_low_um = best.correlation;
  facts.in_space = follow_each_other_in_space(sample, context.measurement);
  f.sentence = sentence_of(f, facts);
  findings.push_back(f);
}

void add_shares(const KindSample& sample, const FindingContext& context, const Search& search,
                const std::vector<Taken>& taken, std::vector<ColumnShare>& shares) {
  const maths::Moments centred = search.centred();
  for (std::size_t column = 0; column < context.columns.size(); ++column) {
    maths::FunctionSet others{0};
    for (const Taken& one : taken)
      if (one.term.column != column && one.term.second.value_or(kNoColumn) != column)
        others.insert(others.end(), one.term.subject.begin(), one.term.subject.end());
    ColumnShare share{sample.name(), context.columns[column].name, 0, 0, 1};
    double least = 0;
    bool any = false;
    for (const BasisTerm& term : sample.basis->terms) {
      if (term.column != column || term.second || term.shape == Shape::kConstant) continue;
      any = true;
      const maths::Moments& m = centred;
      const maths::Explained alone = maths::explained(m, {}, term.subject);
      share.share_alone =
          std::max(share.share_alone, adjusted_share(alone.sum, alone.rank, m.sum, m.freedom));
      least = std::min(least, maths::log_p(m, alone));
      const maths::Explained after = maths::explained(search.moments(), others, term.subject);
      const double left = search.moments().sum - after.sum_before;
      share.share_after =
          std::max(share.share_after, adjusted_share(after.sum, after.rank, left, m.freedom) * left / m.sum);
    }
    if (!any) continue;
    share.p_value = std::exp(std::min(0.0, least + std::log(static_cast<double>(context.tried))));
    shares.push_back(share);
  }
}

}  // namespace

std::size_t count_tried(const KindSample& sample, const std::vector<RecordedColumn>& columns) {
  std::size_t count = sample.basis->terms.size();
  for (const RecordedColumn& column : columns) {
    if (column.kind != ColumnKind::kAxis) continue;
    if (const auto period = strongest_period(sample, column, sample.held)) count += period->tried;
  }
  return count;
}

std::vector<Finding> find_structure(const KindSample& sample, const FindingContext& context,
                                    std::vector<ColumnShare>& shares) {
  Search search(sample, context);
  const std::vector<Taken> taken = search.run();
  const Describer describer(sample, context, search, taken);
  std::vector<Finding> findings;
  for (std::size_t i = 0; i < taken.size(); ++i) findings.push_back(describer.finding(i));
  add_wandering(sample, context, search, taken, findings);
  add_shares(sample, context, search, taken, shares);
  return findings;
}

}  // namespace vernier::residual
