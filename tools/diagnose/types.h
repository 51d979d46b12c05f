// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "tools/diagnose/propose/thresholds.h"
#include "tools/effects/candidate.h"
#include "tools/fit/fit.h"
#include "tools/fit/noise/noise.h"
#include "tools/model/machine.h"
#include "tools/model/measurement.h"
#include "tools/residual/structure.h"
#include "tools/timebase/time_base.h"

namespace vernier::diagnose {

enum class Verdict : std::uint8_t { kMissingEffect, kAmbiguous, kUnexplained, kInstrument, kConsistent };

struct DiagnoseOptions {
  std::vector<effects::Effect> effects = effects::built_in_effects();
  std::size_t most_effects = 5;  // largest number of steps of the stepwise model
  std::size_t shown = 8;         // number of candidates that are fitted and listed
  DiagnoseThresholds thresholds;
  std::function<void(double, const std::string&)> progress = [](double, const std::string&) {};
};

/// Result of a full fit with one candidate alone.
struct CandidateFinding {
  effects::Candidate candidate;
  std::string add;
  std::optional<std::size_t> axis;  // axis that drives the candidate; if there is no such axis, the axis of
                                    // the transform on which the candidate acts
  std::vector<fit::ParameterEstimate> parameters;  // parameters of the candidate; for an accepted effect,
                                                   // fitted together with all accepted effects
  std::optional<double> rms_after_um, check_rms_before_um, check_rms_after_um;  // rms residual of length
                                                                                // readings, um
  std::optional<double> rms_after_urad, check_rms_after_urad;                   // rms residual of rotation
                                                                                // readings, urad
  double share = 0, p_value = 1;
  double score = 0;       // decrease of the extended BIC; above 6 is evidence
  bool accepted = false;  // true: the candidate is in the stepwise model
  std::string why_not;    // name of the acceptance test that the candidate fails
  std::vector<std::string> confounded_with;
  std::vector<double> aliases;  // other periods that the positions cannot distinguish from the candidate's
                                // period, longest first
};

/// A possible cause of the residual, which the data do not reject.
struct Cause {
  std::optional<effects::Candidate> candidate;  // no value: the cause is an error of the instrument
  std::string kind;  // kind of an instrument error: drift, step, set-up, outliers, clock, readings
  std::string description, add;
  std::optional<std::size_t> axis;  // axis with the meaning of CandidateFinding::axis
  std::optional<double> period;     // period of a cyclic error, mm or deg of its axis
  double evidence = 0;  // natural logarithm of the likelihood ratio of this cause against no cause (half the
                        // change of the BIC)
};

/// The remaining residual at the end of the stepwise model.
struct Remaining {
  double chi_square_per_freedom = 0;
  bool is_noise = false;
};

/// Number of rows that the diagnosis excluded as outliers, and the rms error of all check rows with the
/// stepwise model.
struct ExcludedRows {
  std::size_t rows = 0, check_rows = 0;
  std::optional<double> check_rms_um, check_rms_urad;  // rms error of all check rows, including the excluded
                                                       // rows
};

/// Check rows of one measurement file beside a model.
struct CheckOfFile {
  std::string file;
  double rms = 0;  // rms of residual / u
};

struct LadderStep {
  std::string effect, add, label;                  // effect of this step; empty for the model as given
  std::string said;                                // description of the effect for people: "Z carriage: lag"
  std::string text;                                // text of the fitted machine file
  std::optional<double> rms_um, check_rms_um;      // rms residual of length readings
  std::optional<double> rms_urad, check_rms_urad;  // rms residual of rotation readings
  std::vector<CheckOfFile> check_files;            // empty if fewer than two files have check rows with u
  double chi_square_per_freedom = 0;
  /// True if held-out rows confirm the effect of this step. The evidence is the natural logarithm of a
  /// likelihood ratio. The check rows are used for this confirmation if the effect changes them enough. If
  /// there are no check rows, or if their evidence is too small, each run is held out in turn for the
  /// confirmation.
  std::optional<bool> confirmed;
  std::optional<double> evidence;
  bool of_check_rows =
      false;  // true: the evidence is that of the check rows; false: of runs held out in turn
  /// False if no cause is named, or if a step after the first has several possible causes. Also false if a
  /// named effect stands beside effects that cannot be what their names state, and this step is one of them
  /// or may be a part of the same error. The command improve does not add such a step.
  bool certain = true;
  /// Possible causes of this step, most likely first, if the data do not reject a second one. Empty for the
  /// first effect: its causes are Diagnosis::causes.
  std::vector<Cause> causes;
};

/// Result of a diagnosis of a machine. The locations of the candidates refer to base.machine, which may have
/// one additional row (with_base_row).
struct Diagnosis {
  Verdict verdict = Verdict::kConsistent;
  std::string explanation;
  fit::FitResult base;
  std::vector<CandidateFinding> candidates;
  std::vector<LadderStep> ladder;
  std::vector<Cause> causes;  // possible causes of the first step that the data do not reject, most likely
                              // first
  Remaining remaining;
  std::optional<ExcludedRows> left_out;  // no value: the diagnosis used every row
  std::string instrument;  // kind of the instrument's error (Cause::kind); empty if the instrument is not a
                           // cause
  std::vector<std::string> next_measurement;
  std::optional<std::size_t> runner_up;  // index of the second best cause in `candidates`
  double runner_up_distance = 0;         // BIC of the second best cause minus BIC of the best cause
  std::string machine_text;              // text of the machine file with all effects of the stepwise model,
                                         // fitted
  fit::FitResult end;                    // fit of the machine in `machine_text`
  residual::FailurePicture failure;      // description of where the fitted model fails, before any effect is
                                         // added
  residual::FailurePicture left;         // description of where the model fails at the end of the stepwise
                                         // model
  timebase::TimeBaseFinding time_base;   // `found` is true if a time base error of the instrument is the more
                                         // likely cause
  std::size_t searched = 0;              // number of tested candidates
  fit::NoiseModel noise;                 // correlation of the errors of the readings
  fit::NoiseUnit noise_unit;             // unit of a weighted reading (residual / u)
};

}  // namespace vernier::diagnose
