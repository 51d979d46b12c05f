// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <array>
#include <optional>
#include <string>
#include <vector>

namespace vernier::evaluate {

/// Deviations at one target, by approach direction: forward (0) and backward (1). mm or deg.
struct TargetReadings {
  double target = 0;
  std::array<std::vector<double>, 2> deviation;  // actual − target, in the order of the runs
};

/// Results of ISO 230-2 at one target (2014, 3.8 to 3.15). mm or deg; [0] forward, [1] backward.
struct TargetResult {
  double target = 0;
  std::array<std::size_t, 2> count{};
  std::array<double, 2> mean{};           // mean unidirectional deviation
  std::array<double, 2> spread{};         // estimator s of unidirectional repeatability (n − 1)
  std::array<double, 2> repeatability{};  // 4 s
  double mean_both = 0;                   // mean of the two means
  double reversal = 0;                    // B_i: forward mean less backward mean
  double repeatability_both = 0;          // R_i: the largest of 2 s+ + 2 s− + |B_i|, R_i+, R_i−
};

/// Results of ISO 230-2 for the axis (2014, 3.16 to 3.23). Bidirectional values are absent if only one
/// approach direction was measured.
struct PositioningResult {
  std::vector<TargetResult> targets;                                         // in the order of positions
  std::array<std::optional<double>, 2> accuracy, systematic, repeatability;  // A, E, R of one direction
  std::optional<double> accuracy_both, systematic_both, repeatability_both;  // A, E, R
  std::optional<double> reversal, mean_reversal, range;                      // B, mean B, M
};

/// Evaluates readings. A target that was approached in a direction needs at least two readings in this
/// direction. Throws InputError: fewer than two targets, a single reading.
PositioningResult evaluate_positioning(const std::vector<TargetReadings>& readings);

/// Readings of one axis from a measurement file. Deviation = `reading` − position of the axis; for a tracker
/// or interferometer, the reading is the coordinate of the instrument along the axis. A constant between
/// reading and position does not affect any result. The approach direction is the column `dirX`, or without
/// this column the direction of the motion from the previous row. Check rows are included.
struct PositioningFile {
  std::vector<TargetReadings> readings;
  std::string unit;  // of all values: mm or deg
  bool sense_from_order = false;
  std::size_t rows = 0;     // that were used
  std::optional<double> u;  // largest standard uncertainty that a row gives
};
PositioningFile read_positioning(const std::string& text, const std::string& file, const std::string& axis,
                                 const std::string& reading);

}  // namespace vernier::evaluate
