// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <Eigen/Core>
#include <cstddef>
#include <optional>
#include <string>
#include <vector>

namespace vernier::importer {

/// A dwell: an interval in the log of a machine in which no axis moved.
struct Dwell {
  std::size_t first = 0, last = 0;  // first and last row of the dwell in the log
  double begin_s = 0, end_s = 0;
  double middle_s() const { return (begin_s + end_s) / 2; }
};

/// Returns the dwells of a log: intervals of at least `least_s` in which every axis stays within its
/// tolerance of its position at the beginning of the interval. `time`: s, increasing; `axes`: rows x axes;
/// `tolerance`: one value per axis, in the unit of the axis.
std::vector<Dwell> find_dwells(const Eigen::VectorXd& time, const Eigen::MatrixXd& axes,
                               const Eigen::VectorXd& tolerance, double least_s);

struct PairingInput {
  std::vector<Dwell> dwells;
  /// Tool point of the nominal machine in each dwell, mm (3 x dwells). If the matrix of tool points is empty,
  /// distances are not used.
  Eigen::Matrix3Xd stand;
  Eigen::Matrix3Xd point;  // points that the instrument measured, mm, in its frame (3 x points), in the order
                           // of the measurement
  std::optional<Eigen::VectorXd> time;  // time of each point by the clock of the instrument, s
  double distance_tolerance_mm = 2;  // permitted difference of a distance between two points, machine against
                                     // nominal machine
};

struct Pairing {
  std::vector<std::optional<std::size_t>> dwell;  // index of the dwell of each point
  std::vector<std::size_t> unused;                // indices of the dwells without a point
  /// Relation of the two clocks: clock of the log = offset + (1 + drift) x clock of the instrument. The
  /// members with `std` are the standard uncertainties of offset and drift.
  std::optional<double> offset_s, offset_std_s, drift, drift_std;
  std::optional<double> rms_mm;  // rms distance of the paired points after the best rigid motion
};

/// Finds the dwell in which each point was measured, if there was no trigger signal or points were lost.
/// pair_points aligns both sequences so that times, and distances between neighbouring points, agree best.
/// (Distances do not depend on the frame.) Dwells and points without a partner are skipped; the order of both
/// sequences does not change. After the alignment, pair_points fits one clock relation and one rigid motion
/// for all pairs. Pairs that do not agree with the fitted clock relation and rigid motion are separated
/// again. Throws InputError if neither times nor nominal tool points are given, and the numbers of dwells
/// and points are different.
Pairing pair_points(const PairingInput& input);

}  // namespace vernier::importer
