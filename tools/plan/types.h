// SPDX-License-Identifier: GPL-3.0-or-later
// What a plan is asked for and what it holds: values, no algorithm.
#pragma once
#include <Eigen/Core>
#include <array>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "tools/model/machine.h"
#include "tools/model/measurement.h"
#include "tools/model/parameters.h"
#include "tools/plan/rival.h"
#include "tools/tolerance/placed_part.h"

namespace vernier::plan {

struct PlanOptions {
  double confidence = 0.95;  // probability that the chi^2 difference selects the right one
  std::optional<std::size_t>
      points;                    // exact number of points; no value: the smallest number for the confidence
  std::size_t most_points = 60;  // upper limit of a plan
  std::size_t most_bystanders = 4;  // other effects that a diagnosis would compare with the two
  std::size_t offers = 1000;        // rows to choose from
};

/// One direction: the distance of the best refit of the alternative while `truth` is true, in units of u^2.
struct Separation {
  double now = 0, planned = 0, needed = 0;
};

/// The next measurement.
struct Plan {
  FittedRival a, b;
  model::Machine machine;   // the machine of `rows`
  model::Measurement rows;  // planned rows in time order, readings 0; empty: no row helps
  Separation a_true, b_true;
  double lead_of_a = 0;  // difference by which B explains the present rows worse than A (BIC)
  bool told_already =
      false;  // that difference, or the difference that they could show, is sufficient to name one of them
  bool separable = false;                 // the planned rows reach the confidence
  std::vector<std::string> not_settable;  // inputs that an alternative uses and that cannot be set
  std::vector<std::string>
      ruled_out;  // other effects that explain the present rows, but not the planned rows
  std::vector<std::string> not_ruled_out;  // ... and effects that no such plan distinguishes from the two
  std::string sentence;                    // for people
  const Separation& worse() const;
};

/// Information about a machine before the next reading.
struct Knowledge {
  model::Machine machine;
  model::ParameterSet parameters;
  Eigen::MatrixXd covariance;  // of them, including the convention
  double reading_mm =
      0.005;          // standard deviation of a coordinate of the planned readings, independent noise only
  double run_mm = 0;  // ... and of the noise that all readings of a run share
  bool new_set_up = true;                       // the next readings are in an unknown set-up
  std::array<bool, 3> reads{true, true, true};  // x, y, z
};

/// Region in which the machine must be accurate: a part's features, else the working range of its
/// axes (`<volume>`), with all tools of the file.
struct AccuracyAim {
  std::string words;  // "the volume"
  std::optional<tolerance::PlacedPart> part;
  std::vector<model::WorkRange> region;  // instead of the volume; an axis that is not named keeps its range
  /// The machine with the one relevant tool, else with that of the file and those of <tools>.
  std::optional<model::Machine> tooled;
};

struct AccuracyOptions {
  double accuracy_um = 0;                          // requested U95 (k = 2); 0: use all of `most`
  std::size_t most = 200;                          // poses
  double feed_mm_min = 5000, turn_deg_min = 3600;  // between poses
  double reading_s = 5;                            // to come to rest and read
  std::function<void(double)> progress;
};

/// Number of points and time, with the expected result.
struct AccuracyStep {
  std::size_t points = 0;
  double minutes = 0, u95_um = 0;
};

/// Source of the remaining uncertainty.
struct AccuracyLimit {
  std::string name;  // of a source, as tools/tolerance names it
  double share = 0;  // of the remaining variance
};

/// Expected accuracy of one characteristic of a part, or of the whole.
struct AccuracyOf {
  std::string name;
  double now_um = 0, after_um = 0;  // U95
};

struct AccuracyPlan {
  model::States states;             // in the order in which they are measured
  double now_um = 0, after_um = 0;  // U95, rms over the aim
  double floor_um = 0;              // lower limit for any number of such readings
  double random_um = 0;  // after the same number of random poses in the volume (rms over several samples)
  bool reached = true;
  std::vector<AccuracyStep> steps;
  std::vector<AccuracyLimit> limits;  // of the remaining uncertainty, largest first
  std::vector<AccuracyLimit> unseen;  // of the floor: sources that such readings cannot reduce
  std::vector<AccuracyOf> parts;
};

}  // namespace vernier::plan
