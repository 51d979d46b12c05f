// SPDX-License-Identifier: GPL-3.0-or-later
#include "tests/support/hidden_survey_noise.h"

#include <array>
#include <cmath>
#include <functional>
#include <map>
#include <stdexcept>

namespace vernier::support {
namespace {

constexpr std::array<const char*, kNoiseLaws> kNames = {
    "white", "student",   "quantised", "no-u",      "twice-u", "outliers", "set-ups", "autoregressive",
    "walk",  "walk-no-u", "poses",     "growing-u", "drift",   "step",     "jump"};

constexpr double kLeastOutlier = 6, kMostOutlier = 14;  // u

/// The readings of each kind, in the order of rows.
using Series = std::map<model::ObservationKind, std::vector<Eigen::Index>>;
Series series_of(const model::Measurement& m) {
  Series series;
  for (std::size_t i = 0; i < m.observations.size(); ++i)
    series[m.observations[i].kind].push_back(static_cast<Eigen::Index>(i));
  return series;
}

/// An error that each kind draws anew where `begins` says so of a row and the row before.
void add_shared(Eigen::VectorXd& noise, const model::Measurement& m,
                const std::function<bool(std::size_t, std::size_t)>& begins, Draw& draw) {
  for (const auto& one : series_of(m)) {
    const std::vector<Eigen::Index>& readings = one.second;
    double shared = draw.normal();
    for (std::size_t i = 0; i < readings.size(); ++i) {
      const auto row = [&](std::size_t k) {
        return m.observations[static_cast<std::size_t>(readings[k])].row;
      };
      if (i > 0 && begins(row(i - 1), row(i))) shared = draw.normal();
      noise[readings[i]] += shared;
    }
  }
}

bool is_new_run(const model::Measurement& m, std::size_t before, std::size_t row) {
  return m.states.of(m.states.setup, before) != m.states.of(m.states.setup, row);
}

/// A walk along the time within runs, which stands still between them; rms `size` about its mean.
Eigen::VectorXd walk(const model::Measurement& m, double size, Draw& draw) {
  Eigen::VectorXd all = Eigen::VectorXd::Zero(static_cast<Eigen::Index>(m.observations.size()));
  for (const auto& [kind, readings] : series_of(m)) {
    double at = 0;
    for (std::size_t i = 1; i < readings.size(); ++i) {
      const std::size_t row = m.observations[static_cast<std::size_t>(readings[i])].row,
                        before = m.observations[static_cast<std::size_t>(readings[i - 1])].row;
      const double time =
          m.states.time[static_cast<Eigen::Index>(row)] - m.states.time[static_cast<Eigen::Index>(before)];
      at += std::sqrt(is_new_run(m, before, row) ? 0 : std::max(time, 0.0)) * draw.normal();
      all[readings[i]] = at;
    }
    Eigen::VectorXd of_kind = all(readings);
    of_kind.array() -= of_kind.mean();
    const double rms = std::sqrt(of_kind.squaredNorm() / static_cast<double>(of_kind.size()));
    all(readings) = of_kind * (rms > 0 ? size / rms : 0);
  }
  return all;
}

/// From a row well within a run on all readings of a kind are off by the same, till the end or for a third of
/// the rows: a vector in a random direction, so long that the kinds are off by `size` rms.
void add_step(Eigen::VectorXd& noise, const model::Measurement& m, bool back_again, double size, Draw& draw) {
  constexpr std::size_t kApart = 12;  // rows from where a run begins
  std::vector<std::size_t> within;
  for (std::size_t row = m.rows() / 5; row < m.rows() * (back_again ? 3 : 4) / 5; ++row) {
    bool inside = row >= kApart && row + kApart < m.rows();
    for (std::size_t k = row - std::min(row, kApart); inside && k + 1 < row + kApart; ++k)
      inside = !is_new_run(m, k, k + 1);
    if (inside) within.push_back(row);
  }
  const std::size_t from = within.empty() ? m.rows() / 2 : draw.pick(within);
  const std::size_t to = back_again ? from + m.rows() / 3 : m.rows();
  std::map<model::ObservationKind, double> height;
  double squares = 0;
  for (const auto& [kind, readings] : series_of(m)) {
    height[kind] = draw.normal();
    squares += height[kind] * height[kind];
  }
  const double scale = size * std::sqrt(static_cast<double>(height.size()) / squares);
  for (std::size_t i = 0; i < m.observations.size(); ++i)
    if (m.observations[i].row >= from && m.observations[i].row < to)
      noise[static_cast<Eigen::Index>(i)] += scale * height[m.observations[i].kind];
}

/// Student's t of 3 degrees of freedom from a normal number, variance 1.
double student(double normal, Draw& draw) {
  double squares = 0;
  for (int k = 0; k < 3; ++k) squares += std::pow(draw.normal(), 2);
  return normal / std::sqrt(squares / 3) / std::sqrt(3.0);
}

void add_outliers(Eigen::VectorXd& noise, const model::Measurement& m, Draw& draw,
                  std::vector<std::size_t>& wild) {
  std::size_t last = m.rows();
  bool is_wild = false;
  for (std::size_t i = 0; i < m.observations.size(); ++i) {
    const std::size_t row = m.observations[i].row;
    if (row != last) is_wild = draw.chance(kOutlierShare);
    if (is_wild && row != last) wild.push_back(row);
    last = row;
    if (is_wild)
      noise[static_cast<Eigen::Index>(i)] += draw.sign() * draw.uniform(kLeastOutlier, kMostOutlier);
  }
}

void regress(Eigen::VectorXd& noise, const model::Measurement& m) {
  for (const auto& [kind, readings] : series_of(m))
    for (std::size_t i = 1; i < readings.size(); ++i)
      noise[readings[i]] = kAutoregression * noise[readings[i - 1]] +
                           std::sqrt(1 - kAutoregression * kAutoregression) * noise[readings[i]];
}

}  // namespace

const char* noise_law_name(NoiseLaw law) { return kNames[static_cast<std::size_t>(law)]; }

NoiseLaw noise_law_named(const std::string& name) {
  for (std::size_t i = 0; i < kNames.size(); ++i)
    if (name == kNames[i]) return static_cast<NoiseLaw>(i);
  throw std::invalid_argument("\"" + name + "\": no law of noise");
}

double whole_noise(NoiseLaw law) {
  switch (law) {
    case NoiseLaw::kTwice:
      return 2;
    case NoiseLaw::kOutliers: {
      const double squares = (std::pow(kMostOutlier, 3) - std::pow(kLeastOutlier, 3)) / 3;
      return std::sqrt(1 + kOutlierShare * squares / (kMostOutlier - kLeastOutlier));
    }
    case NoiseLaw::kSetUps:
    case NoiseLaw::kWalk:
    case NoiseLaw::kWalkNoU:
    case NoiseLaw::kPoses:
      return std::sqrt(2.0);
    default:
      return 1;
  }
}

void repeat_poses(std::vector<MotionRow>& rows, Draw& draw) {
  constexpr std::size_t kTimes = 3;
  constexpr double kMost = 20, kStep = 1e-4;  // 2 um, or 7 arcsec, in steps of the file
  std::size_t first = 0;
  for (std::size_t r = 1; r < rows.size(); ++r) {
    if (rows[r].run != rows[first].run || r - first == kTimes) {
      first = r;
      continue;
    }
    const double t = rows[r].t;
    rows[r] = rows[first];
    rows[r].t = t;
    for (double& q : rows[r].q) q = (std::round(q / kStep) + std::round(draw.uniform(-kMost, kMost))) * kStep;
  }
}

Eigen::VectorXd noise_of(NoiseLaw law, const model::Measurement& m, Eigen::VectorXd white, Draw& draw,
                         std::vector<std::size_t>& wild) {
  Eigen::VectorXd noise = std::move(white);
  switch (law) {
    case NoiseLaw::kStudent:
      for (double& one : noise) one = student(one, draw);
      break;
    case NoiseLaw::kQuantised:
      noise *= std::sqrt(1 - kQuantum * kQuantum / 12);  // variance of the rounding: q^2/12
      break;
    case NoiseLaw::kTwice:
      noise *= 2;
      break;
    case NoiseLaw::kOutliers:
      add_outliers(noise, m, draw, wild);
      break;
    case NoiseLaw::kSetUps:
      add_shared(
          noise, m, [&](std::size_t before, std::size_t row) { return is_new_run(m, before, row); }, draw);
      break;
    case NoiseLaw::kAutoregressive:
      regress(noise, m);
      break;
    case NoiseLaw::kWalk:
    case NoiseLaw::kWalkNoU:
      noise += walk(m, 1, draw);
      break;
    case NoiseLaw::kPoses:
      // Readings of a pose are copies but for 2 um: a pose begins where an axis has gone further.
      add_shared(
          noise, m,
          [&](std::size_t before, std::size_t row) {
            constexpr double kFar = 5e-3;
            bool far = is_new_run(m, before, row);
            for (const model::Column& axis : m.states.axis)
              far = far || std::abs(axis[static_cast<Eigen::Index>(row)] -
                                    axis[static_cast<Eigen::Index>(before)]) > kFar;
            return far;
          },
          draw);
      break;
    case NoiseLaw::kDrift:
      noise += walk(m, kDisturbance, draw);
      break;
    case NoiseLaw::kStep:
    case NoiseLaw::kJump:
      add_step(noise, m, law == NoiseLaw::kJump, kDisturbance, draw);
      break;
    default:
      break;
  }
  return noise;
}

std::vector<double> growing_u(const Eigen::Matrix3Xd& points) {
  const Eigen::Vector3d low = points.rowwise().minCoeff(), high = points.rowwise().maxCoeff();
  const Eigen::Vector3d corner = low - 0.1 * (high - low);
  std::vector<double> u;
  double squares = 0;
  const double longest = std::max((high - corner).norm(), 1e-300);
  for (Eigen::Index i = 0; i < points.cols(); ++i) {
    u.push_back(0.4 + 1.6 * (points.col(i) - corner).norm() / longest);
    squares += u.back() * u.back();
  }
  for (double& one : u) one /= std::sqrt(squares / static_cast<double>(u.size()));
  return u;
}

}  // namespace vernier::support
