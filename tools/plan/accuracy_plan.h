// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <Eigen/Core>
#include <array>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "tools/fit/fit.h"
#include "tools/model/machine.h"
#include "tools/model/measurement.h"
#include "tools/model/parameters.h"
#include "tools/tolerance/placed_part.h"

namespace vernier::plan {

/// What is known of a machine before the next reading.
struct Knowledge {
  model::Machine machine;
  model::ParameterSet parameters;
  Eigen::MatrixXd covariance;  // of them, convention included
  double reading_mm = 0.005;   // standard deviation of a coordinate that will be read, all that is its own
  double run_mm = 0;           // ... of what all readings of a run share
  bool new_set_up = true;      // the next readings are in a set-up that nothing is known of
  std::array<bool, 3> reads{true, true, true};  // x, y, z
};

/// From measurements at hand: the fit's covariance, the noise that it found. The next readings stand in the
/// set-up of the plain BaseShift where the file has a free one, else in a new one. Throws InputError where
/// the measurement has no x, y or z. tool.
Knowledge knowledge_of(const fit::FitResult& fitted, const model::Measurement& measurement);
/// From the machine file alone, a new set-up. Throws InputError where it was never fitted. tool.
Knowledge knowledge_of(const model::Machine& fitted);

/// Where the machine has to be accurate: a part's features, else where its axes work (`<volume>`), with all
/// tools of the file.
struct AccuracyAim {
  std::string words;  // "the volume"
  std::optional<tolerance::PlacedPart> part;
  std::vector<model::WorkRange> region;  // in place of the volume; an axis that is not named keeps its own
  /// The machine with the one tool that counts, else that of the file and those of <tools>.
  std::optional<model::Machine> tooled;
};

struct AccuracyOptions {
  double accuracy_um = 0;                          // U95 (k = 2) asked for; 0: all of `most`
  std::size_t most = 200;                          // poses
  double feed_mm_min = 5000, turn_deg_min = 3600;  // between poses
  double reading_s = 5;                            // to settle and read
  std::function<void(double)> progress;
};

/// Points and time against what they are expected to bring.
struct AccuracyStep {
  std::size_t points = 0;
  double minutes = 0, u95_um = 0;
};

/// What the uncertainty rests on.
struct AccuracyLimit {
  std::string name;  // of a source, as tools/tolerance names it
  double share = 0;  // of the variance that is left
};

/// What is expected of one characteristic of a part, or of the whole.
struct AccuracyOf {
  std::string name;
  double now_um = 0, after_um = 0;  // U95
};

struct AccuracyPlan {
  model::States states;             // in the order in which they are measured
  double now_um = 0, after_um = 0;  // U95, rms over the aim
  double floor_um = 0;              // what no number of such readings goes below
  double random_um = 0;  // after as many poses drawn evenly over the volume (rms over several draws)
  bool reached = true;
  std::vector<AccuracyStep> steps;
  std::vector<AccuracyLimit> limits;  // of what is left at the end, largest first
  std::vector<AccuracyLimit> unseen;  // of the floor: what such readings cannot tell
  std::vector<AccuracyOf> parts;
};

/// The next poses, one by one, that lower the mean square of the tool point's uncertainty over the aim most,
/// beside a set-up that may be new (I-optimal; Wu, Klimchik, Caro, Furet and Pashkevich 2013 for a test
/// pose), until U95 is what was asked. A rigid motion of the whole (of a part: what its datums take up)
/// counts for nothing. Throws InputError: an axis without range, nothing free. tool.
AccuracyPlan accuracy_plan(const Knowledge& knowledge, const AccuracyAim& aim,
                           const AccuracyOptions& options);

/// U95 over the aim after readings at any poses, um, in the same terms. tool.
double expected_accuracy_um(const Knowledge& knowledge, const AccuracyAim& aim, const model::States& poses);

/// A measurement file with these rows, readings to be filled in.
std::string accuracy_plan_csv(const Knowledge& knowledge, const AccuracyPlan& plan);

/// Label of the planned rows.
inline constexpr const char* kAccuracyRun = "accuracy";

}  // namespace vernier::plan
