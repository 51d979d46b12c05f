// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/residual/sample.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <numbers>

#include "tools/format/readings.h"
#include "tools/maths/chance.h"
#include "tools/maths/decompositions.h"
#include "tools/maths/golden.h"
#include "tools/maths/median.h"

namespace vernier::residual {
namespace {

// Robust standard deviations: values beyond the first are limited to it, values beyond the second
// are reported.
constexpr double kHeld = 4, kOutlier = 5;
constexpr double kMostOutliers = 0.1;  // share of the readings
constexpr std::size_t kLeastRows = 8;  // the uncertainty of a standard deviation from fewer exceeds a quarter
/// Directions of a Jacobian below this share of the largest were not determined by the fit.
constexpr double kRankCutoff = 1e-5;

/// Returns the orthonormal directions that the fit used, one row per observation; empty without a
/// Jacobian. scale: of each observation, 0 if it is not tested.
Eigen::MatrixXd fitted_directions(const std::vector<double>& scale, const StructureOptions& options) {
  if (options.jacobian == nullptr || options.jacobian->cols() == 0) return {};
  Eigen::MatrixXd j = *options.jacobian;
  for (Eigen::Index i = 0; i < j.rows(); ++i) j.row(i) *= scale[static_cast<std::size_t>(i)];
  for (Eigen::Index k = 0; k < j.cols(); ++k)
    if (const double norm = j.col(k).norm(); norm > 0) j.col(k) /= norm;
  return maths::range_of(j, kRankCutoff);
}

std::vector<std::size_t> thinned(const std::vector<std::size_t>& all) {
  const std::size_t step = (all.size() + kMostTestedRows - 1) / kMostTestedRows;
  if (step <= 1) return all;
  std::vector<std::size_t> kept;
  for (std::size_t i = 0; i < all.size(); i += step) kept.push_back(all[i]);
  return kept;
}

struct Prepared {
  std::shared_ptr<const Basis> basis;
  Eigen::MatrixXd gram;
};

Prepared prepare(const KindSample& sample, const std::vector<RecordedColumn>& columns) {
  Basis basis = make_basis(columns, sample.rows);
  basis.matrix = sample.weight.asDiagonal() * basis.matrix;
  for (Eigen::Index k = 0; k < basis.matrix.cols(); ++k)
    if (const double norm = basis.matrix.col(k).norm(); norm > 0) basis.matrix.col(k) /= norm;
  Prepared prepared;
  prepared.gram = Eigen::MatrixXd::Zero(basis.matrix.cols(), basis.matrix.cols());
  prepared.gram.selfadjointView<Eigen::Lower>().rankUpdate(basis.matrix.transpose());
  prepared.gram = Eigen::MatrixXd(prepared.gram.selfadjointView<Eigen::Lower>());
  prepared.basis = std::make_shared<const Basis>(std::move(basis));
  return prepared;
}

void set_moments(KindSample& sample, const Prepared& prepared) {
  sample.basis = prepared.basis;
  sample.moments.gram = prepared.gram;
  sample.moments.score = prepared.basis->matrix.transpose() * sample.held;
  sample.moments.sum = sample.held.squaredNorm();
  sample.moments.freedom = static_cast<double>(sample.rows.size());
}

/// Fills `projected`. spread: standard deviation of each kind's weighted residual.
void project(std::vector<KindSample>& samples, const std::vector<std::vector<std::size_t>>& observations,
             const std::vector<double>& spread, const Eigen::MatrixXd& directions) {
  std::vector<Eigen::MatrixXd> own;
  Eigen::VectorXd met_residual = Eigen::VectorXd::Zero(directions.cols());
  double sum = 0, freedom = -static_cast<double>(directions.cols());
  for (std::size_t k = 0; k < samples.size(); ++k) {
    Eigen::MatrixXd part(samples[k].held.size(), directions.cols());
    for (Eigen::Index i = 0; i < part.rows(); ++i)
      part.row(i) = directions.row(static_cast<Eigen::Index>(observations[k][static_cast<std::size_t>(i)]));
    met_residual += part.transpose() * (samples[k].held / spread[k]);
    freedom += static_cast<double>(part.rows());
    own.push_back(std::move(part));
  }
  for (std::size_t k = 0; k < samples.size(); ++k)
    sum += (samples[k].held / spread[k] - own[k] * met_residual).squaredNorm();
  for (std::size_t k = 0; k < samples.size(); ++k) {
    const Eigen::MatrixXd met = own[k].transpose() * samples[k].basis->matrix;
    maths::Moments& moments = samples[k].projected;
    moments.gram.noalias() -= met.transpose() * met;
    moments.score = moments.score / spread[k] - met.transpose() * met_residual;
    moments.sum = sum;
    moments.freedom = freedom;
  }
}

std::size_t value_count(const KindSample& sample, const RecordedColumn& column) {
  std::vector<double> values;
  for (const std::size_t row : sample.rows)
    if (const double v = column.value[static_cast<Eigen::Index>(row)]; !std::isnan(v)) values.push_back(v);
  std::sort(values.begin(), values.end());
  return static_cast<std::size_t>(std::unique(values.begin(), values.end()) - values.begin());
}

constexpr double kOversampling = 4;  // steps per cycle over the range: a peak loses at most 5 % between them

/// Least squares of a residual on constant, sine and cosine from their sums; weights included.
struct SineSums {
  double cc = 0, ss = 0, cs = 0, c1 = 0, s1 = 0, n1 = 0, cr = 0, sr = 0, r1 = 0;

