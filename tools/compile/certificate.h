// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <string>

#include "tools/compile/types.h"
#include "tools/model/machine.h"

namespace vernier::compile {

/// Returns the fixed-point program as a script for the proof tool Gappa (https://gappa.gitlabpages.inria.fr).
/// Gappa then proves the error of each output without this compiler. The script contains every sum and
/// product with its exact rounding, and for each output one inequality that Gappa must prove. The hypotheses
/// of the script are: the declared ranges; the error of each channel's format; the error and the slope of
/// each table and function. The script does not contain the neglected terms of the error equation, the second
/// order of the correction, and the conversion of an output to counts.
std::string print_certificate(const model::Machine& machine, const CompiledMachine& compiled);

}  // namespace vernier::compile
