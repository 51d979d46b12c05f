// SPDX-License-Identifier: GPL-3.0-or-later
// Functions that write the texts of a diagnosis. The functions of this header only write text and make no
// decision.
#pragma once
#include <string>
#include <vector>

#include "tools/diagnose/types.h"
#include "tools/model/machine.h"
#include "tools/residual/structure.h"

namespace vernier::diagnose {

/// Returns the sentence about an effect of one axis, `own`, and the same effect of other axes that give the
/// same readings.
std::string difference_in_words(const std::string& own, const std::vector<std::string>& others);

/// Returns the name of a verdict in the JSON result: "missing-effect" ...
const char* verdict_name(Verdict verdict);

/// Returns the name and size of a cause as text for people, for example "Z carriage: lag 0.137 +- 0.007 ms"
/// (tools/effects/spoken.h).
std::string said_of(const CandidateFinding& finding);

/// Describes the statistical tests that the residual fails, in up to three sentences. Each sentence begins
/// with a blank.
std::string where_left(const residual::FailurePicture& left);

/// Describes the residual of the check rows after every step of the stepwise model, and names the steps that
/// increase this residual. The text is empty if there are no check rows. `accepted`: number of accepted
/// effects.
std::string check_rows_in_words(const std::vector<LadderStep>& steps, std::size_t accepted);

/// Describes the error of all check rows if some check rows were excluded as outliers; otherwise the text is
/// empty. The text begins with a blank.
std::string all_check_rows_in_words(const ExcludedRows& left_out);

/// Describes a cause with its coefficients, the next best other cause with the difference of the two BIC
/// values, and the other steps of the stepwise model. `next_best`: name of the next best cause; empty if
/// there is no other cause. The first element of `steps` is the given model.
std::string cause_in_words(const CandidateFinding& cause, const std::string& next_best, double distance,
                           const std::vector<LadderStep>& steps, std::size_t accepted);

/// Returns the sentence about a cyclic error whose period has aliases, with the positions to measure next.
/// `candidate`: the cyclic error with its location; `period`, `aliases`: in mm or deg of the axis.
std::string aliases_in_words(const effects::Candidate& candidate, double period,
                             const std::vector<double>& aliases, const model::Axis& axis);

/// Returns the sentence about one step of the machine that explains the readings as well as the named effect
/// of an input.
std::string one_step_in_words();

/// Returns the sentence about what to measure to distinguish an effect of an input from a change of the
/// machine.
std::string go_back_in_words();

/// Returns the sentence about an instrument that drifts as the named effect does.
std::string drift_of_instrument_in_words();

/// Returns a sentence with the residual of the machine file (the set-up fitted) and the residual after a fit
/// of its parameters, if the fit reduces the residual by much: the diagnosis searches after this fit. Empty
/// if the fit does not.
std::string fit_reduces_in_words(const fit::FitResult& base);

/// Returns the sentence about a residual (rms) that is mostly left beside the named effects and that no
/// stated noise explains.
std::string most_remains_in_words(double before_um, double after_um);

/// Returns the sentence about an offset of the tool point that can be the place of a reflector on the tool,
/// with the command that declares this place.
std::string reflector_in_words(const std::string& machine_file);

/// Returns the sentence about effects that are likely parts of one function of position.
std::string pieces_in_words(const std::vector<std::string>& names);

/// Returns the sentence about effects that are likely parts of the response to a source of heat that no
/// thermometer records.
std::string unrecorded_heat_in_words(const std::vector<std::string>& names);

/// Returns the sentences about the later steps that have several possible causes; empty if there are none.
std::string open_steps_in_words(const std::vector<LadderStep>& steps);

/// Returns the sentence "The check rows do not confirm A, B." with the given names; empty if there are no
/// names.
std::string not_confirmed_in_words(const std::vector<std::string>& names);

}  // namespace vernier::diagnose
