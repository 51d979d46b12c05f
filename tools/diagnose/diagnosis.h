// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "tools/diagnose/thresholds.h"
#include "tools/effects/candidate.h"
#include "tools/fit/fit.h"
#include "tools/fit/noise.h"
#include "tools/model/machine.h"
#include "tools/model/measurement.h"
#include "tools/residual/structure.h"
#include "tools/timebase/time_base.h"

namespace vernier::diagnose {

enum class Verdict : std::uint8_t { kMissingEffect, kAmbiguous, kUnexplained, kInstrument, kConsistent };
/// As the JSON result writes it: "missing-effect" ...
const char* verdict_name(Verdict verdict);

struct DiagnoseOptions {
  std::vector<effects::Effect> effects = effects::built_in_effects();
  std::size_t most_effects = 5;  // steps of the ladder
  std::size_t shown = 8;         // candidates that are fitted and listed
  DiagnoseThresholds thresholds;
  std::function<void(double, const std::string&)> progress = [](double, const std::string&) {};
};

/// What one candidate would do alone, fitted in earnest.
struct CandidateFinding {
  effects::Candidate candidate;
  std::string add;
  std::optional<std::size_t> axis;  // that drives it, else that of the receiving transform
  std::vector<fit::ParameterEstimate> parameters;
  std::optional<double> rms_after_um, check_rms_before_um, check_rms_after_um;
  double share = 0, p_value = 1;
  double score = 0;       // decrease of the extended BIC; above 6 is evidence
  bool accepted = false;  // stands in the ladder
  std::string why_not;    // the test that it fails
  std::vector<std::string> confounded_with;
  std::vector<double> aliases;  // other periods that the positions do not tell from its own, longest first
};

/// "Z carriage: lag 0.137 +- 0.007 ms": what it is and how much, for people (tools/effects/spoken.h).
std::string said_of(const CandidateFinding& finding);

struct LadderStep {
  std::string effect, add, label;                  // empty: the model as given
  std::string said;                                // "Z carriage: lag"
  std::string text;                                // the machine file, fitted
  std::optional<double> rms_um, check_rms_um;      // of lengths
  std::optional<double> rms_urad, check_rms_urad;  // of rotations
  double chi_square_per_freedom = 0;
  /// Do rows that neither fit nor selection saw bear it out, and by what likelihood ratio (natural
  /// logarithm): the check rows, where the step is large enough there to tell, else runs left out in turn.
  std::optional<bool> confirmed;
  std::optional<double> evidence;
};

/// Places of the candidates are those of base.machine, which may hold a stand-in row (with_base_row).
struct Diagnosis {
  Verdict verdict = Verdict::kConsistent;
  std::string explanation;
  fit::FitResult base;
  std::vector<CandidateFinding> candidates;
  std::vector<LadderStep> ladder;
  std::vector<std::string> next_measurement;
  std::optional<std::size_t> runner_up;  // index into candidates
  double runner_up_distance = 0;         // by how much its criterion is worse
  std::string machine_text;              // with all effects of the ladder, fitted
  fit::FitResult end;                    // of that machine
  residual::FailurePicture failure;      // where the fitted model fails, before anything is added
  residual::FailurePicture left;         // and at the end of the ladder
  timebase::TimeBaseFinding time_base;   // `found` where the clock is the likelier cause
  std::size_t searched = 0;              // candidates looked at
  fit::NoiseModel noise;                 // how the errors of the readings are correlated
  fit::NoiseUnit noise_unit;             // what 1 of it stands for
};

/// Which physical effect is missing? Fits the model, ranks the catalogue at every place, accepts what passes
/// all tests, and says which of the five answers the data give (FORMATS section 3). Readings that `fit`
/// refuses by name (FitResult::mistake) are searched for nothing: kInstrument, with `end` = `base`. `text`:
/// of the machine file. Check rows enter nothing but the figures that judge. The candidates point into
/// options.effects, which must outlive them. Throws InputError. tool.
Diagnosis diagnose(const std::string& text, const model::Machine& given,
                   const model::Measurement& measurement, const DiagnoseOptions& options = {});

}  // namespace vernier::diagnose
