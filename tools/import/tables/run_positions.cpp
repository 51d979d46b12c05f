// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/import/tables/run_positions.h"

#include <algorithm>
#include <set>

#include "tools/format/units.h"
#include "tools/import/columns/column_guess.h"
#include "tools/import/words/sheet_words.h"
#include "tools/text/words.h"

namespace vernier::importer {
namespace {

/// True if the column has numbers, and not all of them are equal.
bool varies(const sheet::Sheet& sheet, const sheet::SheetTable& table, std::size_t column) {
  std::set<double> values;
  for (std::size_t row = table.first_data; row < sheet.rows.size(); ++row)
    if (const auto value = sheet::number_at(sheet, row, column)) values.insert(*value);
  return values.size() > 1;
}

bool is_length_or_angle(const std::string& unit) {
  const auto found = unit.empty() ? std::nullopt : format::find_unit(unit);
  return found &&
         (found->dimension == format::Dimension::kLength || found->dimension == format::Dimension::kAngle);
}

}  // namespace

std::size_t positions_of_runs(const sheet::Sheet& sheet, const sheet::SheetTable& table,
                              const std::vector<std::size_t>& others, const SheetWishes& wishes) {
  const Guess guess(wishes);
  const auto given = [&](std::size_t k) {
    return std::any_of(wishes.assignments.begin(), wishes.assignments.end(), [&](const auto& one) {
      return one.column.use == SheetColumn::Use::kColumn && guess.is_axis(one.column.name) &&
             find_heading(table, one.heading) == k;
    });
  };
  const auto of_axis = [&](std::size_t k) {
    const SheetColumn column = guess.column(table.headings[k]);
    return column.use == SheetColumn::Use::kColumn && guess.is_axis(column.name) && varies(sheet, table, k);
  };
  const auto named = [&](std::size_t k) {
    return Guess::bare(table.headings[k].name) == Guess::Bare::kTarget && !counts_rows(sheet, table, k);
  };
  const auto moves = [&](std::size_t k) { return varies(sheet, table, k); };
  const auto sized = [&](std::size_t k) {
    return is_length_or_angle(table.headings[k].unit) && !names_statistic(table.headings[k]) && moves(k);
  };
  const auto named_and_moves = [&](std::size_t k) { return named(k) && moves(k); };
  auto found = std::find_if(others.begin(), others.end(), given);
  if (found == others.end()) found = std::find_if(others.begin(), others.end(), of_axis);
  if (found == others.end()) found = std::find_if(others.begin(), others.end(), named_and_moves);
  if (found == others.end()) found = std::find_if(others.begin(), others.end(), named);
  if (found == others.end()) found = std::find_if(others.begin(), others.end(), sized);
  return found == others.end() ? others.front() : *found;
}

}  // namespace vernier::importer
