// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <functional>
#include <vector>

#include "tools/diagnose/finder.h"
#include "tools/fit/noise/noise.h"
#include "tools/fit/types.h"
#include "tools/model/measurement.h"

namespace vernier::diagnose {

/// Returns the full fit of the machine with items of the pool.
using FitOfItems = std::function<fit::FitResult(const std::vector<std::size_t>&)>;

/// The fits that the decision compares.
struct DecisionFits {
  const fit::FitResult& without;   // any effect
  const fit::FitResult& accepted;  // the accepted set
  FitOfItems of;
};

/// True if another fit leaves less of the fit rows, and predicts the check rows better too. Between two
/// responses of found terms the number of terms is then no evidence: the search of the terms chose it.
/// accepted, other: residuals (measured - model) of all observations; noise: correlation of the readings'
/// errors. False without check rows.
bool fits_and_predicts_better(const model::Measurement& rows, const Eigen::VectorXd& accepted,
                              const Eigen::VectorXd& other, const fit::NoiseModel& noise);

/// Returns the alternatives to the first accepted item with the distances of their full fits: each fit has
/// the alternative in place of the first item. The search uses a linear estimate of the distances; the
/// distances of the full fits replace the estimate. Three kinds of alternatives have the distance of the
/// estimate: alternatives beyond `distance_of_fits`, alternatives after the first `most`, and alternatives
/// whose fit does not converge. A form with more unknowns is not an alternative if its fit predicts the same
/// readings as the accepted form. A response of another structure (`thermal-response`) is fitted at any
/// distance; its distance is at most 0 if it fits and predicts better. accepted: items, not empty. A negative
/// distance means that the fit prefers the alternative. Cost: one fit for each alternative.
Alternatives alternatives_by_fits(const Finder& finder, const std::vector<std::size_t>& accepted,
                                  std::size_t most, const DecisionFits& fits);

}  // namespace vernier::diagnose
