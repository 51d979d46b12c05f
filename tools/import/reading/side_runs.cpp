// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/import/reading/side_runs.h"

#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <optional>
#include <set>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "tools/format/columns.h"
#include "tools/import/tables/column_guess.h"
#include "tools/import/words/sheet_words.h"
#include "tools/text/words.h"

namespace vernier::importer {
namespace {

/// "Lauf 1 Pos [mm]": the run, and the heading without it; nullopt for other headings.
std::optional<std::pair<std::string, sheet::Heading>> heading_of_run(const sheet::Heading& heading) {
  static const std::set<std::string> kRunNames = {"lauf",      "run",  "messlauf", "messreihe", "messung",
                                                  "durchgang", "pass", "zyklus",   "cycle"};
  const std::vector<std::string> words = text::words_in(heading.text, " \t");
  constexpr std::size_t kMostDigits = 3;  // more digits are a date or a number of a machine
  if (words.size() < 3 || !kRunNames.contains(text::in_small_letters(words[0])) ||
      words[1].find_first_not_of("0123456789") != std::string::npos || words[1].size() > kMostDigits)
    return std::nullopt;
  std::string rest;
  for (std::size_t k = 2; k < words.size(); ++k) rest += (k == 2 ? "" : " ") + words[k];
  return std::pair(words[1], sheet::parse_heading(rest));
}

bool has_cells(const sheet::Sheet& sheet, const sheet::SheetTable& table, std::size_t k) {
  for (std::size_t row = table.first_data; row < sheet.rows.size(); ++row)
    if (!sheet.rows[row][k].empty()) return true;
  return false;
}

}  // namespace

bool stack_runs(sheet::Sheet& sheet, sheet::SheetTable& table) {
  if (!table.has_headings) return false;
  std::vector<std::string> order;                                  // of the runs
  std::map<std::string, std::vector<std::size_t>> columns_of;      // by run
  std::map<std::string, std::vector<sheet::Heading>> headings_of;  // by run
  for (std::size_t k = 0; k < table.headings.size(); ++k) {
    if (!has_cells(sheet, table, k)) continue;
    auto one = heading_of_run(table.headings[k]);
    if (!one) return false;
    if (!columns_of.contains(one->first)) order.push_back(one->first);
    columns_of[one->first].push_back(k);
    headings_of[one->first].push_back(std::move(one->second));
  }
  if (order.size() < 2) return false;
  const std::vector<sheet::Heading> first = headings_of[order.front()];
  const SheetWishes usual;
  const Guess guess(usual);
  const bool positions = std::any_of(first.begin(), first.end(), [&](const sheet::Heading& one) {
    return Guess::bare(one.name) == Guess::Bare::kTarget || guess.is_axis(guess.column(one).name);
  });
  if (!positions) return false;  // one column of positions for all runs: unfold_runs
  for (const std::string& run : order)
    if (!std::equal(first.begin(), first.end(), headings_of[run].begin(), headings_of[run].end(),
                    [](const sheet::Heading& a, const sheet::Heading& b) { return a.text == b.text; }))
      return false;
  std::vector<std::vector<std::string>> rows(
      sheet.rows.begin(), sheet.rows.begin() + static_cast<std::ptrdiff_t>(table.first_data));
  std::vector<std::size_t> line(sheet.line.begin(),
                                sheet.line.begin() + static_cast<std::ptrdiff_t>(table.first_data));
  for (const std::string& run : order)
    for (std::size_t row = table.first_data; row < sheet.rows.size(); ++row) {
      std::vector<std::string> cells;
      for (const std::size_t k : columns_of[run]) cells.push_back(sheet.rows[row][k]);
      if (sheet::is_blank(cells)) continue;  // a shorter run
      cells.push_back(run);
      rows.push_back(std::move(cells));
      line.push_back(sheet.line[row]);
    }
  table.headings = first;
  table.headings.push_back({format::columns::kRun, format::columns::kRun, "", ""});
  std::size_t width = table.headings.size();
  for (std::size_t row = 0; row < table.first_data; ++row) width = std::max(width, rows[row].size());
  for (auto& row : rows) row.resize(width);
  while (table.headings.size() < width)
    table.headings.push_back(sheet::parse_heading(std::to_string(table.headings.size() + 1)));
  sheet.rows = std::move(rows);
  sheet.line = std::move(line);
  sheet.written.clear();
  sheet.notes.push_back(
      fmt::format("the runs {} are side by side, each with its own positions: their rows are "
                  "read one run below the other, with a column run",
                  text::joined(order, ", ")));
  return true;
}

}  // namespace vernier::importer
