// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <Eigen/Core>
#include <cstddef>
#include <optional>
#include <string>
#include <vector>

namespace vernier::importer {

/// A stretch of a machine's log in which no axis moved.
struct Dwell {
  std::size_t first = 0, last = 0;  // rows of the log, inclusive
  double begin_s = 0, end_s = 0;
  double middle_s() const { return (begin_s + end_s) / 2; }
};

/// Returns the dwells: intervals of at least `least_s` in which every axis stays within its tolerance of its
/// position at the beginning of the interval. time: s, increasing; axes: rows x axes; tolerance: one per
/// axis, same unit.
std::vector<Dwell> find_dwells(const Eigen::VectorXd& time, const Eigen::MatrixXd& axes,
                               const Eigen::VectorXd& tolerance, double least_s);

struct PairingInput {
  std::vector<Dwell> dwells;
  /// Tool point of the nominal machine in each dwell, mm (3 x dwells); empty: distances are not used.
  Eigen::Matrix3Xd stand;
  Eigen::Matrix3Xd point;  // measured by the instrument, mm, in its frame (3 x points), in its order
  std::optional<Eigen::VectorXd> time;  // of each point by the instrument's clock, s
  double distance_tolerance_mm = 2;  // by how much machine and nominal machine may differ between two points
};

struct Pairing {
  std::vector<std::optional<std::size_t>> dwell;  // of each point
  std::vector<std::size_t> unused;                // dwells without a point
  /// Clock of the log = offset + (1 + drift) x clock of the instrument; offset and drift have their standard
  /// uncertainties.
  std::optional<double> offset_s, offset_std_s, drift, drift_std;
  std::optional<double> rms_mm;  // of the paired points after the best rigid motion
};

/// Finds the dwell of each point if the trigger is missing or points were lost. pair_points aligns both
/// sequences so that distances between neighbours (which do not depend on the frame) and times agree best.
/// Dwells and points without a partner are skipped; the order is kept. Then pair_points fits one clock and
/// one rigid motion for all pairs; pairs that do not fit are separated again. Throws InputError if neither
/// times nor nominal tool points are given and the numbers of dwells and points differ.
Pairing pair_points(const PairingInput& input);

}  // namespace vernier::importer
