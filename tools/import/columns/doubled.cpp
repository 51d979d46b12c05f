// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/import/columns/doubled.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <optional>
#include <string>

#include "tools/format/units.h"
#include "tools/sheet/sheet_number.h"
#include "tools/text/error.h"
#include "tools/text/numbers.h"

namespace vernier::importer {
namespace {

/// A value of a cell and the step of its last decimal.
struct Shown {
  double value = 0, step = 0;
};

std::optional<Shown> shown_in(const sheet::Sheet& sheet, std::size_t row, std::size_t column) {
  const auto text = sheet::plain_number(sheet.rows[row][column], sheet.decimal_comma);
  const auto value = text ? text::parse_number(*text) : std::nullopt;
  if (!value) return std::nullopt;
  const auto point = text->find('.');
  const std::size_t decimals = point == std::string::npos ? 0 : text->size() - point - 1;
  return Shown{*value, std::pow(10, -static_cast<double>(decimals))};
}

double factor_of(const std::string& unit, double otherwise) {
  const auto found = unit.empty() ? std::nullopt : format::find_unit(unit);
  return found ? found->factor : otherwise;
}

/// One row in base units.
struct Row {
  std::size_t at = 0;
  double moved = 0, deviation = 0;  // measured - target, and the column of deviations
  double step = 0;                  // of both together
};

std::vector<Row> rows_of(const sheet::Sheet& sheet, const sheet::SheetTable& table,
                         const std::vector<SheetColumn>& columns, const DoubledReading& doubled,
                         double unit_of_deviation) {
  const double of_target = factor_of(columns[doubled.target].unit, 1),
               of_measured = factor_of(columns[doubled.measured].unit, of_target),
               of_deviation = factor_of(columns[doubled.deviation].unit, unit_of_deviation);
  std::vector<Row> rows;
  for (std::size_t row = table.first_data; row < sheet.rows.size(); ++row) {
    const auto target = shown_in(sheet, row, doubled.target),
               measured = shown_in(sheet, row, doubled.measured),
               deviation = shown_in(sheet, row, doubled.deviation);
    if (!target || !measured || !deviation) continue;
    rows.push_back({row, measured->value * of_measured - target->value * of_target,
                    deviation->value * of_deviation,
                    measured->step * of_measured + deviation->step * of_deviation});
  }
  return rows;
}

/// The first row whose deviation is not measured - target to the last decimal; nullptr: all rows agree.
const Row* contradiction(const std::vector<Row>& rows, double sign) {
  constexpr double kRounding = 1e-9;  // of binary numbers, mm
  for (const Row& row : rows)
    if (std::abs(row.moved - sign * row.deviation) > row.step * (1 + kRounding) + kRounding) return &row;
  return nullptr;
}

}  // namespace

bool settle_doubled(const sheet::Sheet& sheet, const sheet::SheetTable& table,
                    std::vector<SheetColumn>& columns, const DoubledReading& doubled) {
  SheetColumn &measured = columns[doubled.measured], &deviation = columns[doubled.deviation];
  const std::string &position_text = table.headings[doubled.measured].text,
                    &deviation_text = table.headings[doubled.deviation].text;
  // Units that a deviation without a unit may have: that of the target, and a thousandth of it.
  const double target_unit = factor_of(columns[doubled.target].unit, 1);
  const std::vector<Row> rows = rows_of(sheet, table, columns, doubled, target_unit);
  constexpr double kNone = 1e-9;  // binary rounding of equal positions
  const bool equal =
      std::all_of(rows.begin(), rows.end(), [&](const Row& row) { return std::abs(row.moved) < kNone; });
  const bool deviates =
      std::any_of(rows.begin(), rows.end(), [&](const Row& row) { return row.deviation != 0; });
  if (equal && deviates) {
    measured.use = SheetColumn::Use::kLeft;
    measured.why = fmt::format(
        "equal to the target in each row: the control shows this position, and \"{}\" is "
        "the reading",
        deviation_text);
    return true;
  }
  const Row* worst = nullptr;
  for (const double unit : {target_unit, target_unit / 1000})
    for (const double sign : {1.0, -1.0}) {
      const std::vector<Row> in_unit = rows_of(sheet, table, columns, doubled, unit);
      worst = contradiction(in_unit, sign);
      if (worst != nullptr) continue;
      deviation.use = SheetColumn::Use::kLeft;
      deviation.why =
          fmt::format("the table already has the measured position, as the column {}", measured.name);
      return false;
    }
  worst = contradiction(rows, 1);
  const std::string unit = deviation.unit.empty() ? "" : " " + deviation.unit;
  throw text::InputError(
      {sheet.file, sheet.line[worst->at]}, sheet.rows[worst->at][doubled.deviation],
      fmt::format(
          "\"{0}\" minus the target is {1:.6g}{2} in this row, and \"{3}\" states another value: the two "
          "columns contradict each other. Read one of them: --leave \"{0}\" or --leave \"{3}\"",
          position_text, worst->moved / factor_of(deviation.unit, target_unit), unit, deviation_text));
}

}  // namespace vernier::importer
