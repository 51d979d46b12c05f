// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/lint/run_order.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <map>
#include <string>
#include <vector>

#include "tools/format/columns.h"
#include "tools/import/columns/column_guess.h"
#include "tools/import/order/motion_directions.h"
#include "tools/import/sizes/odd_runs.h"

namespace vernier::lint {

void look_at_signs_of_runs(const LintTable& table, const LintNames& names, LintFindings& findings) {
  const LintColumn* const run = table.find(format::columns::kRun);
  if (run == nullptr) return;
  for (const LintColumn& axis : table.columns) {
    const auto measured = names.is_axis(axis.name) ? importer::reading_of(axis.name) : std::nullopt;
    const LintColumn* const reading = measured ? table.find(*measured) : nullptr;
    if (reading == nullptr) continue;
    const LintColumn* const sense = table.find(format::axis_column(format::AxisQuantity::kSense, axis.name));
    std::map<std::string, importer::RunDeviations> runs;
    std::map<std::string, std::size_t> first;
    const std::vector<int> moved = importer::directions_by_motion(axis.value, run->cell);
    for (std::size_t row = 0; row < table.rows.size(); ++row) {
      const double deviation = reading->value[row] - axis.value[row];
      if (!std::isfinite(deviation)) continue;
      const int direction = sense == nullptr ? moved[row] : (sense->value[row] > 0) - (sense->value[row] < 0);
      first.emplace(run->cell[row], row);
      runs[run->cell[row]].emplace(std::pair{axis.value[row], direction}, deviation);
    }
    const auto found = importer::opposite_run(runs);
    if (!found) continue;
    const std::size_t row = first.at(found->first);
    findings.warn(table.rows[row].line, reading->cell[row],
                  importer::opposite_run_text("run " + found->first, "run " + found->second));
  }
}

}  // namespace vernier::lint
