// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/offline/path_fit.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "tools/maths/decompositions.h"
#include "tools/maths/golden.h"

namespace vernier::offline {
namespace {

using Eigen::Index, Eigen::MatrixXd, Eigen::Vector2d, Eigen::VectorXd;

constexpr double kTurn = 2 * std::numbers::pi;

double cross(const Vector2d& a, const Vector2d& b) { return a.x() * b.y() - a.y() * b.x(); }

bool line_fits(const MatrixXd& points, Index from, Index to, double most) {
  const VectorXd way = points.col(to) - points.col(from);
  const double length = way.squaredNorm();
  for (Index k = from + 1; k < to; ++k) {
    const VectorXd off = points.col(k) - points.col(from);
    const double share = length > 0 ? std::clamp(off.dot(way) / length, 0.0, 1.0) : 0;
    if ((off - share * way).squaredNorm() > most * most) return false;
  }
  return true;
}

/// Arcs through points of a path.
class ArcFit {
 public:
  ArcFit(const MatrixXd& points, const ArcGuide& guide, double most)
      : points_(points), guide_(guide), most_(most) {}

  /// The arc from one point to another that stays near all points between them; empty if no arc does.
  std::optional<PathPiece> arc(Index from, Index to) const {
    const double turn =
        guide_.angle[static_cast<std::size_t>(to)] - guide_.angle[static_cast<std::size_t>(from)];
    const bool whole = std::abs(turn) > kTurn - kNoTurn;
    if (std::abs(turn) < kNoTurn || (std::abs(turn) > kMostTurn && !whole)) return std::nullopt;
    const auto centre = whole ? circle_through(from, to, turn) : bow_through(from, to, turn);
    if (!centre || !fits(from, to, turn, *centre, whole)) return std::nullopt;
    return PathPiece{to, centre, whole};
  }

 private:
  static constexpr double kNoTurn = 1e-9;  // of a full turn: rounding
  /// Rounding of an end must not change a nearly full turn to no turn in a control, or the reverse.
  static constexpr double kMostTurn = 0.75 * kTurn;
  static constexpr double kLeastChord = 1e-3;  // mm: a hundred times the written resolution
  static constexpr Index kLookedAt = 64;       // points that the centre is fitted to; all are judged

  Vector2d place(Index k) const { return {points_(guide_.axis[0], k), points_(guide_.axis[1], k)}; }

  template <typename Take>
  void each(Index from, Index to, const Take& take) const {
    const Index step = std::max<Index>(1, (to - from) / kLookedAt);
    for (Index k = from + step; k < to; k += step) take(place(k));
  }

  /// Centre on the bisector of the chord. The farthest point's distance is a convex, nearly linear function
  /// of it: least squares first, then the smallest maximum near it.
  std::optional<Vector2d> bow_through(Index from, Index to, double turn) const {
    const Vector2d begin = place(from), chord = place(to) - begin;
    const double half = chord.norm() / 2;
    if (2 * half < kLeastChord) return std::nullopt;
    const Vector2d middle = begin + chord / 2, left(-chord.y() / (2 * half), chord.x() / (2 * half));
    const auto off = [&](double height, const Vector2d& p) {
      return (p - middle - height * left).norm() - std::hypot(half, height);
    };
    double height = half / std::tan(turn / 2), width = 0;
    // Newton's steps, and places at which the width is looked at.
    constexpr int kSteps = 3, kSections = 24;
    for (int n = 0; n < kSteps; ++n) {
      double product = 0, squares = 0, largest = 0, steepest = 0;
      each(from, to, [&](const Vector2d& p) {
        const Vector2d out = p - middle - height * left;
        const double slope = -out.dot(left) / out.norm() - height / std::hypot(half, height);
        const double rest = off(height, p);
        product += slope * rest, squares += slope * slope;
        largest = std::max(largest, std::abs(rest)), steepest = std::max(steepest, std::abs(slope));
      });
      if (!(squares > 0)) return middle + height * left;
      height -= product / squares;
      width = largest / steepest;
    }
    const auto worst = [&](double h) {
      double largest = 0;
      each(from, to, [&](const Vector2d& p) { largest = std::max(largest, std::abs(off(h, p))); });
      return -largest;
    };
    return middle + maths::golden_peak(worst, height - width, height + width, kSections).at * left;
  }

  /// Centre of a circle through the first point, by least squares over the others.
  std::optional<Vector2d> circle_through(Index from, Index to, double turn) const {
    constexpr double kClosed = 0.1;  // share of the allowed error of a path
    const Vector2d begin = place(from);
    if ((place(to) - begin).norm() > kClosed * most_) return std::nullopt;
    const Vector2d opposite = place(nearest(from, to, turn / 2));
    Vector2d centre = (begin + opposite) / 2;
    constexpr int kSteps = 4;  // Gauss and Newton's
    for (int n = 0; n < kSteps; ++n) {
      std::vector<Vector2d> slopes;
      std::vector<double> rests;
      const Vector2d own = begin - centre;
      each(from, to, [&](const Vector2d& p) {
        const Vector2d out = p - centre;
        slopes.emplace_back(own.normalized() - out.normalized());
        rests.push_back(out.norm() - own.norm());
      });
      const auto count = static_cast<Index>(rests.size());
      if (count < 3) return std::nullopt;
      MatrixXd a(count, 2);
      for (Index k = 0; k < count; ++k) a.row(k) = slopes[static_cast<std::size_t>(k)].transpose();
      centre -= maths::least_squares(a, Eigen::Map<const VectorXd>(rests.data(), count));
    }
    return centre;
  }

