// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/fit/coverage/seen_beside_things.h"

#include <algorithm>
#include <cmath>

#include "tools/fit/least_squares/statistics.h"
#include "tools/model/chain/linearizer.h"
#include "tools/model/chain/prediction.h"

namespace vernier::fit {
namespace {

using Eigen::Index;
using Eigen::VectorXd;

/// Squares of the weighted derivatives of all readings by each parameter, for objects that do not follow.
VectorXd squares_of_held(const model::Machine& machine, const model::Linearizer& linearizer,
                         const VectorXd& weights, Index parameters) {
  VectorXd squares = VectorXd::Zero(parameters);
  linearizer.each_row(machine, [&](const model::RowLinear& row) {
    const Index count = row.predicted.size();
    const auto weight = weights.segment(static_cast<Index>(row.first_observation), count);
    for (const model::ParameterGroup& group : row.groups)
      for (const auto& [first, share] : group.first_weight)
        for (Index k = 0; k < group.width; ++k)
          squares[first + k] +=
              (share * row.gradient.row(group.slot + k).transpose().cwiseProduct(weight)).squaredNorm();
  });
  return squares;
}

}  // namespace

SeenBesideThings seen_beside_things(const model::Machine& machine, const model::Measurement& rows,
                                    const model::ParameterSet& parameters) {
  const auto n = static_cast<Index>(parameters.size());
  const VectorXd weights = fit_weights(rows);
  const model::Linearizer linearizer(machine, rows, parameters);
  const VectorXd held = squares_of_held(machine, linearizer, weights, n);
  const model::Linearisation followed =
      model::linearise(machine, linearizer, rows.observations.size(), parameters.size());
  SeenBesideThings seen{VectorXd::Zero(n), VectorXd::Zero(n)};
  for (Index row = 0; row < followed.jacobian.rows(); ++row)
    for (model::SparseRows::InnerIterator entry(followed.jacobian, row); entry; ++entry)
      seen.squares[entry.col()] += std::pow(weights[row] * entry.value(), 2);
  if (followed.known_jacobian.rows() > 0)
    seen.squares += followed.known_jacobian.colwise().squaredNorm().transpose();
  for (Index i = 0; i < n; ++i)
    if (held[i] > 0) seen.share[i] = std::sqrt(std::min(1.0, seen.squares[i] / held[i]));
  return seen;
}

}  // namespace vernier::fit
