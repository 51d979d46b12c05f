// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/import/columns/signed_positions.h"

#include <fmt/format.h>

#include <array>
#include <optional>
#include <string>
#include <string_view>
#include <utility>

#include "tools/import/columns/column_guess.h"
#include "tools/sheet/sheet_number.h"
#include "tools/text/words.h"

namespace vernier::importer {
namespace {

/// "50+", "50 -": the number and the direction; nullopt for other cells.
std::optional<std::pair<std::string, int>> signed_position(const std::string& cell, bool decimal_comma) {
  static constexpr std::array<std::pair<std::string_view, int>, 6> kSigns = {
      {{"+", 1}, {"-", -1}, {"\u2212", -1}, {"\u2013", -1}, {"\u2191", 1}, {"\u2193", -1}}};
  for (const auto& [sign, sense] : kSigns) {
    if (!cell.ends_with(sign)) continue;
    std::string number = text::trimmed(cell.substr(0, cell.size() - sign.size()));
    if (!sheet::plain_number(number, decimal_comma)) return std::nullopt;
    return std::pair(std::move(number), sense);
  }
  return std::nullopt;
}

}  // namespace

void split_signed_positions(sheet::Sheet& sheet, sheet::SheetTable& table) {
  const auto position = table.has_headings ? column_of_positions(table) : std::nullopt;
  if (!position) return;
  const SheetWishes usual;
  const Guess guess(usual);
  for (const sheet::Heading& heading : table.headings)
    if (is_sense(guess.column(heading).name)) return;
  bool up = false, down = false;
  for (std::size_t row = table.first_data; row < sheet.rows.size(); ++row) {
    if (sheet::is_blank(sheet.rows[row])) continue;
    const auto both = signed_position(sheet.rows[row][*position], sheet.decimal_comma);
    if (!both) return;
    (both->second > 0 ? up : down) = true;
  }
  if (!up || !down) return;
  for (std::size_t row = 0; row < sheet.rows.size(); ++row) {
    std::string direction;
    if (row >= table.first_data && !sheet::is_blank(sheet.rows[row])) {
      auto both = signed_position(sheet.rows[row][*position], sheet.decimal_comma);
      direction = std::to_string(both->second);
      sheet.rows[row][*position] = std::move(both->first);
    }
    sheet.rows[row].push_back(std::move(direction));
  }
  table.headings.push_back(heading_of_directions());
  sheet.written.clear();
  sheet.notes.push_back(
      fmt::format("\"{}\" has the position and the approach direction in one cell: they are read as "
                  "two columns",
                  table.headings[*position].text));
}

}  // namespace vernier::importer
