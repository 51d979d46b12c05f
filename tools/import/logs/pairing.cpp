// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/import/logs/pairing.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "tools/maths/alignment.h"
#include "tools/text/error.h"

namespace vernier::importer {
namespace {

using Index = Eigen::Index;

Index at(std::size_t i) { return static_cast<Index>(i); }

/// Alignment of both sequences by dynamic programming over the last pair.
class Alignment {
 public:
  explicit Alignment(const PairingInput& input) : in_(input) {}

  std::vector<std::optional<std::size_t>> best() const {
    const std::size_t points = at_size(in_.point), dwells = in_.dwells.size();
    struct Cell {
      double cost = 0;
      std::ptrdiff_t point = -1, dwell = -1;  // of the pair before
    };
    std::vector<std::vector<Cell>> cells(points, std::vector<Cell>(dwells));
    for (std::size_t i = 0; i < points; ++i)
      for (std::size_t j = 0; j < dwells; ++j) {
        cells[i][j].cost = kSkip * static_cast<double>(i + j);
        for (std::size_t back = 1; back <= std::min(i, kReach); ++back)
          for (std::size_t aside = 1; aside <= std::min(j, kReach); ++aside) {
            const double cost = cells[i - back][j - aside].cost + misfit(i - back, i, j - aside, j) +
                                kSkip * static_cast<double>(back + aside - 2);
            if (cost < cells[i][j].cost)
              cells[i][j] = {cost, static_cast<std::ptrdiff_t>(i - back),
                             static_cast<std::ptrdiff_t>(j - aside)};
          }
      }
    double least = HUGE_VAL;
    std::ptrdiff_t i = -1, j = -1;
    for (std::size_t a = 0; a < points; ++a)
      for (std::size_t b = 0; b < dwells; ++b) {
        const double cost = cells[a][b].cost + kSkip * static_cast<double>(points - 1 - a + dwells - 1 - b);
        if (cost < least)
          least = cost, i = static_cast<std::ptrdiff_t>(a), j = static_cast<std::ptrdiff_t>(b);
      }
    std::vector<std::optional<std::size_t>> pair(points);
    while (i >= 0) {
      pair[static_cast<std::size_t>(i)] = static_cast<std::size_t>(j);
      const Cell& cell = cells[static_cast<std::size_t>(i)][static_cast<std::size_t>(j)];
      i = cell.point, j = cell.dwell;
    }
    return pair;
  }

 private:
  static std::size_t at_size(const Eigen::Matrix3Xd& points) {
    return static_cast<std::size_t>(points.cols());
  }

  /// Of two neighbouring pairs: how badly ways and times between them agree, each held at what leaving out
  /// two costs.
  double misfit(std::size_t p0, std::size_t p1, std::size_t d0, std::size_t d1) const {
    double cost = 0;
    if (in_.stand.cols() > 0) {
      const double measured = (in_.point.col(at(p1)) - in_.point.col(at(p0))).norm(),
                   stood = (in_.stand.col(at(d1)) - in_.stand.col(at(d0))).norm();
      cost += std::pow((measured - stood) / in_.distance_tolerance_mm, 2);
    }
    if (in_.time) {
      const Dwell &a = in_.dwells[d0], &b = in_.dwells[d1];
      // A point may have been taken anywhere in its dwell.
      const double room = (a.end_s - a.begin_s + b.end_s - b.begin_s) / 2;
      cost += std::pow(((*in_.time)[at(p1)] - (*in_.time)[at(p0)] - (b.middle_s() - a.middle_s())) / room, 2);
    }
    return std::min(cost, kWorst);
  }

