// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/import/tables/run_units.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <optional>
#include <string>

#include "tools/format/units.h"
#include "tools/sheet/sheet_number.h"
#include "tools/text/numbers.h"
#include "tools/text/words.h"

namespace vernier::importer {
namespace {

std::optional<format::Unit> size_unit(const std::string& name) {
  const auto unit = name.empty() ? std::nullopt : format::find_unit(name);
  const bool size =
      unit && unit->offset == 0 &&
      (unit->dimension == format::Dimension::kLength || unit->dimension == format::Dimension::kAngle);
  return size ? unit : std::nullopt;
}

/// The number of a cell times `ratio`. A power of ten moves the decimal sign, and keeps the digits: the
/// number of decimals shows how the cell was typed.
std::string times_cell(const std::string& number, double ratio, bool comma) {
  constexpr double kRounding = 1e-9;  // of the factors of two units
  constexpr int kEnough = 9;          // decimals, below every instrument
  const double value = *text::parse_number(number) * ratio, power = std::round(std::log10(ratio));
  const bool moves = std::abs(std::pow(10, power) / ratio - 1) < kRounding;
  const int decimals = static_cast<int>(sheet::decimals_of(number, false)) - static_cast<int>(power);
  std::string text = moves ? fmt::format("{:.{}f}", value, std::clamp(decimals, 0, kEnough))
                           : text::fixed_text(value, kEnough);
  if (comma) std::replace(text.begin(), text.end(), '.', ',');
  return text;
}

}  // namespace

bool convert_to_one_unit(sheet::Sheet& sheet, sheet::SheetTable& table,
                         const std::vector<std::size_t>& columns) {
  const sheet::Heading& first = table.headings[columns.front()];
  const auto to = size_unit(first.unit);
  if (!to) return false;
  for (const std::size_t k : columns) {
    const auto from = size_unit(table.headings[k].unit);
    if (!from || from->dimension != to->dimension) return false;
  }
  std::vector<std::string> converted;
  for (const std::size_t k : columns) {
    sheet::Heading& heading = table.headings[k];
    if (heading.unit == first.unit) continue;
    const double ratio = size_unit(heading.unit)->factor / to->factor;
    for (std::size_t row = table.first_data; row < sheet.rows.size(); ++row) {
      const auto number = sheet::plain_number(sheet.rows[row][k], sheet.decimal_comma);
      if (!number || !text::parse_number(*number)) continue;
      sheet.rows[row][k] = times_cell(*number, ratio, sheet.decimal_comma);
      sheet.exact.insert(sheet.rows[row][k]);
    }
    converted.push_back(fmt::format("\"{}\"", heading.text));
    heading.unit = first.unit;
  }
  if (!converted.empty())
    sheet.notes.push_back(
        fmt::format("the runs have several units: the values of {} are converted to [{}], the "
                    "unit of \"{}\"",
                    text::joined(converted, ", "), first.unit, first.text));
  return true;
}

}  // namespace vernier::importer