  void add(double c, double s, double w, double r) {
    const double wc = w * c, ws = w * s;
    cc += wc * wc, ss += ws * ws, cs += wc * ws;
    c1 += wc * w, s1 += ws * w, n1 += w * w;
    cr += wc * r, sr += ws * r, r1 += w * r;
  }
  /// Returns the explained sum of squares beyond the constant, and the factors of sine and cosine.
  double explained(Eigen::Vector2d* factor) const {
    const double a = ss - s1 * s1 / n1, b = cs - s1 * c1 / n1, c = cc - c1 * c1 / n1;
    const double p = sr - s1 * r1 / n1, q = cr - c1 * r1 / n1, det = a * c - b * b;
    constexpr double kDependent = 1e-6;  // of sine and cosine: the positions do not separate them
    if (det <= kDependent * ss * cc) return 0;
    const Eigen::Vector2d f((c * p - b * q) / det, (a * q - b * p) / det);
    if (factor != nullptr) *factor = f;
    return f[0] * p + f[1] * q;
  }
};

}  // namespace

std::size_t hold_outliers(Eigen::VectorXd& values) {
  const double spread = maths::robust_spread({values.begin(), values.end()});
  // More than half of the residuals are exactly zero: there is no scale.
  if (!(spread > 0)) return 0;
  std::size_t outliers = 0;
  for (const double value : values) outliers += std::abs(value) > kOutlier * spread ? 1U : 0U;
  // So many are not outliers but a property of the residual: large on some rows, small on most.
  if (static_cast<double>(outliers) > kMostOutliers * static_cast<double>(values.size())) return 0;
  for (double& value : values) value = std::clamp(value, -kHeld * spread, kHeld * spread);
  return outliers;
}

Eigen::VectorXd KindSample::without(const maths::FunctionSet& functions) const {
  const Eigen::VectorXd beta = maths::coefficients(moments, functions);
  Eigen::VectorXd rest = held;
  for (std::size_t i = 0; i < functions.size(); ++i)
    rest -= basis->matrix.col(functions[i]) * beta[static_cast<Eigen::Index>(i)];
  return rest;
}

namespace {

KindSample make_sample(const model::Measurement& m, const Eigen::VectorXd& residual,
                       const std::vector<std::size_t>& which) {
  KindSample sample;
  sample.kind = m.observations[which.front()].kind;
  const auto n = static_cast<Eigen::Index>(which.size());
  sample.residual.resize(n);
  sample.weight.resize(n);
  for (Eigen::Index i = 0; i < n; ++i) {
    const std::size_t at = which[static_cast<std::size_t>(i)], row = m.observations[at].row;
    const double u = model::uncertainty_of(m, m.observations[at]);
    sample.rows.push_back(row);
    sample.residual[i] = residual[static_cast<Eigen::Index>(at)];
    sample.weight[i] = u > 0 ? 1 / u : 1;
  }
  sample.held = sample.weight.cwiseProduct(sample.residual);
  return sample;
}

/// Returns the tested observations of the fit rows, by kind.
std::vector<std::vector<std::size_t>> tested_observations(const model::Measurement& m) {
  std::array<std::vector<std::size_t>, format::kReadingKindCount> of_kind;
  for (std::size_t i = 0; i < m.observations.size(); ++i)
    if (m.check[m.observations[i].row] == 0)
      of_kind[static_cast<std::size_t>(m.observations[i].kind)].push_back(i);
  std::vector<std::vector<std::size_t>> tested;
  for (const auto& all : of_kind)
    if (all.size() >= kLeastRows) tested.push_back(thinned(all));
  return tested;
}

}  // namespace

std::vector<KindSample> kind_samples(const model::Measurement& m, const Eigen::VectorXd& residual,
                                     const std::vector<RecordedColumn>& columns,
                                     const StructureOptions& options) {
  std::vector<KindSample> list;
  std::vector<std::vector<std::size_t>> observations;
  std::map<std::vector<std::size_t>, Prepared> prepared;  // kinds on the same rows have the same functions
  double readings = 0;
  for (const std::vector<std::size_t>& which : tested_observations(m)) {
    KindSample sample = make_sample(m, residual, which);
    if (!(sample.held.squaredNorm() > 0)) continue;
    sample.outliers = hold_outliers(sample.held);
    auto found = prepared.find(sample.rows);
    if (found == prepared.end()) found = prepared.emplace(sample.rows, prepare(sample, columns)).first;
    set_moments(sample, found->second);
    readings += static_cast<double>(which.size());
    observations.push_back(which);
    list.push_back(std::move(sample));
  }
  // The number of parameters that each kind determines is unknown. Its share of the readings is
  // used.
  const double left = 1 - static_cast<double>(options.fitted_parameters) / std::max(1.0, readings);
  std::vector<double> scale(m.observations.size(), 0), spread;
  for (std::size_t k = 0; k < list.size(); ++k) {
    maths::Moments& moments = list[k].moments;
    moments.freedom *= left;
    list[k].projected = moments;
    spread.push_back(std::sqrt(moments.sum / std::max(1.0, moments.freedom)));
    for (std::size_t i = 0; i < observations[k].size(); ++i)
      scale[observations[k][i]] = list[k].weight[static_cast<Eigen::Index>(i)] / spread[k];
  }
  const Eigen::MatrixXd directions = fitted_directions(scale, options);
  if (directions.cols() > 0) project(list, observations, spread, directions);
  return list;
}

std::pair<double, double> range_of(const KindSample& sample, const RecordedColumn& column) {
  double low = std::numeric_limits<double>::infinity(), high = -low;
  for (const std::size_t row : sample.rows) {
    low = std::min(low, column.value[static_cast<Eigen::Index>(row)]);
    high = std::max(high, column.value[static_cast<Eigen::Index>(row)]);
  }
  return {low, high};
}

std::optional<Period> strongest_period(const KindSample& sample, const RecordedColumn& column,
                                       const Eigen::VectorXd& residual) {
  constexpr double kMostCycles = 100;  // over the range: shorter periods need more positions than are read
  constexpr std::size_t kLeastValues = 12;  // positions: a cycle over the range then has its form
  constexpr double kRowsPerCycle = 6;       // a sine and a mean use three of them
  const std::size_t values = value_count(sample, column), n = sample.rows.size();
  if (values < kLeastValues) return std::nullopt;
  const auto [low, high] = range_of(sample, column);
  // Regular positions have aliases beyond half their number. Scattered positions allow as many
  // periods as there are rows.
  const double most =
      std::min({kMostCycles, static_cast<double>(values - 1) / 2, static_cast<double>(n) / kRowsPerCycle});
  const auto steps = static_cast<std::size_t>(kOversampling * most);
  std::vector<SineSums> sums(steps + 1);
  for (std::size_t i = 0; i < n; ++i) {
    const double x = (column.value[static_cast<Eigen::Index>(sample.rows[i])] - low) / (high - low);
    const double angle = 2 * std::numbers::pi * x / kOversampling, turn_c = std::cos(angle),
                 turn_s = std::sin(angle);
    double c = 1, s = 0;
    for (SineSums& sum : sums) {
      sum.add(c, s, sample.weight[static_cast<Eigen::Index>(i)], residual[static_cast<Eigen::Index>(i)]);
      const double next = c * turn_c - s * turn_s;
      s = s * turn_c + c * turn_s;
      c = next;
    }
  }
  Period best;
  for (std::size_t k = static_cast<std::size_t>(kOversampling); k <= steps; ++k) {
    ++best.tried;
    Eigen::Vector2d factor;
    const double sum = sums[k].explained(&factor);
    if (sum <= best.part.sum) continue;
    best.part.sum = sum;
    best.length = (high - low) * kOversampling / static_cast<double>(k);
    best.factor = factor;
  }
  best.part.rank = 2;
  if (best.tried == 0 || best.length == 0) return std::nullopt;
  return best;
}

double refined_period(const KindSample& sample, const RecordedColumn& column, const Eigen::VectorXd& residual,
                      double length) {
  const auto [low, high] = range_of(sample, column);
  const auto explained = [&, low = low](double frequency) {
    SineSums sums;
    for (std::size_t i = 0; i < sample.rows.size(); ++i) {
      const double angle =
          2 * std::numbers::pi * frequency * (column.value[static_cast<Eigen::Index>(sample.rows[i])] - low);
      sums.add(std::cos(angle), std::sin(angle), sample.weight[static_cast<Eigen::Index>(i)],
               residual[static_cast<Eigen::Index>(i)]);
    }
    return sums.explained(nullptr);
  };
  // Between the two neighbouring steps of the scan; the peak of a sine is wider than this.
  constexpr int kSections = 30;
  const double step = 1 / (kOversampling * (high - low));
  const maths::Peak best = maths::golden_peak(explained, 1 / length - step, 1 / length + step, kSections);
  return best.value > explained(1 / length) ? 1 / best.at : length;
}

PairTest correlate(const Eigen::VectorXd& residual,
                   const std::vector<std::pair<std::size_t, std::size_t>>& pairs) {
  PairTest test;
  test.pairs = static_cast<double>(pairs.size());
  constexpr std::size_t kLeastPairs = 5;  // Fisher's transform divides by the root of pairs - 3
  if (pairs.size() < kLeastPairs) return test;
  double a = 0, b = 0, aa = 0, bb = 0, ab = 0;
  for (const auto& [i, k] : pairs) {
    const double p = residual[static_cast<Eigen::Index>(i)], q = residual[static_cast<Eigen::Index>(k)];
    a += p, b += q, aa += p * p, bb += q * q, ab += p * q;
  }
  const double vary = (aa - a * a / test.pairs) * (bb - b * b / test.pairs);
  if (!(vary > 0)) return test;
  test.correlation = (ab - a * b / test.pairs) / std::sqrt(vary);
  test.log_p = maths::log_correlation_tail(test.correlation, test.pairs);
  return test;
}

PairTest serial_pairs(const KindSample& sample, const model::Measurement& m, const Eigen::VectorXd& residual,
                      std::size_t phase) {
  std::vector<std::pair<std::size_t, std::size_t>> pairs;
  for (std::size_t i = phase; i + 1 < sample.rows.size(); i += 2)
    if (m.states.of(m.states.clock, sample.rows[i]) == m.states.of(m.states.clock, sample.rows[i + 1]))
      pairs.emplace_back(i, i + 1);
  return correlate(residual, pairs);
}

std::vector<std::pair<std::size_t, std::size_t>> neighbour_pairs(
    const KindSample& sample, const std::vector<const RecordedColumn*>& columns) {
  // Number of rows whose neighbours are searched (each with each), and number of neighbours of
  // each.
  constexpr std::size_t kMostPaired = 3000, kNearest = 5;
  const std::size_t n = std::min(sample.rows.size(), kMostPaired);
  Eigen::MatrixXf place(static_cast<Eigen::Index>(columns.size()), static_cast<Eigen::Index>(n));
  for (std::size_t k = 0; k < columns.size(); ++k) {
    Eigen::VectorXf line(static_cast<Eigen::Index>(n));
    for (std::size_t i = 0; i < n; ++i) {
      const double v = columns[k]->value[static_cast<Eigen::Index>(sample.rows[i])];
      line[static_cast<Eigen::Index>(i)] = std::isnan(v) ? 0 : static_cast<float>(v);
    }
    const float range = line.maxCoeff() - line.minCoeff();
    place.row(static_cast<Eigen::Index>(k)) = line / (range > 0 ? range : 1);
  }
  struct Edge {
    float distance;
    std::size_t a, b;
  };
  std::vector<Edge> edges, near;
  for (std::size_t i = 0; i < n; ++i) {
    const Eigen::VectorXf distance =
        (place.colwise() - place.col(static_cast<Eigen::Index>(i))).colwise().squaredNorm();
    near.clear();
    for (std::size_t k = 0; k < n; ++k)
      if (k != i) near.push_back({distance[static_cast<Eigen::Index>(k)], i, k});
    const auto count = std::min(kNearest, near.size());
    std::partial_sort(near.begin(), near.begin() + static_cast<std::ptrdiff_t>(count), near.end(),
                      [](const Edge& p, const Edge& q) { return p.distance < q.distance; });
    edges.insert(edges.end(), near.begin(), near.begin() + static_cast<std::ptrdiff_t>(count));
  }
  std::stable_sort(edges.begin(), edges.end(),
                   [](const Edge& p, const Edge& q) { return p.distance < q.distance; });
  std::vector<char> taken(n, 0);
  std::vector<std::pair<std::size_t, std::size_t>> pairs;
  for (const Edge& edge : edges) {
    if (taken[edge.a] != 0 || taken[edge.b] != 0) continue;
    taken[edge.a] = taken[edge.b] = 1;
    pairs.emplace_back(edge.a, edge.b);
  }
  return pairs;
}

}  // namespace vernier::residual
