// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/plan/choice.h"

#include <algorithm>

namespace vernier::plan {
namespace {

/// Returns the value of the worst side with each offer. If values are equal, the sum of the other
/// sides decides, as far as they need it.
std::size_t best_offer(const Sides& sides, double& value) {
  constexpr double kTie = 1e-3;  // of a gain: a smaller difference is a tie, and the order decides
  Eigen::ArrayXd worst, sum;
  for (std::size_t i = 0; i < sides.side.size(); ++i) {
    const Eigen::ArrayXd one =
        (sides.side[i].gains().array() + sides.side[i].non_centrality()) / sides.needed[i];
    worst = i == 0 ? one : Eigen::ArrayXd(worst.min(one));
    sum = i == 0 ? Eigen::ArrayXd(one.min(1)) : Eigen::ArrayXd(sum + one.min(1));
  }
  Eigen::Index best = 0;
  value = (worst + kTie * sum).maxCoeff(&best);
  return static_cast<std::size_t>(best);
}

}  // namespace

double Sides::reached(std::size_t count) const {
  double worst = 1e300;
  for (std::size_t i = 0; i < count; ++i) worst = std::min(worst, side[i].non_centrality() / needed[i]);
  return worst;
}

void Sides::assume(const std::vector<std::size_t>& chosen) {
  for (Discrimination& one : side) one.assume(chosen);
}

void choose_rows(Sides& sides, std::vector<std::size_t>& chosen, std::size_t least, std::size_t most,
                 double goal) {
  sides.assume(chosen);
  while (chosen.size() < most && (chosen.size() < least || sides.reached() < goal)) {
    double value = 0;
    chosen.push_back(best_offer(sides, value));
    sides.assume(chosen);
  }
}

void exchange_rows(Sides& sides, std::vector<std::size_t>& chosen) {
  for (std::size_t i = 0; i < chosen.size(); ++i) {
    sides.assume(chosen);
    const double before = sides.reached();
    std::vector<std::size_t> others = chosen;
    others.erase(others.begin() + static_cast<std::ptrdiff_t>(i));
    sides.assume(others);
    double value = 0;
    others.insert(others.begin() + static_cast<std::ptrdiff_t>(i), best_offer(sides, value));
    sides.assume(others);
    if (sides.reached() > before) chosen = others;
  }
  sides.assume(chosen);
}

}  // namespace vernier::plan
