// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <vector>

#include "tools/plan/discrimination.h"

namespace vernier::plan {

/// All comparisons that the rows must decide: one entry per pair of a true effect and an alternative that is
/// refitted.
struct Sides {
  std::vector<Discrimination> side;
  std::vector<double> needed;
  /// Non-centrality divided by the needed value, of the worst of the first `count` entries.
  double reached(std::size_t count) const;
  double reached() const { return reached(side.size()); }
  void assume(const std::vector<std::size_t>& chosen);
};

/// Adds offers (with repeats) to `chosen`. Each time it takes the offer that improves the worst
/// side most. It ends if `least` are chosen and `reached()` is at least `goal`, if `most` are
/// chosen, or if no offer improves it. tool.
void choose_rows(Sides& sides, std::vector<std::size_t>& chosen, std::size_t least, std::size_t most,
                 double goal);

/// Makes one pass of exchanges: each chosen row in turn is replaced by an offer that is better.
/// tool.
void exchange_rows(Sides& sides, std::vector<std::size_t>& chosen);

}  // namespace vernier::plan