  static constexpr std::size_t kReach = 8;  // neighbours looked back over: so many may be missing in a row
  static constexpr double kSkip = 4;        // leaving one out costs what two tolerances of misfit do
  static constexpr double kWorst = 1e6;     // no pair of a chain costs as much
  const PairingInput& in_;
};

/// Straight line of the log's clock over the instrument's.
void find_clock(const PairingInput& input, Pairing& result) {
  std::vector<double> x, y;
  for (std::size_t i = 0; i < result.dwell.size(); ++i)
    if (result.dwell[i])
      x.push_back((*input.time)[at(i)]), y.push_back(input.dwells[*result.dwell[i]].middle_s());
  if (x.size() < 3) return;
  const auto n = at(x.size());
  Eigen::MatrixXd basis(n, 2);
  Eigen::VectorXd rest = Eigen::Map<Eigen::VectorXd>(y.data(), n) - Eigen::Map<Eigen::VectorXd>(x.data(), n);
  const double mean = Eigen::Map<Eigen::VectorXd>(x.data(), n).mean();
  basis << Eigen::VectorXd::Ones(n), (Eigen::Map<Eigen::ArrayXd>(x.data(), n) - mean).matrix();
  const double spread = basis.col(1).squaredNorm(), middle = rest.mean();
  if (!(spread > 0)) return;
  const double slope = basis.col(1).dot(rest) / spread;
  rest -= basis * Eigen::Vector2d(middle, slope);
  const double variance = rest.squaredNorm() / static_cast<double>(n - 2);
  result.drift = slope, result.drift_std = std::sqrt(variance / spread);
  result.offset_s = middle - slope * mean;
  result.offset_std_s = std::sqrt(variance / static_cast<double>(n) + variance * mean * mean / spread);
}

/// Separates the pairs whose point is outside its dwell by the common clock; true if there were such pairs.
bool drop_by_clock(const PairingInput& input, Pairing& result) {
  find_clock(input, result);
  if (!result.offset_s) return false;
  bool any = false;
  for (std::size_t i = 0; i < result.dwell.size(); ++i) {
    if (!result.dwell[i]) continue;
    const Dwell& dwell = input.dwells[*result.dwell[i]];
    const double t = *result.offset_s + (1 + *result.drift) * (*input.time)[at(i)];
    const double room =
        (dwell.end_s - dwell.begin_s) / 2;  // half a dwell more: the clock is not known better
    if (t >= dwell.begin_s - room && t <= dwell.end_s + room) continue;
    result.dwell[i] = std::nullopt, any = true;
  }
  return any;
}

/// The same for points far from the position of their dwell by one rigid motion.
bool drop_by_place(const PairingInput& input, Pairing& result) {
  std::vector<std::size_t> paired;
  for (std::size_t i = 0; i < result.dwell.size(); ++i)
    if (result.dwell[i]) paired.push_back(i);
  Eigen::Matrix3Xd from(3, at(paired.size())), to(3, at(paired.size()));
  for (std::size_t k = 0; k < paired.size(); ++k) {
    from.col(at(k)) = input.stand.col(at(*result.dwell[paired[k]]));
    to.col(at(k)) = input.point.col(at(paired[k]));
  }
  if (!maths::fixes_motion(from)) return false;
  const Eigen::VectorXd off = maths::aligned_error(maths::align(from, to), from, to).colwise().norm();
  result.rms_mm = std::sqrt(off.squaredNorm() / static_cast<double>(off.size()));
  constexpr double kBeyond = 3;  // tolerances: an unmatched point is farther
  Index worst = 0;
  if (off.maxCoeff(&worst) <= kBeyond * input.distance_tolerance_mm) return false;
  result.dwell[paired[static_cast<std::size_t>(worst)]] = std::nullopt;
  return true;
}

}  // namespace

std::vector<Dwell> find_dwells(const Eigen::VectorXd& time, const Eigen::MatrixXd& axes,
                               const Eigen::VectorXd& tolerance, double least_s) {
  std::vector<Dwell> dwells;
  const auto still = [&](Index first, Index row) {
    return ((axes.row(row) - axes.row(first)).transpose().cwiseAbs().array() <= tolerance.array()).all();
  };
  for (Index first = 0; first < time.size();) {
    Index last = first;
    while (last + 1 < time.size() && still(first, last + 1)) ++last;
    const bool dwell = last > first && time[last] - time[first] >= least_s;
    if (dwell)
      dwells.push_back(
          {static_cast<std::size_t>(first), static_cast<std::size_t>(last), time[first], time[last]});
    first = dwell ? last + 1 : first + 1;
  }
  return dwells;
}

Pairing pair_points(const PairingInput& input) {
  Pairing result;
  const auto points = static_cast<std::size_t>(input.point.cols());
  if (input.stand.cols() == 0 && !input.time) {
    if (points != input.dwells.size())
      throw text::InputError(
          fmt::format("{} points and {} dwells, but no data to pair them: give a column t, or --machine for "
                      "the distances between the dwells",
                      points, input.dwells.size()));
    for (std::size_t i = 0; i < points; ++i) result.dwell.emplace_back(i);
    return result;
  }
  result.dwell = Alignment(input).best();
  if (input.time)
    while (drop_by_clock(input, result)) {
    }
  if (input.stand.cols() > 0)
    while (drop_by_place(input, result)) {
    }
  if (input.time) find_clock(input, result);
  std::vector<char> used(input.dwells.size());
  for (const auto& dwell : result.dwell)
    if (dwell) used[*dwell] = 1;
  for (std::size_t j = 0; j < used.size(); ++j)
    if (used[j] == 0) result.unused.push_back(j);
  return result;
}

}  // namespace vernier::importer
