// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <string>
#include <vector>

#include "tools/model/machine.h"

namespace vernier::commands {

/// A fit that measures the squareness of Y to X and the scales of X and Y with the distances of a printed
/// square: `hold` and `free` of `fit`. Both are empty if the last fit determined all other parameters.
struct FitOfSquare {
  std::vector<std::string> hold, free;
};

/// Returns the fit for a fitted machine. The distances determine a few numbers: each table without an entry
/// that the readings determined can stand for these numbers (yaw of Y: the squareness), so it is held too.
FitOfSquare fit_of_square(const model::Machine& machine);

/// Returns how to measure squareness and scales that the last fit did not measure; empty if nothing is held.
std::string remedy_of_unmeasured(const FitOfSquare& fit);

/// True if the last fit has a squareness about Z that its readings do not determine.
bool square_is_open(const model::Machine& machine);

}  // namespace vernier::commands
