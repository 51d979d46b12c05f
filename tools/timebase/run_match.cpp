// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/timebase/run_match.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <random>
#include <vector>

namespace vernier::timebase {
namespace {

using Index = Eigen::Index;

// Number of points to which a run is reduced: sufficient for features wider than two hundredths of
// it.
constexpr Index kPoints = 150;

// Means over a window of this number of points' width about each of kPoints positions.
Eigen::MatrixXd window_means(const Eigen::MatrixXd& series, double width) {
  Eigen::MatrixXd means(kPoints, series.cols());
  const double step = static_cast<double>(series.rows()) / static_cast<double>(kPoints);
  for (Index k = 0; k < kPoints; ++k) {
    const double middle = (static_cast<double>(k) + 0.5) * step, half = 0.5 * width * step;
    const Index from = std::max<Index>(0, static_cast<Index>(middle - half));
    const Index to = std::min<Index>(series.rows(), static_cast<Index>(middle + half) + 1);
    means.row(k) = series.middleRows(from, to - from).colwise().mean();
  }
  return means;
}

// Features shorter than four points depend on the direction of motion (ringing). Features longer
// than a third of the run are caused by wrong positions in the fit (a wrong centre).
Eigen::MatrixXd thin(const Eigen::MatrixXd& series) {
  constexpr double kShortest = 4, kLongest = kPoints / 3.0;  // points that a lost block may have
  return window_means(series, kShortest) - window_means(series, kLongest);
}

// Correlation if point i of the first is at offset + rate i of the second; -1 if the overlap is
// too short.
double correlation_at(const Eigen::MatrixXd& first, const Eigen::MatrixXd& second, double offset,
                      double rate) {
  double ab = 0, aa = 0, bb = 0;
  Index n = 0;
  for (Index i = 0; i < first.rows(); ++i) {
    const double place = offset + rate * static_cast<double>(i);
    if (place < 0 || place >= static_cast<double>(second.rows() - 1)) continue;
    const auto k = static_cast<Index>(place);
    const double part = place - static_cast<double>(k);
    for (Index c = 0; c < first.cols(); ++c) {
      const double b = second(k, c) + part * (second(k + 1, c) - second(k, c)), a = first(i, c);
      ab += a * b, aa += a * a, bb += b * b;
    }
    ++n;
  }
  constexpr double kLeastOverlap = 0.6;  // of the shorter run, for a match
  if (static_cast<double>(n) < kLeastOverlap * static_cast<double>(first.rows()) || aa <= 0 || bb <= 0)
    return -1;
  return ab / std::sqrt(aa * bb);
}

struct MatchPeak {
  double correlation = -1, offset = 0, rate = 0;
};

// The best offset at a rate (in reduced points), about the `implied` position of the middle of the
// first run.
MatchPeak search(const Eigen::MatrixXd& first, const Eigen::MatrixXd& second, const PathMap& implied,
                 double rate, const RunMatchOptions& options) {
  MatchPeak best;
  const double middle = static_cast<double>(first.rows()) / 2;
  const double centre = implied.offset + implied.rate * middle;
  const double reach = options.shifts * static_cast<double>(second.rows());
  for (double shift = -reach; shift <= reach; shift += 1) {
    const double offset = centre + shift - rate * middle;
    const double r = correlation_at(first, second, offset, rate);
    if (r > best.correlation) best = {r, offset, rate};
  }
  return best;
}

// The series with its own spectrum and random phases, the same for all channels.
class Surrogates {
 public:
  explicit Surrogates(const Eigen::MatrixXd& series) : rows_(series.rows()), channels_(series.cols()) {
    const Index half = (rows_ - 1) / 2;
    cosine_ = wave(half, 0);
    sine_ = wave(half, -std::numbers::pi / 2);
    a_ = cosine_.transpose() * series * 2 / static_cast<double>(rows_);
    b_ = sine_.transpose() * series * 2 / static_cast<double>(rows_);
  }

  Eigen::MatrixXd draw(std::mt19937_64& random) const {
    std::uniform_real_distribution<double> phase(0, 2 * std::numbers::pi);
    Eigen::MatrixXd a = a_, b = b_;
    for (Index k = 0; k < a.rows(); ++k) {
      const double turn = phase(random), c = std::cos(turn), s = std::sin(turn);
      a.row(k) = c * a_.row(k) + s * b_.row(k);
      b.row(k) = c * b_.row(k) - s * a_.row(k);
    }
    return cosine_ * a + sine_ * b;
  }

