// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/diagnose/doubts/shape.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <optional>
#include <string_view>

#include "tools/format/columns.h"
#include "tools/maths/chance.h"

namespace vernier::diagnose {
namespace {

using Index = Eigen::Index;

/// Positions of the fit observations over the range that was read: 0 .. 1.
Eigen::VectorXd positions(const Evidence& evidence, std::size_t axis) {
  const Evidence::Range range = evidence.range_of(axis);
  const double span = std::max(range.high - range.low, 1e-300);
  return (evidence.at_readings(evidence.position(axis)) - range.low) / span;
}

/// Returns the number of measured positions. Positions closer than `apart` (of the range) count
/// once.
int positions_read(Eigen::VectorXd u, double apart) {
  std::sort(u.begin(), u.end());
  int count = 0;
  double last = -1;
  for (const double one : u) {
    if (one - last < apart) continue;
    ++count;
    last = one;
  }
  return count;
}

/// Line and half-waves over the range, as columns of the readings of a location.
Eigen::MatrixXd half_waves(const Evidence& evidence, const effects::DofPlace& place, const Eigen::VectorXd& u,
                           int count) {
  Eigen::MatrixXd columns(u.size(), count + 1);
  const auto answer = evidence.response(evidence.index_of(place)).array();
  columns.col(0) = answer * u.array();
  for (int m = 1; m <= count; ++m)
    columns.col(m) = answer * (std::numbers::pi * static_cast<double>(m) * u.array()).cos();
  evidence.whiten(columns);
  return columns;
}

/// Derivatives of an item's columns by its scanned unknowns. A small error of a period is not a
/// change along the axis.
Eigen::MatrixXd moved(const Evidence& evidence, const Pool& pool, std::size_t item) {
  // Small relative to the phase of a thousandth of a period at the end of the range.
  constexpr double kStep = 1e-6;  // relative, of a difference
  const std::vector<double>& scanned = pool[item].scored.scanned;
  const effects::Candidate& candidate = pool.candidate(item);
  const Eigen::MatrixXd here = evidence.columns(candidate, scanned);
  Eigen::MatrixXd all(here.rows(), here.cols() * static_cast<Index>(scanned.size()));
  for (std::size_t i = 0; i < scanned.size(); ++i) {
    std::vector<double> there = scanned;
    there[i] *= 1 + kStep;
    all.middleCols(static_cast<Index>(i) * here.cols(), here.cols()) =
        (evidence.columns(candidate, there) - here) / kStep;
  }
  return evidence.beside_model(all);
}

struct Jump {
  double at = 0;    // share of the measured range
  double gain = 0;  // chi^2 that a jump there explains
};

/// The jump along the axis, at one degree of freedom, that explains most.
Jump best_jump(const Evidence& evidence, const effects::DofPlace& place, const Eigen::VectorXd& u,
               const Eigen::MatrixXd& beside) {
  const auto places = static_cast<int>(evidence.thresholds().search.shape.places_of_jump);
  const Eigen::ArrayXd answer = evidence.response(evidence.index_of(place)).array();
  Jump best;
  for (int k = 1; k < places; ++k) {
    const double at = static_cast<double>(k) / places;
    Eigen::MatrixXd column = answer * (u.array() > at).cast<double>();
    evidence.whiten(column);
    if (const Gain gain = gain_of(evidence, column, beside); gain.chi_square > best.gain)
      best = {at, gain.chi_square};
  }
  return best;
}

/// True if both items are functions of the same axis. Functions of the same axis may be pieces of one
/// function.
bool is_along(const Pool& pool, std::size_t a, std::size_t b) {
  return pool.is_function_of_an_axis(a) && pool.candidate(a).choice.axis == pool.candidate(b).choice.axis;
}

/// The other items that are not functions of the same axis.
std::vector<std::size_t> of_other_axes(const Pool& pool, const std::vector<std::size_t>& items,
                                       std::size_t item) {
  std::vector<std::size_t> others;
  for (const std::size_t other : items)
    if (other != item && !is_along(pool, other, item)) others.push_back(other);
  return others;
}

/// The part of columns that neither the model nor other columns explain, and the residual beside these.
struct OwnPart {
  Eigen::MatrixXd basis;  // orthonormal
  Eigen::VectorXd rest;
  Index others = 0;  // rank of the other columns
  double explained() const { return (basis.transpose() * rest).squaredNorm(); }
  double rank() const { return static_cast<double>(basis.cols()); }
};

OwnPart own_part(const Evidence& evidence, Eigen::MatrixXd columns, const Eigen::MatrixXd& beside) {
  const double least_own = evidence.thresholds().shape.own;
  const Eigen::VectorXd before = columns.colwise().norm();
  const Eigen::MatrixXd others = maths::orthonormal(beside, 1e-6, nullptr);
  for (int pass = 0; pass < 2; ++pass) {
    columns = evidence.beside_model(columns);
    columns -= others * (others.transpose() * columns);
  }
  for (Index j = 0; j < columns.cols(); ++j)
    if (columns.col(j).norm() < least_own * before[j]) columns.col(j).setZero();
  return {maths::orthonormal(columns, least_own, nullptr),
          evidence.residual() - others * (others.transpose() * evidence.residual()), others.cols()};
}

/// Returns the natural logarithm of a bound of the p-value of the periods along an axis: the probability that
/// the best of all periods down to those that were found explains as much of any error that repeats at the
/// few measured positions (a lead error, a worn place). The part of a random pattern that two of r directions
/// do not explain is below x with the probability x^((r - 2) / 2). Minus infinity if the axis was read at so
/// many positions that no period explains an unrelated pattern.
double log_chance_of_periods(const Evidence& evidence, const Pool& pool,
                             const std::vector<std::size_t>& items, std::size_t item) {
  const ShapeThresholds& limits = evidence.thresholds().shape;
  const effects::Choice& choice = pool.candidate(item).choice;
  const Eigen::VectorXd u = positions(evidence, *choice.axis);
  const int read = positions_read(u, limits.apart);
  if (read > 5 * static_cast<int>(evidence.thresholds().search.shape.most_half_waves))
    return -std::numeric_limits<double>::infinity();
  const Evidence::Range range = evidence.range_of(*choice.axis);
  // A straight line beside the periods is not part of the pattern: a large lead error would hide what the
  // periods leave.
  std::vector<std::size_t> along, others;
  double log_tries = 0, periods = 0;
  for (const std::size_t one : items) {
    const std::optional<double> period = pool.period_of(one);
    if (!period || !is_along(pool, one, item)) {
      others.push_back(one);
      continue;
    }
    along.push_back(one);
    // The frequencies that the search compares; the order of several periods does not matter.
    const double tries = evidence.thresholds().search.fine.per_range * (range.high - range.low) / *period;
    log_tries += std::log(std::max(1.0, tries)) - std::log(++periods);
  }
  const Eigen::MatrixXd beside = pool.columns(others);
  const OwnPart pattern = own_part(evidence, half_waves(evidence, *choice.place, u, read - 1), beside);
  const OwnPart found = own_part(evidence, pool.columns(along), beside);
  const double freedom = pattern.rank() - found.rank();
  if (freedom <= 0 || pattern.explained() <= 0) return 0;
  const double open = std::max(1 - found.explained() / pattern.explained(), 1e-12);
  return log_tries + freedom / 2 * std::log(open);
}

std::string doubt_of_curve(const Evidence& evidence, const Pool& pool, const std::vector<std::size_t>& items,
                           std::size_t item) {
  const ShapeThresholds& limits = evidence.thresholds().shape;
  // A period was selected among many, so it needs more supporting readings than a curve.
  const double seen_per_unknown =
      pool[item].scored.scanned.empty() ? limits.seen_per_unknown : limits.seen_per_period;
  const effects::Choice& choice = pool.candidate(item).choice;
  const Eigen::MatrixXd beside = pool.columns(of_other_axes(pool, items, item));
  const AxisFunction shape = function_of_axis(evidence, *choice.axis, *choice.place, beside);
  const auto coefficients = static_cast<double>(pool[item].columns.cols());
  const double unknowns = coefficients + static_cast<double>(pool[item].scored.scanned.size());
  const bool curve = coefficients >= kCoefficientsOfCurve && pool[item].scored.scanned.empty();
  if (curve && shape.fast_share > limits.fast_share && shape.log_p < limits.curve_chance)
    return fmt::format(
        "{} removes the error, but {:.0f} % of the error has half-waves shorter than those of a smooth curve "
        "({:.3g} in the unit of the axis): the error depends on the axis, and its cause has no name",
        pool.candidate(item).spoken, 100 * shape.fast_share, shape.resolved);
  if (curve) {
    const Jump jump = best_jump(evidence, *choice.place, positions(evidence, *choice.axis), beside);
    const Evidence::Range range = evidence.range_of(*choice.axis);
    if (jump.gain > gain_of(evidence, evidence.columns(pool.candidate(item), {}), beside).chi_square)
      return fmt::format(
          "a jump at the axis position {:.4g} explains more than {}: the error depends on the axis, and its "
          "cause has no name",
          range.low + jump.at * (range.high - range.low), pool.candidate(item).spoken);
  }
  if ((unknowns >= kCoefficientsOfCurve || shape.own_table) && shape.seen < seen_per_unknown * unknowns)
    return fmt::format(
        "{} has {:.0f} coefficients, but the readings determine only {:.0f} independent functions of the "
        "axis beside the model: any function of the axis would fit equally well",
        pool.candidate(item).spoken, unknowns, shape.seen);
  if (!pool.period_of(item)) return {};
  if (const double chance = log_chance_of_periods(evidence, pool, items, item); chance > limits.change_chance)
    return fmt::format(
        "{}: the axis was read at {} positions only, and the best of all periods explains other errors that "
        "repeat at these positions nearly as well (p = {:.1g}); read the axis at more positions, at uneven "
        "distances",
        pool.candidate(item).spoken, positions_read(positions(evidence, *choice.axis), limits.apart),
        std::min(1.0, std::exp(chance)));
  return {};
}

/// A square of a speed is a shape only with three speeds, standstill included. With two speeds it marks the
/// rows of one speed, and everything else that these rows have in common is the same column.
std::string doubt_of_square(const Evidence& evidence, const Pool& pool, std::size_t item) {
  constexpr int kSpeedsOfASquare = 3;  // two always lie on a parabola through zero
  const effects::Candidate& candidate = pool.candidate(item);
  const auto drivers = drivers_of(evidence.machine(), candidate);
  if (drivers.size() != 1 ||
      static_cast<model::SymbolKind>(drivers.begin()->first) != model::SymbolKind::kVelocity)
    return {};
  const std::size_t axis = drivers.begin()->second;
  const std::string square = "v" + evidence.machine().axes[axis].name + "^2";
  if (std::none_of(candidate.terms.begin(), candidate.terms.end(),
                   [&](const auto& term) { return term.text.find(square) != std::string::npos; }))
    return {};
  const Eigen::VectorXd squares =
      evidence.at_readings(evidence.measurement().states.velocity[axis]).square().matrix();
  const int speeds = positions_read(squares / std::max(squares.maxCoeff(), 1e-300),
                                    evidence.thresholds().shape.squares_apart);
  if (speeds >= kSpeedsOfASquare) return {};
  return fmt::format(
      "{} is the square of a speed, and the readings have {} speeds of {} with clearly different squares: "
      "the "
      "term marks the rows of one speed, whatever else they have in common; measure at three speeds, each at "
      "least one and a half times the one before",
      candidate.spoken, speeds, evidence.machine().axes[axis].name);
}

/// True for a reversal error that builds up over a travel.
bool builds_up(const Pool& pool, std::size_t item) {
  const effects::Choice& choice = pool.candidate(item).choice;
  return !pool.is_custom(item) && choice.effect != nullptr && choice.effect->builds_up;
}

/// True if `item` is a reversal error of the axis of `choice`, at the same location.
bool is_piece_of(const Evidence& evidence, const Pool& pool, std::size_t item,
                 const effects::Choice& choice) {
  const effects::Choice& other = pool.candidate(item).choice;
  if (!other.place || !moves_alike(evidence, *other.place, *choice.place)) return false;
  const auto drivers = drivers_of(evidence.machine(), pool.candidate(item));
  return std::any_of(drivers.begin(), drivers.end(), [&](const auto& driver) {
    const auto kind = static_cast<model::SymbolKind>(driver.first);
    return driver.second == choice.axis &&
           (kind == model::SymbolKind::kDirection || kind == model::SymbolKind::kSince);
  });
}

/// False if the travel of an axis since its reversals was computed from the rows.
bool has_travel(const Evidence& evidence, std::size_t axis) {
  return evidence.measurement().has_recorded(
      format::axis_column(format::AxisQuantity::kSince, evidence.machine().axes[axis].name));
}

/// A backlash that changes along its axis, or a backlash beside a reversal spike, is doubtful if a reversal
/// error that builds up explains as much of what a straight line and a constant backlash leave. The axis then
/// turned at the same positions, and the travel since a reversal is a function of position and direction; or
/// it turned at unknown positions, and the travel has an unknown offset.
std::string doubt_of_reversal(const Evidence& evidence, const Pool& pool,
                              const std::vector<std::size_t>& items, std::size_t item) {
  const effects::Choice& choice = pool.candidate(item).choice;
  if (!choice.axis || !choice.place || !is_piece_of(evidence, pool, item, choice)) return {};
  std::vector<std::size_t> pieces, others;
  std::size_t reversals = 0;
  for (const std::size_t one : items) {
    const bool reversal = is_piece_of(evidence, pool, one, choice);
    const bool curve = pool.is_function_of_an_axis(one) && pool.candidate(one).choice.axis == choice.axis &&
                       moves_alike(evidence, *pool.candidate(one).choice.place, *choice.place);
    reversals += reversal ? 1 : 0;
    (reversal || curve ? pieces : others).push_back(one);
  }
  const bool varies = pool[item].columns.cols() > 1;
  if (!varies && (reversals < 2 || has_travel(evidence, *choice.axis))) return {};

  const Eigen::ArrayXd answer = evidence.response(evidence.index_of(*choice.place)).array();
  const Eigen::ArrayXd dir = evidence.at_readings(evidence.measurement().states.direction[*choice.axis]);
  const Eigen::MatrixXd beside_it = pool.columns(others);
  Eigen::MatrixXd usual(answer.size(), 2);
  usual << answer * positions(evidence, *choice.axis).array(), answer * dir;
  evidence.whiten(usual);
  Eigen::MatrixXd beside(answer.size(), beside_it.cols() + usual.cols());
  beside << beside_it, evidence.beside_model(usual);
  const double found = own_part(evidence, pool.columns(pieces), beside).explained();
  for (std::size_t one = 0; one < pool.size(); ++one) {
    const effects::Choice& other = pool.candidate(one).choice;
    if (!builds_up(pool, one) || other.axis != choice.axis || other.place != choice.place) continue;
    if (own_part(evidence, pool[one].columns, beside).explained() <
        (1 - evidence.thresholds().shape.minor) * found)
      continue;
    return fmt::format(
        "{} can be a reversal error that builds up over a travel after each reversal ({}); measure with "
        "reversals at several positions, and record the travel since the reversal (column since{})",
        pool.candidate(item).spoken, pool.candidate(one).spoken, evidence.machine().axes[*choice.axis].name);
  }
  return {};
}

/// 0 for each reading before the first recorded reversal of an axis, 1 for the others. All are 1 if half of
/// the readings or more were before it.
Eigen::VectorXd after_first_reversal(const Evidence& evidence, std::size_t axis) {
  const model::Column& direction = evidence.measurement().states.direction[axis];
  model::Column known = model::Column::Ones(direction.size());
  double first = 0;
  for (Index row = 0; row < direction.size() && direction[row] * first >= 0; ++row) {
    if (direction[row] != 0) first = direction[row];
    known[row] = 0;
  }
  const Eigen::ArrayXd at = evidence.at_readings(known);
  if (2 * (at == 0).count() >= at.size()) return Eigen::VectorXd::Ones(at.size());
  return at.matrix();
}

/// Returns the decrease of the sum of squares by `columns` beside others, if only the readings with the
/// weight 1 are fitted.
double explained_in(const Evidence& evidence, const Eigen::VectorXd& weight, const Eigen::MatrixXd& columns,
                    const Eigen::MatrixXd& beside) {
  const Eigen::MatrixXd& q = evidence.absorbed();
  Eigen::MatrixXd all(q.rows(), q.cols() + beside.cols());
  all << q, beside;
  const Eigen::MatrixXd others = maths::orthonormal(weight.asDiagonal() * all, 1e-6, nullptr);
  Eigen::MatrixXd own = weight.asDiagonal() * columns;
  own -= others * (others.transpose() * own);
  Eigen::VectorXd rest = weight.asDiagonal() * evidence.residual();
  rest -= others * (others.transpose() * rest);
  return (maths::orthonormal(own, evidence.thresholds().shape.own, nullptr).transpose() * rest).squaredNorm();
}

/// True if the readings after the first recorded reversal of an axis show next to nothing of an effect.
bool only_before_first_reversal(const Evidence& evidence, const Pool& pool,
                                const std::vector<std::size_t>& items, std::size_t item, std::size_t axis) {
  const Eigen::VectorXd after = after_first_reversal(evidence, axis),
                        ever = Eigen::VectorXd::Ones(after.size());
  std::vector<std::size_t> others;
  for (const std::size_t one : items)
    if (one != item) others.push_back(one);
  const Eigen::MatrixXd beside = pool.columns(others), &own = pool[item].columns;
  return explained_in(evidence, after, own, beside) <
         evidence.thresholds().shape.minor * explained_in(evidence, ever, own, beside);
}

/// Beside a reversal error that builds up, another reversal error of the same axis is a piece of it: its
/// exact function of the travel is not known. An effect that only the readings before the first recorded
/// reversal show can be the state of the axis before. A step of the instrument can be the state of the axis
/// at the begin of a run, which a travel that is computed from the rows does not contain.
std::string doubt_beside_hysteresis(const Evidence& evidence, const Pool& pool,
                                    const std::vector<std::size_t>& items, std::size_t item) {
  for (const std::size_t other : items) {
    if (other == item || !builds_up(pool, other)) continue;
    if (builds_up(pool, item) && item < other) continue;
    if (is_piece_of(evidence, pool, item, pool.candidate(other).choice))
      return fmt::format("{} can be a part of the reversal error that builds up ({})",
                         pool.candidate(item).spoken, pool.candidate(other).spoken);
    const effects::Choice& choice = pool.candidate(other).choice;
    if (has_travel(evidence, *choice.axis)) continue;
    const auto& place = pool.candidate(item).choice.place;
    const bool step =
        !pool.candidate(item).choice.runs.empty() && (!place || moves_alike(evidence, *place, *choice.place));
    if (step || only_before_first_reversal(evidence, pool, items, item, *choice.axis))
      return fmt::format(
          "{} can be the reversal error ({}) at the begin of a run: the way of the axis before its first row "
          "is not recorded",
          pool.candidate(item).spoken, pool.candidate(other).spoken);
  }
  return {};
}

}  // namespace

Gain gain_of(const Evidence& evidence, const Eigen::MatrixXd& raw, const Eigen::MatrixXd& beside) {
  const OwnPart own = own_part(evidence, raw, beside);
  const double explained = own.explained();
  const double freedom = std::max(1.0, evidence.freedom() - static_cast<double>(own.others) - own.rank());
  double variance = (own.rest.squaredNorm() - explained) / freedom;
  if (evidence.noise_known()) variance = std::max(1.0, variance);
  return {explained / std::max(variance, 1e-300), own.rank()};
}

double bic_decrease(const Evidence& evidence, const Eigen::MatrixXd& raw, const Eigen::MatrixXd& beside,
                    std::size_t scanned) {
  const OwnPart own = own_part(evidence, raw, beside);
  const double freedom = std::max(1.0, evidence.freedom() - static_cast<double>(own.others));
  // -2 log likelihood with the most likely noise, but never below a given u: the noise of one of two compared
  // models must not scale their common part.
  const auto deviance = [&](double square) {
    const double reduced = square / freedom;
    if (evidence.noise_known() && reduced <= 1) return square;
    return freedom * (1 + std::log(std::max(reduced, 1e-300)));
  };
  const double before = own.rest.squaredNorm(), after = std::max(0.0, before - own.explained()),
               price = std::log(static_cast<double>(evidence.residual().size()));
  return deviance(before) - deviance(after) - price * (own.rank() + static_cast<double>(scanned));
}

double bic_decrease_by(const Evidence& evidence, const Pool& pool, std::size_t item,
                       const Eigen::MatrixXd& beside) {
  const std::vector<double>& scanned = pool[item].scored.scanned;
  return bic_decrease(evidence, evidence.columns(pool.candidate(item), scanned), beside, scanned.size());
}

AxisFunction function_of_axis(const Evidence& evidence, std::size_t axis, const effects::DofPlace& place,
                              const Eigen::MatrixXd& beside) {
  const ShapeThresholds& limits = evidence.thresholds().shape;
  const ShapeExtent& extent = evidence.thresholds().search.shape;
  const auto most_slow = static_cast<int>(extent.most_half_waves);
  const auto fewest_slow = static_cast<int>(extent.fewest_half_waves);
  const Eigen::VectorXd u = positions(evidence, axis);
  const int read = positions_read(u, limits.apart);
  const int slow_count = std::clamp((read - 1) / 2, fewest_slow, std::max(fewest_slow, most_slow));
  const int most = std::max(2 * slow_count, std::min(read - 1, 5 * most_slow));
  const Eigen::MatrixXd waves = half_waves(evidence, place, u, most);
  const Evidence::Range range = evidence.range_of(axis);
  AxisFunction shape;
  shape.seen = gain_of(evidence, waves, beside).rank;
  shape.own_table = shape.seen < std::min(most, read - 1);
  shape.resolved = (range.high - range.low) / slow_count;
  const Eigen::MatrixXd slow = evidence.beside_model(waves.leftCols(slow_count + 1));
  Eigen::MatrixXd held(slow.rows(), beside.cols() + slow.cols());
  held << beside, slow;
  const Gain all = gain_of(evidence, waves.leftCols(2 * slow_count + 1), beside);
  const Gain fast = gain_of(evidence, waves.middleCols(slow_count + 1, slow_count), held);
  shape.fast_share = std::max(0.0, fast.chi_square - fast.rank) / std::max(all.chi_square - all.rank, 1e-300);
  if (fast.rank > 0) shape.log_p = maths::log_chi_square_tail(fast.chi_square, fast.rank);
  return shape;
}

double log_p_of_change(const Evidence& evidence, const Pool& pool, const std::vector<std::size_t>& items,
                       std::size_t item) {
  const Eigen::MatrixXd raw = evidence.columns(pool.candidate(item), pool[item].scored.scanned);
  const bool curve = pool.is_function_of_an_axis(item) && pool[item].scored.scanned.empty();
  const std::size_t axes = evidence.machine().axes.size();
  Eigen::MatrixXd changed(raw.rows(), 2 * raw.cols() * static_cast<Index>(axes));
  Index count = 0;
  for (std::size_t axis = 0; axis < axes; ++axis) {
    // A curve of an axis times that axis is still a curve of it.
    if (curve && axis == *pool.candidate(item).choice.axis) continue;
    const Eigen::ArrayXd v = 2 * positions(evidence, axis).array() - 1;
    for (Index j = 0; j < raw.cols(); ++j) {
      changed.col(count++) = raw.col(j).array() * v;
      changed.col(count++) = raw.col(j).array() * v.square();
    }
  }
  const Eigen::MatrixXd all = pool.columns(items), more = moved(evidence, pool, item);
  Eigen::MatrixXd beside(all.rows(), all.cols() + more.cols());
  beside << all, more;
  const Gain gain = gain_of(evidence, changed.leftCols(count), beside);
  return gain.rank == 0 ? 0 : maths::log_chi_square_tail(gain.chi_square, gain.rank);
}

std::string doubt_of_shape(const Evidence& evidence, const Pool& pool, const std::vector<std::size_t>& items,
                           std::size_t item) {
  if (pool.is_function_of_an_axis(item)) {
    const std::string doubt = doubt_of_curve(evidence, pool, items, item);
    if (!doubt.empty()) return doubt;
  }
  if (const std::string doubt = doubt_of_square(evidence, pool, item); !doubt.empty()) return doubt;
  const bool built_up = std::ranges::any_of(items, [&](std::size_t one) { return builds_up(pool, one); });
  if (const std::string doubt = built_up ? doubt_beside_hysteresis(evidence, pool, items, item)
                                         : doubt_of_reversal(evidence, pool, items, item);
      !doubt.empty())
    return doubt;
  // Without a given uncertainty the residual is not known to be noise. It may contain other
  // effects.
  if (evidence.noise_known() &&
      log_p_of_change(evidence, pool, items, item) < evidence.thresholds().shape.change_chance)
    return fmt::format(
        "the size of {} changes along the axes, but an effect of this name has a constant size",
        pool.candidate(item).spoken);
  return {};
}

bool stands_beside(const Evidence& evidence, const Pool& pool, std::size_t item,
                   const std::vector<std::size_t>& doubtful) {
  const auto drivers = drivers_of(evidence.machine(), pool.candidate(item));
  const auto is_of_motion = [](const auto& driver) {
    const auto kind = static_cast<model::SymbolKind>(driver.first);
    return kind == model::SymbolKind::kVelocity || kind == model::SymbolKind::kAcceleration ||
           kind == model::SymbolKind::kDirection || kind == model::SymbolKind::kSince ||
           kind == model::SymbolKind::kFeed || kind == model::SymbolKind::kCurvature;
  };
  if (drivers.empty() || pool.is_custom(item) || !std::all_of(drivers.begin(), drivers.end(), is_of_motion))
    return false;
  return std::none_of(doubtful.begin(), doubtful.end(), [&](std::size_t other) {
    if (builds_up(pool, item) && other != item &&
        is_piece_of(evidence, pool, other, pool.candidate(item).choice))
      return false;
    const auto others = drivers_of(evidence.machine(), pool.candidate(other));
    return other == item || std::any_of(others.begin(), others.end(),
                                        [&](const auto& driver) { return drivers.contains(driver); });
  });
}

}  // namespace vernier::diagnose
