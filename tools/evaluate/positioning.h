// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <array>
#include <optional>
#include <string>
#include <vector>

namespace vernier::evaluate {

/// Deviations at one target, separately for the approach directions forward (0) and backward (1), mm or deg.
struct TargetReadings {
  double target = 0;
  std::array<std::vector<double>, 2> deviation;  // actual minus target position, in the order of the runs
};

/// Results of ISO 230-2 at one target (2014, 3.8 to 3.15), mm or deg; [0] is forward, [1] is backward.
struct TargetResult {
  double target = 0;
  std::array<std::size_t, 2> count{};
  std::array<double, 2> mean{};           // mean unidirectional deviation
  std::array<double, 2> spread{};         // estimator s of unidirectional repeatability (n − 1)
  std::array<double, 2> repeatability{};  // 4 s
  double mean_both = 0;                   // mean of the forward mean and the backward mean
  double reversal = 0;                    // reversal B_i: forward mean minus backward mean
  double repeatability_both = 0;          // R_i: the largest value of 2 s+ + 2 s− + |B_i|, R_i+, R_i−
};

/// Results of ISO 230-2 for an axis (2014, 3.16 to 3.23). Bidirectional results have no value if only one
/// approach direction was measured.
struct PositioningResult {
  std::vector<TargetResult> targets;                                         // in the order of their
                                                                             // positions
  std::array<std::optional<double>, 2> accuracy, systematic, repeatability;  // A, E, R for each approach
                                                                             // direction
  std::optional<double> accuracy_both, systematic_both, repeatability_both;  // bidirectional A, E, R
  std::optional<double> reversal, mean_reversal, range;                      // B, mean B, M
};

/// Evaluates the readings of a positioning test by ISO 230-2. If a target was approached in a direction,
/// there must be at least two readings in this direction. Throws InputError if there are fewer than two
/// targets, or only one reading at a target in a direction.
PositioningResult evaluate_positioning(const std::vector<TargetReadings>& readings);

/// Readings of one axis from a measurement file, for the evaluation by ISO 230-2. A deviation is the value of
/// `reading` minus the position of the axis. For a laser tracker or interferometer, the reading is the
/// coordinate along the axis. A constant difference between reading and position does not affect any result.
/// The approach direction comes from the column `dirX`. Without the column `dirX`, the approach direction is
/// the direction of the motion from the previous row. Check rows are evaluated too.
struct PositioningFile {
  std::vector<TargetReadings> readings;
  std::string unit;  // unit of all values: mm or deg
  bool sense_from_order = false;
  std::size_t rows = 0;        // number of rows that were used
  std::size_t undirected = 0;  // number of readings without an approach direction (dirX 0), which are omitted
  std::optional<double> u;     // largest standard uncertainty in the rows
};
PositioningFile read_positioning(const std::string& text, const std::string& file, const std::string& axis,
                                 const std::string& reading);

}  // namespace vernier::evaluate
