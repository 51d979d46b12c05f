// SPDX-License-Identifier: GPL-3.0-or-later
// The texts of a diagnosis. They decide nothing.
#pragma once
#include <string>
#include <vector>

#include "tools/diagnose/types.h"
#include "tools/model/machine.h"
#include "tools/residual/structure.h"

namespace vernier::diagnose {

/// Returns the name of a verdict in the JSON result: "missing-effect" ...
const char* verdict_name(Verdict verdict);

/// Returns "Z carriage: lag 0.137 +- 0.007 ms": cause and size for people
/// (tools/effects/spoken.h).
std::string said_of(const CandidateFinding& finding);

/// Describes the tests that the residual fails, in up to three sentences, each after a blank.
std::string where_left(const residual::FailurePicture& left);

/// Describes the residual of the check rows after every step, and the steps that increase the residual. The
/// text is empty without check rows. `accepted`: number of accepted effects.
std::string check_rows_in_words(const std::vector<LadderStep>& steps, std::size_t accepted);

/// Describes the error of all check rows if some of them were left out; else empty. Begins with a blank.
std::string all_check_rows_in_words(const ExcludedRows& left_out);

/// Describes the cause with its coefficients, the next best other cause with the difference of their BIC, and
/// the other steps. next_best: empty if there is no other cause. `steps` begins with the given model.
std::string cause_in_words(const CandidateFinding& cause, const std::string& next_best, double distance,
                           const std::vector<LadderStep>& steps, std::size_t accepted);

/// Returns the sentence about a cyclic error whose period has aliases, with the positions to measure next.
/// `name`: of the effect with its location; period and aliases in mm or deg of the axis.
std::string aliases_in_words(const effects::Candidate& candidate, double period,
                             const std::vector<double>& aliases, const model::Axis& axis);

/// Returns the sentence about effects that are likely parts of one function of position.
std::string pieces_in_words(const std::vector<std::string>& names);

/// Returns "The check rows do not confirm A, B."; empty without names.
std::string not_confirmed_in_words(const std::vector<std::string>& names);

}  // namespace vernier::diagnose
