// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/offline/path_fit.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <random>

namespace vernier::path_fit_test {

using namespace vernier::offline;
namespace {

using Eigen::Index, Eigen::MatrixXd, Eigen::Vector2d, Eigen::Vector3d;

constexpr double kRadius_mm = 50, kMost_mm = 0.0004;

struct Path {
  MatrixXd points;
  ArcGuide guide;
};

/// An arc about (300, 200) that something is added to.
template <typename Add>
Path arc(double begin, double turn, const Add& add, Index count = 2000) {
  Path path{MatrixXd(3, count + 1), {{0, 1}, {}}};
  for (Index k = 0; k <= count; ++k) {
    const double share = static_cast<double>(k) / static_cast<double>(count), angle = begin + turn * share;
    const Vector3d own(300 + kRadius_mm * std::cos(angle), 200 + kRadius_mm * std::sin(angle),
                       -50 + 4 * share);
    path.points.col(k) = own + add(angle);
    path.guide.angle.push_back(angle);
  }
  return path;
}

/// The farthest that a path's points are from its pieces, by looking at many places of each piece.
double farthest(const Path& path, const std::vector<PathPiece>& pieces) {
  double worst = 0;
  Index from = 0;
  for (const PathPiece& piece : pieces) {
    const Vector3d begin = path.points.col(from), end = path.points.col(piece.to);
    constexpr int kLooks = 4000;
    std::vector<Vector3d> places;
    for (int n = 0; n <= kLooks; ++n) {
      const double share = static_cast<double>(n) / kLooks;
      Vector3d place = begin + share * (end - begin);
      if (piece.centre) {
        const Vector2d out = begin.head<2>() - *piece.centre, in = end.head<2>() - *piece.centre;
        const double turn = path.guide.angle[static_cast<std::size_t>(piece.to)] -
                            path.guide.angle[static_cast<std::size_t>(from)];
        double sweep = std::atan2(out.x() * in.y() - out.y() * in.x(), out.dot(in));
        sweep += 2 * M_PI * std::round((turn - sweep) / (2 * M_PI));
        place.head<2>() = *piece.centre + Eigen::Rotation2Dd(sweep * share) * out;
      }
      places.push_back(place);
    }
    std::size_t near = 0;
    for (Index k = from; k <= piece.to; ++k) {
      const Vector3d point = path.points.col(k);
      while (near + 1 < places.size() && (places[near + 1] - point).norm() <= (places[near] - point).norm())
        ++near;
      // Beside the nearest place: the distance from the chord to its neighbours.
      double least = (places[near] - point).norm();
      for (const std::size_t next : {near, near + 1}) {
        if (next == 0 || next >= places.size()) continue;
        const Vector3d way = places[next] - places[next - 1], off = point - places[next - 1];
        const double along = std::clamp(off.dot(way) / way.squaredNorm(), 0.0, 1.0);
        least = std::min(least, (off - along * way).norm());
      }
      worst = std::max(worst, least);
    }
    from = piece.to;
  }
  EXPECT_EQ(from, path.points.cols() - 1);
  return worst;
}

Vector3d nothing(double) { return Vector3d::Zero(); }

TEST(PathFit, AWholeCircleThatIsMovedIsOneBlock) {
  const Path path = arc(0.3, 2 * M_PI, [](double) { return Vector3d(0.02, -0.013, 0.1); });
  const auto pieces = fit_path(path.points, path.guide, kMost_mm);
  ASSERT_EQ(pieces.size(), 1u);
  EXPECT_TRUE(pieces[0].whole);
  EXPECT_NEAR((*pieces[0].centre - Vector2d(300.02, 199.987)).norm(), 0, 1e-9);
  // The same the other way round, and wider by a scale error of the whole plane.
  const Path back = arc(0.3, -2 * M_PI, [](double a) { return Vector3d(0.01 * cos(a), 0.01 * sin(a), 0); });
  ASSERT_EQ(fit_path(back.points, back.guide, kMost_mm).size(), 1u);
}

TEST(PathFit, ArcsAreShorterThanThreeQuartersOfATurn) {
  const Path path = arc(0.3, 1.99 * M_PI, nothing);
  const auto pieces = fit_path(path.points, path.guide, kMost_mm);
  ASSERT_EQ(pieces.size(), 2u);
  for (const PathPiece& piece : pieces) EXPECT_TRUE(piece.centre && !piece.whole);
  EXPECT_LT(farthest(path, pieces), 1e-5);  // the looks of the judge: 0.06 mm chords at 50 mm
}

TEST(PathFit, AnEllipseTakesAFewArcsWhereChordsAreHundreds) {
  // 0.1 mrad of squareness: the circle becomes an ellipse that is 5 um wider along one diagonal.
  const auto square = [](double a) { return Vector3d(1e-4 * kRadius_mm * std::sin(a), 0, 0); };
  for (const double turn : {2 * M_PI, -2 * M_PI, 1.0, -4.0}) {
    const Path path = arc(-1, turn, square);
    const auto pieces = fit_path(path.points, path.guide, kMost_mm),
               chords = fit_path(path.points, std::nullopt, kMost_mm);
    EXPECT_LT(pieces.size() * 20, chords.size()) << turn;
    EXPECT_LE(pieces.size(), 12u) << turn;
    EXPECT_LT(farthest(path, pieces), kMost_mm + 1e-5) << turn;
    EXPECT_LT(farthest(path, chords), kMost_mm + 1e-5) << turn;
    for (const PathPiece& piece : chords) EXPECT_FALSE(piece.centre);
  }
}

TEST(PathFit, WhateverIsAddedTheBoundHolds) {
  constexpr unsigned kSeed = 4711;
  std::mt19937_64 random(kSeed);
  RecordProperty("seed", static_cast<int>(kSeed));
  std::uniform_real_distribution<double> any(-1, 1);
  std::size_t arcs = 0;
  for (int trial = 0; trial < 60; ++trial) {
    const double size = std::pow(10, -1 - 2 * std::abs(any(random))), turns = 1 + 20 * std::abs(any(random));
    const Vector3d along(any(random), any(random), any(random));
    const double turn = 2 * M_PI * (trial % 3 == 0 ? 1 : std::abs(any(random))) * (trial % 2 == 0 ? 1 : -1);
    const Path path =
        arc(any(random), turn, [&](double a) -> Vector3d { return size * std::sin(turns * a) * along; });
    const auto pieces = fit_path(path.points, path.guide, kMost_mm);
    for (const PathPiece& piece : pieces) arcs += piece.centre ? 1 : 0;
    EXPECT_LT(farthest(path, pieces), kMost_mm + 1e-5) << trial;
    // The distance that the program states, of the points themselves: along the arc it counts as well.
    Index from = 0;
    double stated = 0;
    for (const PathPiece& piece : pieces) {
      for (Index k = from; k <= piece.to; ++k)
        stated = std::max(stated, distance_from(piece, path.points, from, path.guide, path.points.col(k)));
      from = piece.to;
    }
    EXPECT_LT(stated, kMost_mm + 1e-9) << trial;
    EXPECT_GT(stated, farthest(path, pieces) - 1e-5) << trial;
  }
  EXPECT_GT(arcs, 100u);
}

TEST(PathFit, ALineThatReachesAsFarIsTaken) {
  MatrixXd points(3, 101);
  for (Index k = 0; k <= 100; ++k) points.col(k) = Vector3d(static_cast<double>(k), 2, 3);
  const auto pieces = fit_path(points, std::nullopt, kMost_mm);
  ASSERT_EQ(pieces.size(), 1u);
  EXPECT_FALSE(pieces[0].centre);
  // An arc of 0.1 mm and 1e-6 rad is a line, whatever its guide says.
  const Path path = arc(0, 2e-5, nothing, 10);
  EXPECT_FALSE(fit_path(path.points, path.guide, kMost_mm).at(0).centre);
}

}  // namespace
}  // namespace vernier::path_fit_test