 private:
  Eigen::MatrixXd wave(Index half, double phase) const {
    Eigen::MatrixXd values(rows_, half);
    for (Index k = 0; k < half; ++k) {
      for (Index i = 0; i < rows_; ++i)
        values(i, k) = std::cos(
            2 * std::numbers::pi * static_cast<double>((k + 1) * i) / static_cast<double>(rows_) + phase);
    }
    return values;
  }
  Index rows_, channels_;
  Eigen::MatrixXd cosine_, sine_, a_, b_;
};

double fisher(double r) {
  constexpr double kMost = 1 - 1e-9;  // below a correlation of 1, whose transform is infinite
  return std::atanh(std::clamp(r, -kMost, kMost));
}

// Probability of the observed maximum among surrogates: by counting, and by the tail of their
// Gumbel law if counting cannot resolve it. The larger of both is used if counting gives a result.
double chance(const Eigen::MatrixXd& first, const Eigen::MatrixXd& second, const PathMap& implied,
              const MatchPeak& observed, const RunMatchOptions& options) {
  const Surrogates surrogates(second);
  std::mt19937_64 random(options.seed);
  double sum = 0, squares = 0;
  int above = 0;
  for (int k = 0; k < options.surrogates; ++k) {
    const double z =
        fisher(search(first, surrogates.draw(random), implied, observed.rate, options).correlation);
    sum += z, squares += z * z;
    if (z >= fisher(observed.correlation)) ++above;
    // Larger maxima, in however few surrogates, that are sufficient to reject the finding: the share of
    // twenty has an uncertainty of 1 / sqrt(20), 22 %.
    constexpr int kEnough = 20;
    if (above == kEnough) return static_cast<double>(above) / (k + 1);
  }
  // Mean and standard deviation of Gumbel's law: location + gamma * scale, pi / sqrt(6) * scale.
  constexpr double kLeastVariance = 1e-12;  // if all surrogates are equal
  const double n = options.surrogates, mean = sum / n;
  const double deviation = std::sqrt(std::max(squares / n - mean * mean, kLeastVariance));
  const double scale = deviation * std::sqrt(6.0) / std::numbers::pi;
  const double location = mean - std::numbers::egamma * scale;
  const double tail = -std::expm1(-std::exp(-(fisher(observed.correlation) - location) / scale));
  return above > 0 ? std::max(tail, (above + 1) / (n + 1)) : tail;
}

// Number of points over which the autocorrelation decreases below a half.
double decorrelation(const Eigen::MatrixXd& series) {
  const double all = series.squaredNorm();
  for (Index k = 1; k < series.rows() / 2; ++k) {
    const double r =
        series.topRows(series.rows() - k).cwiseProduct(series.bottomRows(series.rows() - k)).sum();
    if (r < 0.5 * all) return static_cast<double>(k);
  }
  return static_cast<double>(series.rows());
}

double distance(const PathMap& a, const PathMap& b, double rows) {
  return std::max(std::abs(a.offset - b.offset),
                  std::abs(a.offset + a.rate * rows - b.offset - b.rate * rows));
}

}  // namespace

std::optional<RunMatch> match_runs(const Eigen::MatrixXd& first, const Eigen::MatrixXd& second,
                                   const PathMap& implied, const RunMatchOptions& options) {
  if (first.rows() < kPoints || second.rows() < kPoints) return std::nullopt;
  const Eigen::MatrixXd a = thin(first);
  const Eigen::MatrixXd b = thin(second);
  if (a.squaredNorm() <= 0 || b.squaredNorm() <= 0) return std::nullopt;
  const double a_step = static_cast<double>(first.rows()) / kPoints,
               b_step = static_cast<double>(second.rows()) / kPoints;
  // Point k represents the row (k + 0.5) step - 0.5.
  const auto to_points = [&](const PathMap& map) {
    PathMap points = map;
    points.rate = map.rate * a_step / b_step;
    points.offset = (map.offset + map.rate * (0.5 * a_step - 0.5) + 0.5) / b_step - 0.5;
    return points;
  };
  const auto to_rows = [&](double offset, double rate) {
    PathMap map{0, rate * b_step / a_step, implied.share};
    map.offset = (offset + 0.5) * b_step - 0.5 - map.rate * (0.5 * a_step - 0.5);
    return map;
  };
  const PathMap expected = to_points(implied);
  // The same motion at the same speed: row by row.
  const double same_rate = (implied.rate > 0 ? 1 : -1) * a_step / b_step;
  const MatchPeak peak = search(a, b, expected, same_rate, options);
  RunMatch match;
  match.implied = implied;
  match.best = to_rows(peak.offset, peak.rate);
  match.correlation = peak.correlation;
  match.implied_correlation = correlation_at(a, b, expected.offset, expected.rate);
  const auto rows = static_cast<double>(first.rows());
  match.shift = distance(match.implied, match.best, rows);
  const double needed = 2 * decorrelation(a) * a_step;
  const bool other_rate = std::abs(match.best.rate / implied.rate - 1) * rows >= needed;
  const bool enough = implied.rate > 0 ? match.shift >= needed : other_rate;
  if (!enough || peak.correlation < options.least_correlation ||
      match.implied_correlation > 0.5 * peak.correlation)
    return match;
  match.p_value = chance(a, b, expected, peak, options);
  return match;
}

}  // namespace vernier::timebase
