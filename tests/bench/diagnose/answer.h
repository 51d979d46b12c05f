// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "tests/support/hidden_survey.h"

namespace vernier::bench {

/// What became of a diagnosis, judged by the survey's key.
enum class Outcome : std::uint8_t {
  kRight,          // named: the cause; with two hidden effects both; with none: "consistent"
  kWrong,          // something else named with confidence
  kAmbiguous,      // among the first candidates that name each other
  kAmbiguousMiss,  // "ambiguous", and the cause is not among them
  kUnexplained,
  kInstrument,
  kConsistent,
  kCustom,  // a term of the search, labelled as no named physics, on the axis and inputs of the cause
  kHalf,    // of two effects one was named and nothing wrong
  kError,   // no JSON, wrong keys, exit status not 0
};
inline constexpr std::size_t kOutcomes = 10;
const char* outcome_name(Outcome outcome);

struct Judgement {
  Outcome outcome = Outcome::kError;
  std::string said;  // verdict and first candidate, for the list of failures
  std::string add;   // the first candidate's `add`, where something was named
  bool custom = false;
};

/// Judges the JSON of `vernier diagnose --json -`. Keys that the contract demands and that are missing make
/// it an error.
Judgement judge(const support::HiddenSurvey& survey, const std::string& json);

/// Does a candidate name this effect? Effect in the accept list and, where the key has them, axis and input.
bool names(const support::HiddenEffect& hidden, const nlohmann::json& candidate);

}  // namespace vernier::bench
