// SPDX-License-Identifier: GPL-3.0-or-later
// Input and result of a plan: values, no algorithm.
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
#include "tools/plan/hypothesis.h"
#include "tools/tolerance/placed_part.h"

namespace vernier::plan {

struct PlanOptions {
  double confidence = 0.95;               // that the chi^2 difference names the right one
  std::optional<std::size_t> points;      // exact number; nullopt: as few as the confidence needs
  std::size_t most_points = 60;           // more are no plan
  std::size_t most_other_hypotheses = 4;  // other effects that a diagnosis would weigh beside the two
  std::size_t offers = 1000;              // rows to choose from
};

/// Separation in one direction: the chi^2 of the best refit of the alternative while `truth` is true, in
/// units of u^2.
struct Separation {
  double now = 0, planned = 0, needed = 0;
};

/// The next measurement.
struct Plan {
  FittedHypothesis a, b;
  model::Machine machine;   // that `rows` is bound to
  model::Measurement rows;  // planned rows in time order, readings 0; empty: no row helps
  Separation a_true, b_true;
  double lead_of_a = 0;                    // by how much B explains the rows so far worse than A (BIC)
  bool told_already = false;               // that, or the expected evidence, is enough to name one of them
  bool separable = false;                  // the planned rows reach the required confidence
  std::vector<std::string> not_settable;   // inputs that an alternative uses and that cannot be set
  std::vector<std::string> ruled_out;      // other effects that explain the rows so far, and will no more
  std::vector<std::string> not_ruled_out;  // ... and that no such plan distinguishes from the two
  std::string sentence;                    // for people
  const Separation& worse() const;
};

/// Knowledge of a machine before the next reading.
struct Knowledge {
  model::Machine machine;
  model::ParameterSet parameters;
  Eigen::MatrixXd covariance;  // of them, convention included
  double reading_mm = 0.005;   // standard deviation of a coordinate that will be read, independent noise only
  double run_mm = 0;           // ... of what all readings of a run share
  bool new_set_up = true;      // the next readings are in an unknown set-up
  std::array<bool, 3> reads{true, true, true};  // x, y, z
};

/// Region of the required accuracy: the features of a part, else the working ranges of the axes (`<volume>`),
/// with all tools of the file.
struct AccuracyAim {
  std::string words;  // "the volume"
  std::optional<tolerance::PlacedPart> part;
  std::vector<model::WorkRange> region;  // in place of the volume; an axis that is not named keeps its range
  /// The machine with the one tool that counts; without a value, the tool of the file and those of <tools>
  /// count.
  std::optional<model::Machine> tooled;
};

struct AccuracyOptions {
  double accuracy_um = 0;                          // U95 (k = 2) asked for; 0: all of `most`
  std::size_t most = 200;                          // poses
  double feed_mm_min = 5000, turn_deg_min = 3600;  // between poses
  double reading_s = 5;                            // to settle and read
  std::function<void(double)> progress;
};

/// Number of points and time, with the expected result.
struct AccuracyStep {
  std::size_t points = 0;
  double minutes = 0, u95_um = 0;
};

/// Basis of the uncertainty.
struct AccuracyLimit {
  std::string name;  // of a source, as tools/tolerance names it
  double share = 0;  // of the variance that is left
};

/// Expected result for one characteristic of a part, or for all characteristics.
struct AccuracyOf {
  std::string name;
  double now_um = 0, after_um = 0;  // U95
};

struct AccuracyPlan {
  model::States states;             // in the order in which they are measured
  double now_um = 0, after_um = 0;  // U95, rms over the aim
  double floor_um = 0;              // lower limit for any number of such readings
  double random_um = 0;  // after as many poses drawn evenly over the volume (rms over several draws)
  bool reached = true;
  std::vector<AccuracyStep> steps;
  std::vector<AccuracyLimit> limits;  // of the remaining uncertainty, largest first
  std::vector<AccuracyLimit> unseen;  // of the floor: sources that such readings cannot reduce
  std::vector<AccuracyOf> parts;
};

}  // namespace vernier::plan
