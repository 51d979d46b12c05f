#pragma once
#include <array>
#include <vector>

#include "tools/plan/discrimination.h"

namespace vernier {

/// The two directions: A true and B refitted, B true and A refitted; and what each must reach.
struct TwoSides {
  std::array<Discrimination, 2> side;
  std::array<double, 2> needed{};
  /// Non-centrality over what is needed, of the worse direction.
  double reached() const;
  void assume(const std::vector<std::size_t>& chosen);
};

/// Adds offers (with repeats) to `chosen`, always the one that helps the worse direction most, until `least`
/// are chosen and `reached()` is at least `goal`, or `most` are chosen or no offer helps. tool.
void choose_rows(TwoSides& sides, std::vector<std::size_t>& chosen, std::size_t least, std::size_t most,
                 double goal);

/// One pass of exchanges: each chosen row in turn for the offer that does better in its place. tool.
void exchange_rows(TwoSides& sides, std::vector<std::size_t>& chosen);

}  // namespace vernier
