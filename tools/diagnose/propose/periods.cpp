// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/diagnose/propose/periods.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>
#include <utility>

#include "tools/maths/golden.h"

namespace vernier::diagnose {
namespace {

using Index = Eigen::Index;
constexpr double kTurn = 2 * std::numbers::pi;

double position(const Evidence& evidence, std::size_t axis, std::size_t reading) {
  return evidence.position(axis)[static_cast<Index>(evidence.rows()[reading])];
}

/// The different positions of an axis, and sums of columns over the readings at each.
struct Positions {
  Eigen::ArrayXd at;
  Eigen::MatrixXd sum;
};

Positions by_position(const Evidence& evidence, std::size_t axis, const Eigen::MatrixXd& columns) {
  std::map<double, Index> index;
  for (std::size_t i = 0; i < evidence.rows().size(); ++i) index.emplace(position(evidence, axis, i), 0);
  Positions result{Eigen::ArrayXd(static_cast<Index>(index.size())),
                   Eigen::MatrixXd::Zero(static_cast<Index>(index.size()), columns.cols())};
  Index next = 0;
  for (auto& [value, at] : index) {
    at = next++;
    result.at[at] = value;
  }
  for (std::size_t i = 0; i < evidence.rows().size(); ++i)
    result.sum.row(index[position(evidence, axis, i)]) += columns.row(static_cast<Index>(i));
  return result;
}

/// |sum over the positions of column * exp(2 pi i f q)|^2 at one frequency.
double power_at(const Positions& positions, Index column, double frequency) {
  const Eigen::ArrayXd phase = kTurn * frequency * positions.at;
  const Eigen::ArrayXd value = positions.sum.col(column).array();
  return std::pow((value * phase.cos()).sum(), 2) + std::pow((value * phase.sin()).sum(), 2);
}

/// Sines and cosines of phases that increase by the same step at each position. Each sine follows from the
/// previous one by a rotation. That loses one digit in a thousand steps.
class TurningPhases {
 public:
  TurningPhases(const Eigen::ArrayXd& first, const Eigen::ArrayXd& step)
      : turn_cos_(step.cos()), turn_sin_(step.sin()) {
    begin_at(first);
  }
  void begin_at(const Eigen::ArrayXd& phase) {
    cos_ = phase.cos();
    sin_ = phase.sin();
  }
  void advance() {
    const Eigen::ArrayXd next = cos_ * turn_cos_ - sin_ * turn_sin_;
    sin_ = sin_ * turn_cos_ + cos_ * turn_sin_;
    cos_ = next;
  }
  const Eigen::ArrayXd& cosine() const { return cos_; }
  const Eigen::ArrayXd& sine() const { return sin_; }

