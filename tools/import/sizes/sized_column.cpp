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

}  // namespace vernier::importer
