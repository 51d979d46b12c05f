// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/fit/coverage/unseen_turns.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <utility>

#include "tools/maths/decompositions.h"
#include "tools/maths/factors.h"
#include "tools/model/chain/prediction.h"

namespace vernier::fit {

std::vector<bool> unseen_turns(const model::Machine& machine, const model::Measurement& rows,
                               const model::ParameterSet& parameters, double reach_mm) {
  // Share of the size of the machine. If other axes move by less, they do not show a rotation of
  // the instrument.
  constexpr double kSeen = 1e-3;
  std::vector<bool> unseen(parameters.size(), false);
  std::map<std::pair<model::ParameterKind, std::size_t>, std::array<Eigen::Index, 6>> shifts;
  for (std::size_t i = 0; i < parameters.size(); ++i)
    if (model::is_set_up(parameters[i].kind)) {
      auto& columns = shifts.try_emplace({parameters[i].kind, parameters[i].item}).first->second;
      columns[parameters[i].column] = static_cast<Eigen::Index>(i);
    }
  if (shifts.empty()) return unseen;
  const model::Linearisation linear = model::linearise(machine, rows, parameters);
  for (const auto& shift : shifts) {
    const std::array<Eigen::Index, 6>& columns = shift.second;
    Eigen::MatrixXd lengths(linear.jacobian.rows(), 3);
    const auto column = [&](std::size_t k) {
      Eigen::VectorXd unit = Eigen::VectorXd::Zero(linear.jacobian.cols());
      unit[columns[k]] = 1;
      return Eigen::VectorXd(linear.jacobian * unit);
    };
    for (std::size_t k = 0; k < 3; ++k) lengths.col(static_cast<Eigen::Index>(k)) = column(k);
    const double rows_seen = std::max(1.0, lengths.squaredNorm());
    for (std::size_t k = 3; k < 6; ++k) {
      const Eigen::VectorXd turn = column(k) * maths::kDegPerRad;
      const double left = (turn - lengths * maths::least_norm(lengths, turn)).norm() / std::sqrt(rows_seen);
      unseen[static_cast<std::size_t>(columns[k])] = left < kSeen * reach_mm;
    }
  }
  return unseen;
}

void hold_at(FitProblem& problem, const std::vector<bool>& held, const Eigen::VectorXd& at) {
  if (std::find(held.begin(), held.end(), true) == held.end()) return;
  Eigen::SparseMatrix<double> precision(at.size(), at.size());
  for (std::size_t i = 0; i < held.size(); ++i)
    if (held[i])
      precision.insert(static_cast<Eigen::Index>(i), static_cast<Eigen::Index>(i)) =
          1 / (kHeldTurn_deg * kHeldTurn_deg);
  problem.set_priors(precision, at);
}

}  // namespace vernier::fit
