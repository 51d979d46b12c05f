// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <vector>

#include "tools/plan/discrimination.h"

namespace vernier::plan {

/// All comparisons between two effects that the readings of the selected rows must decide. Each pair of a
/// true effect and an alternative effect that is refitted has one comparison.
struct Sides {
  std::vector<Discrimination> side;
  std::vector<double> needed;
  /// Returns the smallest ratio of non-centrality to required value among the first `count` comparisons.
  double reached(std::size_t count) const;
  double reached() const { return reached(side.size()); }
  void assume(const std::vector<std::size_t>& chosen);
};

/// Adds offered rows to `chosen`. Each time, the row that most improves the worst comparison is added; a row
/// may be added several times. choose_rows ends in three cases: `least` rows are selected and `reached()` is
/// at least `goal`; `most` rows are selected; no offered row improves the worst comparison.
void choose_rows(Sides& sides, std::vector<std::size_t>& chosen, std::size_t least, std::size_t most,
                 double goal);

/// Makes one pass of exchanges: replaces each chosen row by the offered row that gives a better result.
void exchange_rows(Sides& sides, std::vector<std::size_t>& chosen);

}  // namespace vernier::plan