  Index nearest(Index from, Index to, double turn) const {
    const auto wanted = [&](Index k) {
      return std::abs(guide_.angle[static_cast<std::size_t>(k)] -
                      guide_.angle[static_cast<std::size_t>(from)] - turn);
    };
    Index best = from;
    for (Index k = from; k <= to; ++k)
      if (wanted(k) < wanted(best)) best = k;
    return best;
  }

  bool fits(Index from, Index to, double turn, const Vector2d& centre, bool whole) const {
    const Vector2d begin = place(from) - centre;
    const double radius = begin.norm();
    const auto angle_at = [&](Index k, double near) {
      const Vector2d out = place(k) - centre;
      const double angle = std::atan2(cross(begin, out), begin.dot(out));
      return angle + kTurn * std::round((near - angle) / kTurn);
    };
    const double sweep = whole ? std::copysign(kTurn, turn) : angle_at(to, turn);
    if (!(radius > 0) || sweep * turn <= 0) return false;
    VectorXd way = points_.col(to) - points_.col(from);
    way[guide_.axis[0]] = way[guide_.axis[1]] = 0;
    for (Index k = from + 1; k < to; ++k) {
      const double own =
          guide_.angle[static_cast<std::size_t>(k)] - guide_.angle[static_cast<std::size_t>(from)];
      const double angle = angle_at(k, own), share = std::clamp(angle / sweep, 0.0, 1.0);
      const double along = radius * (angle - share * sweep);
      const double across = (place(k) - centre).norm() - radius;
      VectorXd rest = points_.col(k) - points_.col(from) - share * way;
      rest[guide_.axis[0]] = across, rest[guide_.axis[1]] = along;
      if (rest.squaredNorm() > most_ * most_) return false;
    }
    return true;
  }

  const MatrixXd& points_;
  const ArcGuide& guide_;
  double most_;
};

/// The farthest place that fits, from one that does: by steps that double, then halving.
template <typename Fits>
Index reach(Index good, Index step, Index last, const Fits& fits) {
  while (good < last && fits(std::min(good + step, last))) {
    good = std::min(good + step, last);
    step *= 2;
  }
  Index beyond = std::min(good + step, last + 1);
  if (good == last) return last;
  while (beyond - good > 1) {
    const Index middle = good + (beyond - good) / 2;
    (fits(middle) ? good : beyond) = middle;
  }
  return good;
}

}  // namespace

std::vector<PathPiece> fit_path(const MatrixXd& points, const std::optional<ArcGuide>& guide, double most) {
  std::vector<PathPiece> pieces;
  const Index last = points.cols() - 1;
  std::optional<ArcFit> arcs;
  if (guide) arcs.emplace(points, *guide, most);
  for (Index from = 0; from < last;) {
    const auto straight = [&](Index to) { return line_fits(points, from, to, most); };
    const auto round = [&](Index to) { return arcs->arc(from, to).has_value(); };
    // A whole move in one block is tried first: no beginning of it need fit as well.
    std::optional<PathPiece> best;
    if (from == 0 && straight(last)) best = PathPiece{last, {}, false};
    if (from == 0 && !best && arcs) best = arcs->arc(from, last);
    if (!best) best = PathPiece{reach(from + 1, 1, last, straight), {}, false};
    if (arcs && best->to < last && !best->centre) {
      // An arc so short that a line fits as well does not determine its centre.
      const Index to = reach(best->to, best->to - from, last, round);
      if (to > best->to) best = arcs->arc(from, to);
    }
    pieces.push_back(*best);
    from = best->to;
  }
  return pieces;
}

double distance_from(const PathPiece& piece, const MatrixXd& points, Index from,
                     const std::optional<ArcGuide>& guide, const VectorXd& place) {
  const VectorXd begin = points.col(from);
  VectorXd way = points.col(piece.to) - begin, rest = place - begin;
  if (!piece.centre || !guide) {
    const double length = way.squaredNorm();
    const double share = length > 0 ? std::clamp(rest.dot(way) / length, 0.0, 1.0) : 0;
    return (rest - share * way).norm();
  }
  const auto from_centre = [&](const VectorXd& at) -> Vector2d {
    return Vector2d(at[guide->axis[0]], at[guide->axis[1]]) - *piece.centre;
  };
  const Vector2d start = from_centre(begin), out = from_centre(place);
  const double radius = start.norm();
  const double turn =
      guide->angle[static_cast<std::size_t>(piece.to)] - guide->angle[static_cast<std::size_t>(from)];
  const double sense = std::copysign(1, turn);
  const auto forward = [&](const Vector2d& at) {  // 0 to a turn, in the direction of the arc
    const double angle = sense * std::atan2(cross(start, at), start.dot(at));
    return angle < 0 ? angle + kTurn : angle;
  };
  const double sweep = piece.whole ? kTurn : forward(from_centre(points.col(piece.to)));
  double angle = forward(out);
  if (angle > (sweep + kTurn) / 2) angle -= kTurn;  // just before the begin
  const double share = sweep > 0 ? std::clamp(angle / sweep, 0.0, 1.0) : 0;
  way[guide->axis[0]] = way[guide->axis[1]] = 0;
  rest -= share * way;
  rest[guide->axis[0]] = out.norm() - radius;
  rest[guide->axis[1]] = radius * (angle - share * sweep);
  return rest.norm();
}

}  // namespace vernier::offline
