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
  /// Non-centrality divided by the required value, of the worst of the first `count` entries.
  double reached(std::size_t count) const;
  double reached() const { return reached(side.size()); }
  void assume(const std::vector<std::size_t>& chosen);
};

/// Adds offers (with repeats) to `chosen`, always the one that improves the worst side most. Ends when
/// `least` are chosen and `reached()` is at least `goal`, when `most` are chosen, or when no offer improves
/// it. tool.
void choose_rows(Sides& sides, std::vector<std::size_t>& chosen, std::size_t least, std::size_t most,
                 double goal);

/// One pass of exchanges: each chosen row in turn for the offer that does better in its place. tool.
void exchange_rows(Sides& sides, std::vector<std::size_t>& chosen);

}  // namespace vernier::plan
