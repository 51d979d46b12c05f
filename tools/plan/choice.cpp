#include "tools/plan/choice.h"

#include <algorithm>

namespace vernier {
namespace {

/// What the worse direction reaches with each offer; half of the better one's share breaks ties early on.
std::size_t best_offer(const TwoSides& sides, double& value) {
  const Eigen::ArrayXd first =
      (sides.side[0].gains().array() + sides.side[0].non_centrality()) / sides.needed[0];
  const Eigen::ArrayXd second =
      (sides.side[1].gains().array() + sides.side[1].non_centrality()) / sides.needed[1];
  constexpr double kTie = 1e-3;
  const Eigen::ArrayXd all = first.min(second) + kTie * first.max(second);
  Eigen::Index best = 0;
  value = all.maxCoeff(&best);
  return static_cast<std::size_t>(best);
}

}  // namespace

double TwoSides::reached() const {
  return std::min(side[0].non_centrality() / needed[0], side[1].non_centrality() / needed[1]);
}

void TwoSides::assume(const std::vector<std::size_t>& chosen) {
  for (Discrimination& one : side) one.assume(chosen);
}

void choose_rows(TwoSides& sides, std::vector<std::size_t>& chosen, std::size_t least, std::size_t most,
                 double goal) {
  sides.assume(chosen);
  while (chosen.size() < most && (chosen.size() < least || sides.reached() < goal)) {
    double value = 0;
    chosen.push_back(best_offer(sides, value));
    sides.assume(chosen);
  }
}

void exchange_rows(TwoSides& sides, std::vector<std::size_t>& chosen) {
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

}  // namespace vernier
