// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <cstddef>
#include <optional>
#include <string>

#include "tools/diagnose/diagnosis.h"
#include "tools/model/machine.h"
#include "tools/model/measurement.h"

namespace vernier::commands {

/// Returns the number of steps that no other cause explains. If the verdict is ambiguous because of other
/// periods of a later step, the steps before it are certain. The same applies to a later step whose shape
/// is not confirmed.
std::size_t certain_steps(const diagnose::Diagnosis& d);

/// Returns a later step of an ambiguous diagnosis that is certain whichever of the open causes is true: the
/// diagnosis of the machine with each of these causes has this step too. The step has the text and the errors
/// of the fitted machine with this step alone. Returns nullopt if there is no such step, or if a cause is an
/// error of the instrument or one of more than kMostOpenCauses. `text`, `machine`, `rows`: what `d`
/// diagnosed, with the same options. Computing time: one diagnosis for each open cause.
std::optional<diagnose::LadderStep> step_beside_open(const diagnose::Diagnosis& d, const std::string& text,
                                                     const model::Machine& machine,
                                                     const model::Measurement& rows,
                                                     const diagnose::DiagnoseOptions& options);

/// Returns a sentence with the command that adds the most likely of the open causes to the machine file
/// `file`; an empty text if no cause can be added. A period that the readings do not determine is the word
/// PERIOD in the command, with the periods that explain the readings equally well.
std::string choice_of_cause(const diagnose::Diagnosis& d, const std::string& file);

}  // namespace vernier::commands
