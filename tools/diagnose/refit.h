// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <functional>
#include <vector>

#include "tools/diagnose/finder.h"
#include "tools/fit/noise/noise.h"
#include "tools/fit/types.h"
#include "tools/model/measurement.h"

namespace vernier::diagnose {

/// Function that fits the machine with the given candidates of the pool (their indices) and returns the
/// result of this full fit.
using FitOfItems = std::function<fit::FitResult(const std::vector<std::size_t>&)>;

/// The fits that are compared when a cause is selected.
struct DecisionFits {
  const fit::FitResult& without;   // fit without any effect
  const fit::FitResult& accepted;  // fit with the accepted set of effects
  FitOfItems of;
};

/// True if another fit has a smaller residual on the fit rows and also predicts the check rows better. If
/// both effects are thermal responses with found terms, their numbers of terms are no evidence, because the
/// search selected the terms. `accepted`, `other`: residuals (measured - model) of all observations with the
/// two fits; `noise`: correlation of the errors of the readings. The function fits_and_predicts_better()
/// returns false if there are no check rows.
bool fits_and_predicts_better(const model::Measurement& rows, const Eigen::VectorXd& accepted,
                              const Eigen::VectorXd& other, const fit::NoiseModel& noise);

/// Returns the alternatives to one accepted effect, with their distances in BIC from full fits. Each fit has
/// the alternative in place of this effect. The search estimates the distances linearly; the
/// distances of the full fits replace these estimates. Three kinds of alternatives have the distance of the
/// estimate: alternatives beyond `distance_of_fits`, alternatives after the first `most`, and alternatives
/// whose fit does not converge. A form of an effect with more unknowns, and a rare effect, are not
/// alternatives if the fit predicts the same readings as the accepted effect: then only its frequency
/// decides. A thermal response of another structure
/// (`thermal-response`) is fitted at any distance. If a thermal response fits and predicts better than the
/// accepted response, its distance (difference in BIC) is at most 0. `accepted`: indices of the accepted
/// effects; `position`: position of the effect in this list. A negative distance means that the fit prefers
/// the alternative. Computing time: one fit for each alternative.
Alternatives alternatives_by_fits(const Finder& finder, const std::vector<std::size_t>& accepted,
                                  std::size_t position, std::size_t most, const DecisionFits& fits);

/// Returns the alternatives to the accepted effect `position` that the data do not reject: their distance in
/// BIC is below `distance`. An alternative to the first effect is none to a later one: it would be counted
/// twice. `alternatives`: alternatives to each accepted effect, in the order of the stepwise model.
std::vector<std::size_t> not_rejected(const std::vector<Alternatives>& alternatives, std::size_t position,
                                      double distance);

}  // namespace vernier::diagnose
