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
  std::size_t most_effects = 5;  // steps of the stepwise model
  std::size_t shown = 8;         // candidates that are fitted and listed
  DiagnoseThresholds thresholds;
  std::function<void(double, const std::string&)> progress = [](double, const std::string&) {};
};

/// The result of one candidate alone, by a full fit.
struct CandidateFinding {
  effects::Candidate candidate;
  std::string add;
  std::optional<std::size_t> axis;  // axis that drives it, else the axis of the transform on which it acts
  std::vector<fit::ParameterEstimate> parameters;  // of an accepted effect: beside all accepted effects
  std::optional<double> rms_after_um, check_rms_before_um, check_rms_after_um;  // of lengths
  std::optional<double> rms_after_urad, check_rms_after_urad;                   // of rotations
  double share = 0, p_value = 1;
  double score = 0;       // decrease of the extended BIC; above 6 is evidence
  bool accepted = false;  // is in the stepwise model
  std::string why_not;    // the test that it fails
  std::vector<std::string> confounded_with;
  std::vector<double>
      aliases;  // other periods that the positions cannot distinguish from its own, longest first
};

/// A cause that the data do not reject.
struct Cause {
  std::optional<effects::Candidate> candidate;  // no value: an error of the instrument
  std::string kind;  // of an error of the instrument: drift, step, set-up, outliers, clock, readings
  std::string description, add;
  std::optional<std::size_t> axis;  // as of CandidateFinding
  std::optional<double> period;     // of a cyclic error, mm or deg of its axis
  double evidence = 0;  // natural logarithm of the likelihood ratio against no cause (half a change of BIC)
};

/// The residual at the end of the stepwise model.
struct Remaining {
  double chi_square_per_freedom = 0;
  bool is_noise = false;
};

/// Rows that the diagnosis left out as outliers, and the error of all check rows beside the stepwise model.
struct ExcludedRows {
  std::size_t rows = 0, check_rows = 0;
  std::optional<double> check_rms_um, check_rms_urad;  // of all check rows, those left out included
};

struct LadderStep {
  std::string effect, add, label;                  // empty: the model as given
  std::string said;                                // "Z carriage: lag"
  std::string text;                                // the machine file, fitted
  std::optional<double> rms_um, check_rms_um;      // of lengths
  std::optional<double> rms_urad, check_rms_urad;  // of rotations
  double chi_square_per_freedom = 0;
  /// True if held-out rows confirm the candidate; the evidence is a likelihood ratio (natural logarithm).
  /// Check rows are used for the confirmation if the step is large enough on them. Without check rows, each
  /// run is held out in turn for the confirmation.
  std::optional<bool> confirmed;
  std::optional<double> evidence;
};

/// Result of a diagnosis. Locations of the candidates refer to base.machine, which may have an additional row
/// (with_base_row).
struct Diagnosis {
  Verdict verdict = Verdict::kConsistent;
  std::string explanation;
  fit::FitResult base;
  std::vector<CandidateFinding> candidates;
  std::vector<LadderStep> ladder;
  std::vector<Cause> causes;  // of the first step: all that the data do not reject, most likely first
  Remaining remaining;
  std::optional<ExcludedRows> left_out;  // no value: every row was used
  std::string instrument;  // kind of the instrument's error (Cause::kind); empty unless it is a cause
  std::vector<std::string> next_measurement;
  std::optional<std::size_t> runner_up;  // index into candidates
  double runner_up_distance = 0;         // difference by which its criterion is worse
  std::string machine_text;              // with all effects of the stepwise model, fitted
  fit::FitResult end;                    // of that machine
  residual::FailurePicture failure;      // where the fitted model fails, before any effect is added
  residual::FailurePicture left;         // and at the end of the stepwise model
  timebase::TimeBaseFinding time_base;   // `found` if the clock is the more likely cause
  std::size_t searched = 0;              // number of tested candidates
  fit::NoiseModel noise;                 // correlation of the errors of the readings
  fit::NoiseUnit noise_unit;             // unit of a weighted reading
};

}  // namespace vernier::diagnose
