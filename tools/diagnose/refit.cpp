// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/diagnose/refit.h"

#include <algorithm>

#include "tools/diagnose/proof.h"
#include "tools/fit/least_squares/statistics.h"

namespace vernier::diagnose {
namespace {

/// Share of the accepted set's part of the fit rows in which another fit differs from it.
double share_apart(const model::Measurement& rows, const DecisionFits& fits, const fit::FitResult& other) {
  const Eigen::VectorXd weights = fit::fit_weights(rows);
  if (other.residual.size() != weights.size() || fits.accepted.residual.size() != weights.size()) return 1;
  const double part = weights.cwiseProduct(fits.without.residual - fits.accepted.residual).squaredNorm();
  const double apart = weights.cwiseProduct(other.residual - fits.accepted.residual).squaredNorm();
  return part > 0 ? apart / part : 1;
}

/// Are both the responses of structures, with terms that a search found?
bool are_responses(const Finder& finder, std::size_t a, std::size_t b) {
  const auto found = [&](std::size_t item) {
    return finder.pool().candidate(item).choice.effect->has_found_terms();
  };
  return found(a) && found(b);
}

}  // namespace

bool fits_and_predicts_better(const model::Measurement& rows, const Eigen::VectorXd& accepted,
                              const Eigen::VectorXd& other, const fit::NoiseModel& noise) {
  const Eigen::VectorXd weights = fit::fit_weights(rows);
  if (accepted.size() != weights.size() || other.size() != weights.size()) return false;
  if (weights.cwiseProduct(other).squaredNorm() >= weights.cwiseProduct(accepted).squaredNorm()) return false;
  return proof_on_check_rows(rows, accepted, other, noise, 1).evidence > 0;
}

Alternatives alternatives_by_fits(const Finder& finder, const std::vector<std::size_t>& accepted,
                                  std::size_t position, std::size_t most, const DecisionFits& fits) {
  const std::size_t effect = accepted[position];
  Alternatives found = finder.alternatives_to(effect);
  if (!(fits.accepted.chi_square > 0)) return found;
  const DiagnoseThresholds& limits = finder.evidence().thresholds();
  const double own = finder.criterion_of_fit(accepted, 1);
  std::vector<std::size_t> set = accepted;
  std::size_t fitted = 0;
  std::erase_if(found.other, [&](Alternative& one) {
    const bool response = are_responses(finder, one.item, effect);
    if ((!response && one.distance >= limits.acceptance.distance_of_fits) || fitted++ >= most) return false;
    set[position] = one.item;
    const fit::FitResult fit = fits.of(set);
    if (!fit.converged) return false;
    const bool less_likely =
        finder.pool().is_richer(one.item, effect) || finder.pool().is_rarer(one.item, effect);
    if (!response && less_likely &&
        share_apart(finder.evidence().measurement(), fits, fit) < limits.pool.held_share)
      return true;
    one.distance = finder.criterion_of_fit(set, fit.chi_square / fits.accepted.chi_square) - own;
    if (response && fits_and_predicts_better(finder.evidence().measurement(), fits.accepted.residual,
                                             fit.residual, finder.evidence().noise_of_file()))
      one.distance = std::min(one.distance, 0.0);
    return false;
  });
  std::stable_sort(found.other.begin(), found.other.end(),
                   [](const Alternative& a, const Alternative& b) { return a.distance < b.distance; });
  return found;
}

std::vector<std::size_t> not_rejected(const std::vector<Alternatives>& alternatives, std::size_t position,
                                      double distance) {
  std::vector<std::size_t> items = alternatives[position].within(distance);
  if (position == 0) return items;
  const std::vector<std::size_t> of_first = alternatives.front().within(distance);
  std::erase_if(items, [&](std::size_t item) {
    return std::find(of_first.begin(), of_first.end(), item) != of_first.end();
  });
  return items;
}

}  // namespace vernier::diagnose
