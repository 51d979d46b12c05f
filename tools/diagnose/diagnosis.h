// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <string>

#include "tools/diagnose/types.h"
#include "tools/model/machine.h"
#include "tools/model/measurement.h"

namespace vernier::diagnose {

/// Finds the physical effect that is missing in the machine's error model. diagnose() fits the model, ranks
/// the catalogue of effects at every location, accepts candidates that pass all tests, and returns one of the
/// five verdicts (FORMATS section 3). If `fit` reports a mistake in the readings (FitResult::mistake), there
/// is no search. The verdict is then kInstrument, and `end` equals `base`. `text`: the text of the machine
/// file. Check rows are used only for the figures that test the result. The candidates of the result contain
/// pointers into options.effects. Therefore options.effects must exist longer than the result. Throws
/// InputError for invalid input.
Diagnosis diagnose(const std::string& text, const model::Machine& given,
                   const model::Measurement& measurement, const DiagnoseOptions& options = {});

}  // namespace vernier::diagnose
