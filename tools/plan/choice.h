// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <vector>

#include "tools/plan/discrimination.h"

namespace vernier::plan {

/// All comparisons that the rows must decide. Each pair of a true effect and an alternative that is refitted
/// has one entry.
struct Sides {
  std::vector<Discrimination> side;
  std::vector<double> needed;
  /// Non-centrality divided by the required value, of the worst of the first `count` entries.
  double reached(std::size_t count) const;
  double reached() const { return reached(side.size()); }
  void assume(const std::vector<std::size_t>& chosen);
};

/// Adds offered rows (with repeats) to `chosen`; each time the row that improves the worst comparison most.
/// Ends in three cases: `least` rows are chosen and `reached()` is at least `goal`; `most` rows are chosen;
/// no offered row improves the worst comparison.
void choose_rows(Sides& sides, std::vector<std::size_t>& chosen, std::size_t least, std::size_t most,
                 double goal);

/// Makes one pass of exchanges: replaces each chosen row by the offered row that gives a better result.
void exchange_rows(Sides& sides, std::vector<std::size_t>& chosen);

}  // namespace vernier::plan
