// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "tools/model/measurement.h"

namespace vernier::fit {

/// How far the readings of a file are from the model, beyond their stated u.
struct FileFactor {
  std::size_t file = 0;  // index in Measurement::files
  std::string name;      // of the file
  double factor = 1;     // factor of u in the fit, at least 1
  std::string sentence() const;
};

/// The residual of a fit of one file.
struct FittedAlone {
  double chi_square = 0, freedom = 0;
};
/// Fits the rows of one file; nullopt: these rows alone have no solution.
using FitOfFile = std::function<std::optional<FittedAlone>(const model::Measurement&)>;

/// Returns the factor of each file: sqrt(chi^2 / degrees of freedom) of a fit of this file alone, at least 1.
/// The model has errors of this size in these readings, whatever the other files say: a file that the model
/// does not describe must not take the weight of a file that it does (variance components: W. Förstner 1979).
/// The factor is 1 if chance explains the residual. Empty if the readings have no u, if there is only one
/// file, if a file alone has no solution, or if the largest factor is less than 3 times the smallest: one
/// factor for all readings is then as good.
std::vector<FileFactor> file_factors(const model::Measurement& rows, const FitOfFile& fit);

/// Returns the measurement with u times the factor of each file.
model::Measurement with_factors(const model::Measurement& rows, const std::vector<FileFactor>& factors);

}  // namespace vernier::fit
