// SPDX-License-Identifier: GPL-3.0-or-later
// Options and results of a plan; this file contains only data types.
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
  double confidence = 0.95;               // probability that the chi^2 difference selects the right effect
  std::optional<std::size_t> points;      // exact number of points; nullopt: the smallest number with which
                                          // the confidence is reached
  std::size_t most_points = 60;           // largest number of points of a plan
  std::size_t most_other_hypotheses = 4;  // number of other effects that a diagnosis would consider besides
                                          // the two named effects
  std::size_t offers = 1000;              // number of rows from which the plan is selected
};

/// Difference of the BIC that a diagnosis requires from an alternative before it names a cause.
inline constexpr double kLead = 6;

/// Separation of two effects in one direction: the chi^2 of the best refit of the alternative if `truth` is
/// true, in units of u^2.
struct Separation {
  double now = 0, planned = 0, needed = 0;
};

/// Plan of the next measurement, which distinguishes the effects a and b.
struct Plan {
  FittedHypothesis a, b;
  model::Machine machine;   // machine to which `rows` belong
  model::Measurement rows;  // planned rows in time order, with readings 0; empty if no row helps
  Separation a_true, b_true;
  double lead_of_a = 0;                    // evidence of the existing rows for A: BIC of B minus BIC of A
  bool told_already = false;               // true: lead_of_a or the expected evidence is enough to select one
                                           // of the two effects
  bool separable = false;                  // the planned rows reach the required confidence
  std::vector<std::string> not_settable;   // inputs that an alternative uses and that the user cannot set
  std::vector<std::string> ruled_out;      // other effects that explain the existing rows, but will not
                                           // explain the planned rows
  std::vector<std::string> not_ruled_out;  // other effects that no such plan distinguishes from the two
                                           // effects
  std::string back_to;                     // inputs with the values of the first and of the last planned
                                           // rows: "T_bed 26 degC"; empty: the plan does not return
  std::string sentence;                    // text of the plan for users
  const Separation& worse() const;
};

/// Knowledge about a machine before the next reading.
struct Knowledge {
  model::Machine machine;
  model::ParameterSet parameters;
  Eigen::MatrixXd covariance;  // covariance of the parameters, including the convention
  double reading_mm = 0.005;   // standard deviation of the independent noise of one coordinate in the next
                               // readings
  double run_mm = 0;           // standard deviation of the common error of all readings in a run
  bool new_set_up = true;      // true: the set-up of the next readings is unknown
  std::array<bool, 3> reads{true, true, true};  // the coordinates x, y, z that are read
};

/// Region in which the accuracy is required: the features of a part, or else the working ranges of the axes
/// (`<volume>`). The region of required accuracy is evaluated with all tools of the machine file.
struct AccuracyAim {
  std::string words;  // name of the region for texts: "the volume"
  std::optional<tolerance::PlacedPart> part;
  std::vector<model::WorkRange> region;  // ranges that replace the volume; an axis without an entry keeps its
                                         // range
  /// The machine with the only tool that counts. If it has no value, the default tool and the tools of
  /// <tools> count.
  std::optional<model::Machine> tooled;
};

struct AccuracyOptions {
  double accuracy_um = 0;                          // required U95 (k = 2); 0: the plan has `most` poses
  std::size_t most = 200;                          // largest number of poses
  double feed_mm_min = 5000, turn_deg_min = 3600;  // speeds between the poses
  double reading_s = 5;                            // time to settle and to read at a pose
  std::function<void(double)> progress;
};

/// Expected U95 after a number of points, and the time that these points need.
struct AccuracyStep {
  std::size_t points = 0;
  double minutes = 0, u95_um = 0;
};

/// One source of the remaining uncertainty, with its share.
struct AccuracyLimit {
  std::string name;  // name of the source, as in tools/tolerance
  double share = 0;  // share of the remaining variance
};

/// Expected result for one characteristic of a part, or for all characteristics.
struct AccuracyOf {
  std::string name;
  double now_um = 0, after_um = 0;  // U95 now, and after the planned readings
};

struct AccuracyPlan {
  model::States states;             // poses in the order in which they are measured
  double now_um = 0, after_um = 0;  // U95 now, and after the planned readings, rms over the aim
  double floor_um = 0;              // lower limit of U95 for any number of such readings
  double random_um = 0;  // U95 after the same number of random poses over the volume (rms of several samples)
  bool reached = true;
  std::vector<AccuracyStep> steps;
  std::vector<AccuracyLimit> limits;  // sources of the remaining uncertainty, largest first
  std::vector<AccuracyLimit> unseen;  // sources of the lower limit, which such readings cannot reduce
  std::vector<AccuracyOf> parts;
};

}  // namespace vernier::plan
