// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/diagnose/propose/selection.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "tools/maths/decompositions.h"

namespace vernier::diagnose {
namespace {

Eigen::Index column_count(const SelectionProblem& p, const std::vector<std::size_t>& chosen) {
  Eigen::Index count = 0;
  for (const std::size_t entry : chosen) count += p.entries[entry].count;
  return count;
}

/// Gram matrix and moment of the columns of a set.
void gather(const SelectionProblem& p, const std::vector<std::size_t>& chosen, Eigen::MatrixXd& gram,
            Eigen::VectorXd& moment) {
  const Eigen::Index n = column_count(p, chosen);
  gram.resize(n, n);
  moment.resize(n);
  Eigen::Index row = 0;
  for (const std::size_t a : chosen) {
    const SelectionEntry& left = p.entries[a];
    moment.segment(row, left.count) = p.moment.segment(left.first, left.count);
    Eigen::Index column = 0;
    for (const std::size_t b : chosen) {
      const SelectionEntry& right = p.entries[b];
      gram.block(row, column, left.count, right.count) =
          p.gram.block(left.first, right.first, left.count, right.count);
      column += right.count;
    }
    row += left.count;
  }
}

/// Returns the decrease of chi^2 by a set; nullopt if its columns are linearly dependent.
bool explained(const SelectionProblem& p, const std::vector<std::size_t>& chosen, double& gain) {
  Eigen::MatrixXd gram;
  Eigen::VectorXd moment;
  gather(p, chosen, gram, moment);
  gain = 0;
  // Cholesky column by column: the pivots are the independent part of each column.
  const Eigen::Index n = moment.size();
  for (Eigen::Index j = 0; j < n; ++j) {
    const double before = gram(j, j);
    if (before <= 0) return false;
    double pivot = before;
    for (Eigen::Index k = 0; k < j; ++k) pivot -= gram(j, k) * gram(j, k);
    if (pivot < p.least_pivot * before) return false;
    pivot = std::sqrt(pivot);
    double value = moment[j];
    for (Eigen::Index k = 0; k < j; ++k) value -= gram(j, k) * moment[k];
    gram(j, j) = pivot;
    moment[j] = value / pivot;
    gain += moment[j] * moment[j];
    for (Eigen::Index i = j + 1; i < n; ++i) {
      double element = gram(i, j);
      for (Eigen::Index k = 0; k < j; ++k) element -= gram(i, k) * gram(j, k);
      gram(i, j) = element / pivot;
    }
  }
  return true;
}

bool clashes(const SelectionProblem& p, const std::vector<std::size_t>& chosen, std::size_t entry) {
  return std::any_of(chosen.begin(), chosen.end(), [&](std::size_t other) {
    return other == entry || p.entries[other].cause == p.entries[entry].cause;
  });
}

/// Returns the best entry to add to `kept`; `now` if none lowers the criterion.
Selection best_addition(const SelectionProblem& p, const std::vector<std::size_t>& kept, Selection now) {
  std::vector<std::size_t> set = kept;
  set.push_back(0);
  for (std::size_t entry = 0; entry < p.entries.size(); ++entry) {
    if (clashes(p, kept, entry)) continue;
    set.back() = entry;
    Selection next = evaluate_selection(p, set);
    if (next.criterion < now.criterion - kSameCriterion) now = std::move(next);
  }
  return now;
}

/// Forward steps, exchanges and backward steps until the criterion does not decrease.
Selection improve(const SelectionProblem& p, Selection now, std::size_t most) {
  constexpr int kMostRounds = 50;  // rounds of adding and removing, at most
  for (int round = 0; round < kMostRounds; ++round) {
    const double before = now.criterion;
    if (now.chosen.size() < most) now = best_addition(p, now.chosen, now);
    for (std::size_t i = 0; i < now.chosen.size(); ++i) {
      std::vector<std::size_t> others = now.chosen;
      others.erase(others.begin() + static_cast<std::ptrdiff_t>(i));
      const Selection without = evaluate_selection(p, others);
      if (without.criterion <= now.criterion) {
        now = without;
        break;
      }
      const Selection exchanged = best_addition(p, others, now);
      if (exchanged.criterion < now.criterion - kSameCriterion) {
        now = exchanged;
        break;
      }
    }
    if (now.criterion >= before - kSameCriterion) break;
  }
  return now;
}

/// The best pair: each of two effects may be invisible in every single step.
Selection best_pair(const SelectionProblem& p) {
  Selection best = evaluate_selection(p, {});
  for (std::size_t a = 0; a < p.entries.size(); ++a)
    for (std::size_t b = 0; b < a; ++b) {
      if (p.entries[a].cause == p.entries[b].cause) continue;
      Selection next = evaluate_selection(p, {a, b});
      if (next.criterion < best.criterion - kSameCriterion) best = std::move(next);
    }
  return best;
}

/// Orders by the decrease, largest first.
void order(const SelectionProblem& p, Selection& selection) {
  std::vector<std::size_t> rest = selection.chosen, ordered;
  while (!rest.empty()) {
    std::size_t best = 0;
    double least = std::numeric_limits<double>::infinity();
    for (std::size_t i = 0; i < rest.size(); ++i) {
      std::vector<std::size_t> set = ordered;
      set.push_back(rest[i]);
      const double value = evaluate_selection(p, set).criterion;
      if (value < least - kSameCriterion) {
        least = value;
        best = i;
      }
    }
    ordered.push_back(rest[best]);
    rest.erase(rest.begin() + static_cast<std::ptrdiff_t>(best));
  }
  selection.chosen = ordered;
}

}  // namespace

SelectionProblem selection_problem(const Eigen::MatrixXd& columns, const Eigen::VectorXd& residual) {
  SelectionProblem p;
  p.gram = columns.transpose() * columns;
  p.moment = columns.transpose() * residual;
  p.chi_square = residual.squaredNorm();
  p.observations = static_cast<double>(residual.size());
  return p;
}

double likelihood_part(const SelectionProblem& p, double chi_square) {
  const double freedom = std::max(p.freedom, 1.0);
  const double reduced = chi_square / freedom;
  // With the noise at its best value the likelihood is n log(chi^2/n). A noise below the given
  // uncertainty is not accepted.
  if (p.noise_known && reduced <= 1) return chi_square;
  return freedom * (1 + std::log(std::max(reduced, 1e-300)));
}

Selection evaluate_selection(const SelectionProblem& p, const std::vector<std::size_t>& chosen) {
  Selection result{chosen, std::numeric_limits<double>::infinity(), p.chi_square};
  double gain = 0;
  if (!explained(p, chosen, gain)) return result;
  result.chi_square = std::max(p.chi_square - gain, 1e-12 * p.chi_square);
  double unknowns = 0, penalty = 0;
  for (const std::size_t entry : chosen) {
    unknowns += static_cast<double>(p.entries[entry].count) + static_cast<double>(p.entries[entry].scanned);
    penalty += p.entries[entry].penalty;
  }
  result.criterion =
      likelihood_part(p, result.chi_square) + unknowns * std::log(std::max(2.0, p.observations)) + penalty;
  return result;
}

Selection select(const SelectionProblem& p, std::size_t most,
                 const std::vector<std::vector<std::size_t>>& starts) {
  Selection best = improve(p, evaluate_selection(p, {}), most);
  const auto try_from = [&](const Selection& start) {
    Selection other = improve(p, start, most);
    if (other.criterion < best.criterion - kSameCriterion) best = std::move(other);
  };
  if (most >= 2) try_from(best_pair(p));
  for (const std::vector<std::size_t>& start : starts)
    if (start.size() <= most) try_from(evaluate_selection(p, start));
  order(p, best);
  return best;
}

Eigen::VectorXd coefficients(const SelectionProblem& p, const std::vector<std::size_t>& chosen) {
  Eigen::MatrixXd gram;
  Eigen::VectorXd moment;
  gather(p, chosen, gram, moment);
  if (moment.size() == 0) return moment;
  return maths::solve_symmetric(gram, moment);
}

}  // namespace vernier::diagnose
