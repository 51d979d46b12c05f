// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/import/tables/statistic_values.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "tools/import/columns/column_guess.h"
#include "tools/sheet/sheet_number.h"

namespace vernier::importer {
namespace {

std::vector<double> numbers_above(const sheet::Sheet& sheet, std::size_t column, std::size_t first,
                                  std::size_t row) {
  std::vector<double> values;
  for (std::size_t above = first; above < row; ++above)
    if (const auto value = sheet::number_at(sheet, above, column)) values.push_back(*value);
  return values;
}

std::vector<double> statistics_of(std::vector<double> values) {
  std::sort(values.begin(), values.end());
  const auto n = static_cast<double>(values.size());
  const double sum = std::accumulate(values.begin(), values.end(), 0.0), mean = sum / n;
  double squares = 0, about_mean = 0, magnitude = 0;
  for (const double value : values) {
    squares += value * value;
    about_mean += (value - mean) * (value - mean);
    magnitude = std::max(magnitude, std::abs(value));
  }
  const std::size_t half = values.size() / 2;
  const double median = values.size() % 2 == 1 ? values[half] : (values[half - 1] + values[half]) / 2;
  std::vector<double> all = {mean, values.back(), values.front(), values.back() - values.front(),
                             sum,  median,        magnitude,      std::sqrt(squares / n),
                             n};
  for (const double spread : {std::sqrt(about_mean / std::max(n - 1, 1.0)), std::sqrt(about_mean / n)})
    for (const double times : {1.0, 2.0, 3.0, 4.0, 6.0}) all.push_back(times * spread);
  return all;
}

/// True if `value` is one of these numbers, to its last digit.
bool among(double value, double digit, const std::vector<double>& numbers) {
  // Half a digit of the printed value; as much again if the values above are rounded too. Whole numbers are
  // positions, and these are not rounded.
  const double rounding = digit < 1 ? 1.01 : 0.51;
  return std::any_of(numbers.begin(), numbers.end(),
                     [&](double other) { return std::abs(value - other) <= rounding * digit; });
}

bool agrees(const sheet::Sheet& sheet, std::size_t columns, std::size_t row, std::size_t first) {
  constexpr std::size_t kFewest = 2;  // a single row above is no group
  bool any = false;
  for (std::size_t k = 0; k < columns; ++k) {
    const auto value = sheet::number_at(sheet, row, k);
    if (!value) continue;
    const std::vector<double> above = numbers_above(sheet, k, first, row);
    const double digit =
        std::pow(10, -static_cast<double>(sheet::decimals_of(sheet.rows[row][k], sheet.decimal_comma)));
    if (above.empty() || !among(*value, digit, statistics_of(above))) return false;
    any |= above.size() >= kFewest;
  }
  return any;
}

}  // namespace

std::vector<std::size_t> position_columns(const sheet::SheetTable& table) {
  const SheetWishes usual;
  const Guess guess(usual);
  std::vector<std::size_t> columns;
  for (std::size_t k = 0; table.has_headings && k < table.headings.size(); ++k) {
    const SheetColumn column = guess.column(table.headings[k]);
    if ((column.use == SheetColumn::Use::kColumn && guess.is_axis(column.name)) ||
        Guess::bare(table.headings[k].name) == Guess::Bare::kTarget)
      columns.push_back(k);
  }
  return columns;
}

bool has_number(const sheet::Sheet& sheet, std::size_t row, const std::vector<std::size_t>& columns) {
  return std::any_of(columns.begin(), columns.end(), [&](std::size_t k) {
    return k < sheet.rows[row].size() && sheet::number_at(sheet, row, k).has_value();
  });
}

bool agrees_with_statistics(const sheet::Sheet& sheet, const sheet::SheetTable& table, std::size_t row,
                            std::size_t since, bool all_rows) {
  const std::size_t columns = std::min(table.headings.size(), sheet.rows[row].size());
  return agrees(sheet, columns, row, since) || (all_rows && agrees(sheet, columns, row, table.first_data));
}

}  // namespace vernier::importer
