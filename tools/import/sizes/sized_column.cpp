// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/import/sizes/sized_column.h"

#include <fmt/format.h>

namespace vernier::importer {

std::optional<format::Unit> sized_unit(const SizedColumn& column) {
  const auto unit = format::find_unit(column.unit);
  const bool sized =
      unit && (unit->dimension == format::Dimension::kLength || unit->dimension == format::Dimension::kAngle);
  return !column.unit.empty() && sized ? unit : std::nullopt;
}

std::string size_text(double size, bool angle) {
  if (size == 0) return angle ? "0 deg" : "0 mm";
  if (angle) return size < 0.01 ? fmt::format("{:.3g} arcsec", size * 3600) : fmt::format("{:.3g} deg", size);
  return size < 1e-4   ? fmt::format("{:.3g} nm", size * 1e6)
         : size < 0.01 ? fmt::format("{:.3g} um", size * 1e3)
                       : fmt::format("{:.3g} mm", size);
}

DeviationSeries deviations_of(const sheet::Sheet& sheet, const sheet::SheetTable& table,
                              const std::vector<SizedColumn>& columns, std::size_t k) {
  DeviationSeries series;
  const auto unit = sized_unit(columns[k]);
  const bool deviation = columns[k].use == SizedColumn::Use::kDeviation;
  if (!unit || (!deviation && columns[k].measures.empty())) return series;
  std::optional<std::size_t> target;
  for (std::size_t i = 0; !deviation && i < columns.size(); ++i)
    if (columns[i].use == SizedColumn::Use::kPosition && columns[i].name == columns[k].measures &&
        sized_unit(columns[i]))
      target = i;
  if (!deviation && !target) return series;
  for (std::size_t row = table.first_data; row < sheet.rows.size(); ++row) {
    const auto value = sheet::number_at(sheet, row, k);
    const auto at = target ? sheet::number_at(sheet, row, *target) : std::nullopt;
    if (!value || (target && !at)) continue;
    series.value.push_back(*value * unit->factor - (target ? *at * sized_unit(columns[*target])->factor : 0));
    series.row.push_back(row);
  }
  return series;
}

}  // namespace vernier::importer