 private:
  Eigen::ArrayXd turn_cos_, turn_sin_, cos_, sin_;
};

/// The same for every column (one row each) at frequencies first + k * step.
Eigen::MatrixXd powers(const Positions& positions, double first, double step, Index count) {
  constexpr Index kBlock = 32;  // frequencies in one product
  const Index size = positions.at.size();
  TurningPhases phases(kTurn * first * positions.at, kTurn * step * positions.at);
  Eigen::MatrixXd cosines(size, kBlock), sines(size, kBlock), result(positions.sum.cols(), count);
  for (Index at = 0; at < count; at += kBlock) {
    const Index width = std::min(kBlock, count - at);
    for (Index k = 0; k < width; ++k) {
      cosines.col(k) = phases.cosine();
      sines.col(k) = phases.sine();
      phases.advance();
    }
    const Eigen::MatrixXd in = positions.sum.transpose() * cosines.leftCols(width),
                          quadrature = positions.sum.transpose() * sines.leftCols(width);
    result.middleCols(at, width) = in.cwiseAbs2() + quadrature.cwiseAbs2();
  }
  return result;
}

/// The frequency between two others where the power is largest.
double peak_between(const Positions& positions, Index column, double low, double high) {
  constexpr int kSections = 12;  // of a golden search between two frequencies
  return maths::golden_peak([&](double frequency) { return power_at(positions, column, frequency); }, low,
                            high, kSections)
      .at;
}

/// Returns the positions of an axis, without repeats. Positions that the shortest searched wave
/// does not distinguish count once, however often they were read. Each has weight 1.
Positions stations(const Evidence& evidence, std::size_t axis, double length, int sense = 0) {
  const double apart = 1 / (4 * evidence.thresholds().search.fine.most_periods);
  const std::vector<double> kept = evidence.places_read(axis, sense, apart * length);
  const auto count = static_cast<Index>(kept.size());
  return {Eigen::Map<const Eigen::ArrayXd>(kept.data(), count), Eigen::MatrixXd::Ones(count, 1)};
}

double most_frequency(const Positions& positions, double length, const FinePeriodExtent& limits) {
  return std::min(limits.most_periods, limits.per_position * static_cast<double>(positions.at.size())) /
         length;
}

/// Returns peaks of a row of powers for refinement: the `most` highest ones, and the slowest of
/// those within `margin` of the highest.
std::vector<Index> best_peaks(const Eigen::MatrixXd& power, Index row, double least, double margin,
                              std::size_t most) {
  std::vector<Index> peaks;
  for (Index k = 1; k + 1 < power.cols(); ++k)
    if (power(row, k) > least && power(row, k) >= power(row, k - 1) && power(row, k) > power(row, k + 1))
      peaks.push_back(k);
  if (peaks.size() <= most) return peaks;
  std::vector<Index> order = peaks;
  std::sort(order.begin(), order.end(), [&](Index a, Index b) { return power(row, a) > power(row, b); });
  const double near = power(row, order[0]) - margin;
  order.resize(most);
  const Index slowest =
      *std::find_if(peaks.begin(), peaks.end(), [&](Index k) { return power(row, k) >= near; });
  if (std::find(order.begin(), order.end(), slowest) == order.end()) order.push_back(slowest);
  return order;
}

}  // namespace

std::vector<double> alias_frequencies(const Evidence& evidence, std::size_t axis, double most) {
  constexpr double kPerWindow = 5, kFirst = 1.5;  // tested frequencies for each that the range distinguishes
  const double partly = evidence.thresholds().fine.alias_partly;
  const Evidence::Range range = evidence.range_of(axis);
  const double length = range.high - range.low;
  std::vector<double> found;
  if (length <= 0) return found;
  const Positions positions = stations(evidence, axis, length);
  const double step = 1 / (kPerWindow * length), first = kFirst / length;
  const auto count = static_cast<Index>(std::ceil((most - first) / step)) + 2;
  if (count < 3) return found;
  const Eigen::MatrixXd window = powers(positions, first, step, count);
  const double all = std::pow(positions.sum.sum(), 2);
  for (Index k = 1; k + 1 < count; ++k) {
    // Between two of the steps a peak keeps nine tenths.
    if (window(0, k) < partly * partly * all || window(0, k) < window(0, k - 1) ||
        window(0, k) < window(0, k + 1))
      continue;
    const double middle = first + static_cast<double>(k) * step;
    const double peak = peak_between(positions, 0, middle - step, middle + step);
    if (power_at(positions, 0, peak) > partly * all) found.push_back(peak);
  }
  return found;
}

namespace {

/// The same for given positions.
double shortest_of(const Evidence& evidence, const Positions& positions, double length) {
  // Waves that are the same at two positions differ by a frequency at which all positions have the
  // same phase.
  constexpr double kPerWindow = 5;  // tested frequencies for each that the range distinguishes
  const FinePeriodThresholds& limits = evidence.thresholds().fine;
  const double steps_per_alias = evidence.thresholds().search.candidates.steps_per_period;
  const double step = 1 / (kPerWindow * length), first = 1.5 / length;
  const auto count = static_cast<Index>(std::ceil(
      (steps_per_alias * most_frequency(positions, length, evidence.thresholds().search.fine) - first) /
      step));
  if (count < 3) return 0;
  const Eigen::MatrixXd window = powers(positions, first, step, count);
  const double all = std::pow(positions.sum.sum(), 2);
  for (Index k = 1; k + 1 < count; ++k) {
    if (window(0, k) < limits.alias_near * all || window(0, k) < window(0, k - 1) ||
        window(0, k) < window(0, k + 1))
      continue;
    const double middle = first + static_cast<double>(k) * step;
    const double peak = peak_between(positions, 0, middle - step, middle + step);
    if (power_at(positions, 0, peak) > kSameAlias * all) return steps_per_alias / peak;
  }
  return 0;
}

}  // namespace

double shortest_told_apart(const Evidence& evidence, std::size_t axis) {
  const Evidence::Range range = evidence.range_of(axis);
  const double length = range.high - range.low;
  if (length <= 0) return 0;
  const Positions all = stations(evidence, axis, length);
  const double together = shortest_of(evidence, all, length);
  // If the stops of the two approach directions are at different positions, together they form a
  // finer grid. An effect that only this finer grid shows is the difference between the
  // directions.
  double apart = 1e300;
  for (const int sense : {-1, 1}) {
    const Positions one = stations(evidence, axis, length, sense);
    std::size_t rows = 0;
    for (const std::size_t row : evidence.rows()) rows += evidence.sense_of(axis, row) == sense ? 1 : 0;
    const CandidateExtent& limits = evidence.thresholds().search.candidates;
    if (one.at.size() < static_cast<Index>(limits.comb_positions) ||
        static_cast<double>(rows) < limits.comb_share * static_cast<double>(evidence.rows().size()))
      return together;
    apart = std::min(apart, shortest_of(evidence, one, length));
  }
  return std::max(together, apart);
}

FinePeriods fine_periods(const Evidence& evidence, std::size_t axis, const std::vector<double>& grid,
                         double shortest) {
  const FinePeriodExtent& limits = evidence.thresholds().search.fine;
  if (grid.empty()) return {};
  const Evidence::Range range = evidence.range_of(axis);
  FinePeriods fine;
  fine.axis = axis;
  fine.length = range.high - range.low;
  fine.step = 1 / (limits.per_range * fine.length);
  // The two lists overlap, so that a peak between them is in this list.
  fine.slowest = 1 / grid.front() - 3 * fine.step;
  fine.from = 1 / grid.back();
  fine.fastest = most_frequency(stations(evidence, axis, fine.length), fine.length, limits);
  if (shortest > 0) fine.fastest = std::min(fine.fastest, 1 / shortest);
  return fine.fastest > fine.slowest + limits.fewest * fine.step ? fine : FinePeriods{};
}

Eigen::VectorXd carrier_of(const Evidence& evidence, const effects::Candidate& candidate,
                           const FinePeriods& fine) {
  constexpr double kSame = 1e-9;  // relative: the same period except for rounding
  Eigen::VectorXd carrier;
  for (const double frequency : {fine.slowest, fine.fastest}) {
    const Eigen::MatrixXd columns = evidence.columns(candidate, {1 / frequency});
    if (columns.cols() != 2) return {};
    Eigen::ArrayXd phase(columns.rows());
    for (Index i = 0; i < phase.size(); ++i)
      phase[i] = kTurn * frequency * position(evidence, fine.axis, static_cast<std::size_t>(i));
    if (carrier.size() == 0)
      carrier = columns.col(0).array() * phase.sin() + columns.col(1).array() * phase.cos();
    const double allowed = kSame * carrier.norm();
    if (!((columns.col(0).array() - carrier.array() * phase.sin()).matrix().norm() <= allowed) ||
        !((columns.col(1).array() - carrier.array() * phase.cos()).matrix().norm() <= allowed))
      return {};
  }
  return carrier;
}

namespace {

constexpr Index kBlock = 64;  // frequencies in one product

/// Gains of projected waves beside the orthonormal columns `beside`.
Eigen::VectorXd gains_beside(const Evidence& evidence, const ProjectedWaves& waves,
                             const Eigen::MatrixXd& beside, const Eigen::VectorXd& residual) {
  const double least_square = std::pow(evidence.thresholds().pool.least_own, 2);
  Eigen::VectorXd gains(waves.columns.cols() / 2);
  Eigen::MatrixXd columns;
  for (Index begin = 0; begin < gains.size(); begin += kBlock) {
    const Index width = std::min(kBlock, gains.size() - begin);
    columns = waves.columns.middleCols(2 * begin, 2 * width);
    if (beside.cols() > 0) columns -= beside * (beside.transpose() * columns);
    const Eigen::RowVectorXd moment = residual.transpose() * columns;
    for (Index k = 0; k < width; ++k) {
      const double a = columns.col(2 * k).squaredNorm(), b = columns.col(2 * k + 1).squaredNorm(),
                   c = columns.col(2 * k).dot(columns.col(2 * k + 1)), u = moment[2 * k],
                   v = moment[2 * k + 1];
      const double determinant = a * b - c * c,
                   own = waves.squares[2 * (begin + k)] + waves.squares[2 * (begin + k) + 1];
      // The smaller eigenvalue of the 2 x 2 matrix is at least its determinant over its trace.
      const bool independent = determinant > least_square * own * (a + b);
      gains[begin + k] = independent ? (b * u * u - 2 * c * u * v + a * v * v) / determinant : 0;
    }
  }
  return gains;
}

}  // namespace

ProjectedWaves projected_waves(const Evidence& evidence, const WaveOfAxis& wave, double first, double step,
                               Index count) {
  const Index size = evidence.residual().size();
  Eigen::ArrayXd at(size);
  for (Index i = 0; i < size; ++i) at[i] = kTurn * position(evidence, wave.axis, static_cast<std::size_t>(i));
  const Eigen::MatrixXd& absorbed = evidence.absorbed();
  ProjectedWaves waves{Eigen::MatrixXd(size, 2 * count), Eigen::RowVectorXd(2 * count)};
  TurningPhases phases(first * at, step * at);
  Eigen::MatrixXd columns;
  for (Index begin = 0; begin < count; begin += kBlock) {
    const Index width = std::min(kBlock, count - begin);
    columns.resize(size, 2 * width);
    phases.begin_at((first + static_cast<double>(begin) * step) * at);  // exact again in each block
    for (Index k = 0; k < width; ++k) {
      columns.col(2 * k) = wave.carrier.array() * phases.sine();
      columns.col(2 * k + 1) = wave.carrier.array() * phases.cosine();
      phases.advance();
    }
    evidence.whiten(columns);
    waves.squares.segment(2 * begin, 2 * width) = columns.colwise().squaredNorm();
    if (absorbed.cols() > 0) columns -= absorbed * (absorbed.transpose() * columns);
    waves.columns.middleCols(2 * begin, 2 * width) = columns;
  }
  return waves;
}

Eigen::VectorXd wave_gains(const Evidence& evidence, const WaveOfAxis& wave, double first, double step,
                           Index count, const Eigen::MatrixXd& beside, const Eigen::VectorXd& residual) {
  return gains_beside(evidence, projected_waves(evidence, wave, first, step, count), beside, residual);
}

bool is_affordable(const Evidence& evidence, Index count, const Eigen::MatrixXd& beside) {
  constexpr double kMost = 4e8;  // multiplications: a few tenths of a second
  const double columns = static_cast<double>(evidence.absorbed().cols() + beside.cols() + 4);
  return 4 * columns * static_cast<double>(count) * static_cast<double>(evidence.residual().size()) < kMost;
}

namespace {

/// The same by exact gains, for one candidate. `waves`: at the frequencies from fine.begin() on.
std::vector<double> best_by_gain(const Evidence& evidence, const FinePeriods& fine,
                                 const ProjectedWaves& waves, const Eigen::MatrixXd& beside,
                                 const Eigen::VectorXd& residual) {
  const WaveOfAxis wave{fine.axis, fine.carrier};
  const std::size_t peaks = evidence.thresholds().search.fine.peaks;
  const Eigen::MatrixXd gains = gains_beside(evidence, waves, beside, residual).transpose();
  const double freedom = std::max(1.0, evidence.freedom()), all = residual.squaredNorm();
  const double left = std::max(all - gains.maxCoeff(), evidence.noise_known() ? freedom : 0.0);
  // Between two tested frequencies a peak keeps nine tenths of its height, so that each peak of that height
  // may be the highest. With few positions there are many such peaks.
  constexpr int kSections = 12;             // of a golden search between two frequencies
  constexpr double kKept = 0.9;             // share of a peak's height between two tested frequencies
  constexpr std::size_t kMostRefined = 24;  // peaks
  const double high = kKept * kKept * gains.maxCoeff();
  const double margin = left / freedom * evidence.thresholds().fine.nearly_as_well;
  std::vector<std::pair<double, double>> refined;  // gain and period
  for (const Index k :
       best_peaks(gains, 0, all / freedom * 2 * std::log(fine.tries()), margin, kMostRefined)) {
    if (refined.size() >= peaks && gains(0, k) < high) continue;
    const double middle = fine.begin() + static_cast<double>(k) * fine.step;
    const auto gain_at = [&](double frequency) {
      return wave_gains(evidence, wave, frequency, 0, 1, beside, residual)[0];
    };
    // With few positions, two peaks can be nearer to each other than the tested frequencies.
    const maths::Peak below = maths::golden_peak(gain_at, middle - fine.step, middle, kSections),
                      above = maths::golden_peak(gain_at, middle, middle + fine.step, kSections);
    const maths::Peak& peak = below.value > above.value ? below : above;
    refined.emplace_back(peak.value, 1 / peak.at);
  }
  std::sort(refined.rbegin(), refined.rend());
  // The highest peaks, and the slowest of those that are nearly as high.
  std::vector<double> periods;
  double slowest = 0;
  for (const auto& [gain, period] : refined) {
    if (periods.size() < peaks) periods.push_back(period);
    if (gain >= refined.front().first - margin) slowest = std::max(slowest, period);
  }
  if (std::find(periods.begin(), periods.end(), slowest) == periods.end() && slowest > 0)
    periods.push_back(slowest);
  return periods;
}

}  // namespace

std::vector<std::vector<double>> promising_periods(const Evidence& evidence,
                                                   const std::vector<const FinePeriods*>& of_axis,
                                                   const Eigen::MatrixXd& beside,
                                                   const Eigen::VectorXd& residual, ProjectedColumns* kept,
                                                   const std::vector<std::size_t>& candidates) {
  std::vector<std::vector<double>> found(of_axis.size());
  if (of_axis.empty()) return found;
  const FinePeriods& fine = *of_axis.front();
  const auto count_from = [&](double first) {
    return static_cast<Index>(std::floor((fine.fastest - first) / fine.step)) + 1;
  };
  if (const Index count = count_from(fine.begin());
      is_affordable(evidence, count * static_cast<Index>(of_axis.size()), beside)) {
    for (std::size_t i = 0; i < of_axis.size(); ++i) {
      const ProjectedWaves* known = kept == nullptr ? nullptr : kept->waves(candidates[i]);
      ProjectedWaves made;
      if (known == nullptr) {
        made = projected_waves(evidence, {fine.axis, of_axis[i]->carrier}, of_axis[i]->begin(),
                               of_axis[i]->step, count);
        known = kept != nullptr && kept->has_room(made.columns.size())
                    ? &kept->keep(candidates[i], std::move(made))
                    : &made;
      }
      found[i] = best_by_gain(evidence, *of_axis[i], *known, beside, residual);
    }
    return found;
  }
  // The columns are weighted like the residual. For a symmetric weighting, weighting the residual
  // once more is equivalent.
  Eigen::MatrixXd weighed = residual;
  evidence.whiten(weighed);
  Eigen::MatrixXd products(residual.size(), static_cast<Index>(of_axis.size()));
  for (std::size_t i = 0; i < of_axis.size(); ++i)
    products.col(static_cast<Index>(i)) = of_axis[i]->carrier.cwiseProduct(weighed.col(0));
  const Positions positions = by_position(evidence, fine.axis, products);
  const Eigen::MatrixXd power = powers(positions, fine.slowest, fine.step, count_from(fine.slowest));
  // Power at which the wave explains as much as the highest of so many waves explains of noise.
  const double variance = residual.squaredNorm() / std::max(1.0, evidence.freedom());
  const std::size_t peaks = evidence.thresholds().search.fine.peaks;
  const double nearly = evidence.thresholds().fine.nearly_as_well;
  for (std::size_t i = 0; i < of_axis.size(); ++i) {
    const double unit = variance * of_axis[i]->carrier.squaredNorm() / 2;
    const double least = unit * 2 * std::log(fine.tries());
    for (const Index k : best_peaks(power, static_cast<Index>(i), least, unit * nearly, peaks)) {
      const double middle = fine.slowest + static_cast<double>(k) * fine.step;
      found[i].push_back(
          1 / peak_between(positions, static_cast<Index>(i), middle - fine.step, middle + fine.step));
    }
  }
  return found;
}

}  // namespace vernier::diagnose
