// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <string>

#include "tools/diagnose/types.h"
#include "tools/model/machine.h"
#include "tools/model/measurement.h"

namespace vernier::diagnose {

/// Finds the missing physical effect. Fits the model, ranks the catalogue at every location, accepts
/// candidates that pass all tests, and returns one of the five verdicts (FORMATS section 3). Readings that
/// `fit` refuses by name (FitResult::mistake) are not searched: kInstrument, with `end` = `base`. `text`: of
/// the machine file. Check rows are used only for the figures that test the result. The candidates point into
/// options.effects: options.effects must outlive them. Throws InputError.
Diagnosis diagnose(const std::string& text, const model::Machine& given,
                   const model::Measurement& measurement, const DiagnoseOptions& options = {});

}  // namespace vernier::diagnose
