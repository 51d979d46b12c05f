// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <Eigen/Core>
#include <cstddef>
#include <vector>

#include "tools/diagnose/propose/thresholds.h"

namespace vernier::diagnose {

/// Difference of two criteria (units of chi^2) that is rounding and no evidence. Of two descriptions of one
/// effect, the one that comes first in the list stays.
inline constexpr double kSameCriterion = 1e-3;

/// A group of columns (the terms of one candidate) that enter a model together.
struct SelectionEntry {
  Eigen::Index first = 0, count = 1;
  double penalty = 0;       // penalty for the search: twice the logarithm of the number of tested candidates
  std::size_t scanned = 0;  // number of unknowns that were found by scanning, in addition to the coefficients
  std::size_t cause = 0;    // at most one entry of each cause is selected
};

/// Selects the groups of columns that explain a residual. The columns and the residual of the problem are
/// both projected on the orthogonal complement of the model's free parameters.
struct SelectionProblem {
  Eigen::MatrixXd gram;     // columns^T columns
  Eigen::VectorXd moment;   // columns^T residual
  double chi_square = 0;    // residual^T residual; in units of the uncertainty if the uncertainty is known
  double observations = 0;  // number of observations, for the penalty of a coefficient (BIC)
  double freedom = 0;       // observations - rank of the model
  bool noise_known = false;
  double least_pivot = kLeastPivot;  // smallest share of its square that a column must keep
                                     // after projection on the complement of the other
                                     // columns
  std::vector<SelectionEntry> entries;
};

struct Selection {
  std::vector<std::size_t> chosen;  // selected entries, in the order in which they lower the BIC most
  double criterion = 0;
  double chi_square = 0;
};

/// Builds a selection problem from a residual and columns of unit length. A column of zeros is never
/// selected. The caller fills the member `entries` of the selection problem.
SelectionProblem selection_problem(const Eigen::MatrixXd& columns, const Eigen::VectorXd& residual);

/// Returns the extended BIC of a set of entries (Schwarz 1978; Chen and Chen 2008). The likelihood uses the
/// noise that fits best, but never noise below the given uncertainty. The BIC of a set is infinite if its
/// columns are linearly dependent.
Selection evaluate_selection(const SelectionProblem& problem, const std::vector<std::size_t>& chosen);

/// Returns the part of the extended BIC that chi^2 determines: -2 log likelihood, with the noise at its best
/// value but never below the given uncertainty.
double likelihood_part(const SelectionProblem& problem, double chi_square);

/// Returns the set of at most `most` entries with the smallest BIC. The search uses forward steps, pairs,
/// exchanges and backward steps. It begins with the empty set, with the best pair, and with each set of
/// entries in `starts`.
Selection select(const SelectionProblem& problem, std::size_t most,
                 const std::vector<std::vector<std::size_t>>& starts = {});

/// Returns the coefficients of the columns of a set, in the order of the set.
Eigen::VectorXd coefficients(const SelectionProblem& problem, const std::vector<std::size_t>& chosen);

}  // namespace vernier::diagnose
