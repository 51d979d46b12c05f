// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/import/reading/paired_sheets.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstddef>
#include <optional>
#include <vector>

#include "tools/import/columns/column_guess.h"
#include "tools/import/reading/invalid_rows.h"
#include "tools/import/reading/side_statistics.h"
#include "tools/import/tables/computed_rows.h"
#include "tools/import/tables/table_shape.h"
#include "tools/import/words/sheet_words.h"
#include "tools/text/error.h"
#include "tools/text/words.h"

namespace vernier::importer {
namespace {

/// The name of a sheet as the name that both directions have, and the direction; sense 0: no direction.
struct DirectedName {
  std::string rest;
  int sense = 0;
  bool way = false;  // true: a direction of the survey ("vor"), false: of the axis ("X+")
};

DirectedName directed(const std::string& name) {
  DirectedName found;
  std::string small = text::in_small_letters(name);
  for (std::size_t k = 1; k + 1 < small.size(); ++k)
    if (small[k] == '-' && small[k + 1] != ' ') small[k] = ' ';  // "X-hin" has two words
  for (const std::string& word : words_with_signs(small)) {
    const bool of_axis = is_axis_direction(word), sign = word == "+" || word == "-";
    const bool letters = word.find_first_of("0123456789") == std::string::npos;
    const int sense = letters && word.size() > 1 ? sense_said(word) : sign ? sense_said(word) : 0;
    if (sense != 0 && found.sense != 0) return {};
    if (sense != 0) {
      found.sense = sense;
      found.way = says_way(word);
    }
    if (sense == 0 || of_axis) found.rest += " " + (of_axis ? word.substr(0, 1) : word);
  }
  return found;
}

std::optional<std::string> other_direction(const sheet::Sheet& sheet, const DirectedName& name) {
  std::optional<std::string> other;
  for (const std::string& beside : sheet.tables_beside) {
    const DirectedName one = directed(beside);
    if (one.sense != -name.sense || one.rest != name.rest) continue;
    if (other) return std::nullopt;
    other = beside;
  }
  return other;
}

/// True if a heading or a run of the table states a direction.
bool has_directions(const sheet::SheetTable& table) {
  const SheetWishes usual;
  const Guess guess(usual);
  for (const sheet::Heading& heading : table.headings) {
    if (is_sense(guess.column(heading).name)) return true;
    for (const std::string& word : words_with_signs(text::in_small_letters(heading.text)))
      if (word.find_first_of("0123456789") == std::string::npos && sense_said(word) != 0 && word != "pos")
        return true;
    if (heading.text.find("\u2191") != std::string::npos || heading.text.find('+') != std::string::npos)
      return true;
  }
  return false;
}

/// 1 if the first position of the rows is smaller than the last one, -1 if it is larger, else 0.
int order_of(const sheet::Sheet& sheet, const sheet::SheetTable& table) {
  const auto position = column_of_positions(table);
  std::optional<double> first, last;
  for (std::size_t row = table.first_data; position && row < sheet.rows.size(); ++row)
    if (const auto at = sheet::number_at(sheet, row, *position)) {
      if (!first) first = at;
      last = at;
    }
  return !first || *first == *last ? 0 : *last > *first ? 1 : -1;
}

void turn_rows(sheet::Sheet& sheet, std::size_t first) {
  std::reverse(sheet.rows.begin() + static_cast<std::ptrdiff_t>(first), sheet.rows.end());
  std::reverse(sheet.line.begin() + static_cast<std::ptrdiff_t>(first), sheet.line.end());
}

bool same_headings(const sheet::Sheet& a, const sheet::SheetTable& table_a, const sheet::Sheet& b,
                   const sheet::SheetTable& table_b) {
  const auto same = [](const sheet::Heading& one, const sheet::Heading& other) {
    return one.text == other.text;
  };
  return a.decimal_comma == b.decimal_comma &&
         std::equal(table_a.headings.begin(), table_a.headings.end(), table_b.headings.begin(),
                    table_b.headings.end(), same);
}

void add_direction(sheet::Sheet& sheet, std::size_t first, int sense) {
  for (std::size_t row = 0; row < sheet.rows.size(); ++row)
    sheet.rows[row].push_back(row >= first && !sheet::is_blank(sheet.rows[row]) ? std::to_string(sense) : "");
}

}  // namespace

void join_paired_sheet(sheet::Sheet& sheet, sheet::SheetTable& table, const std::string& bytes,
                       const sheet::SheetFormat& format, bool both) {
  const DirectedName name = directed(sheet.sheet);
  if (name.sense == 0 || !table.has_headings || has_directions(table)) return;
  const auto beside = other_direction(sheet, name);
  if (!beside) return;
  sheet::SheetFormat of_other = format;
  of_other.sheet = *beside;
  sheet::Sheet other = sheet::read_sheet(bytes, sheet.file, of_other);
  sheet::SheetTable its_table = sheet::parts_of_sheet(other);
  leave_words_below(other, its_table);
  leave_invalid_rows(other, its_table);
  leave_side_statistics(other, its_table, {});
  leave_computed_rows(other, its_table);
  if (both && !same_headings(sheet, table, other, its_table))
    throw text::InputError(
        {sheet.file, sheet.line[table.heading_row]}, *beside,
        fmt::format(
            "the sheets \"{}\" and \"{}\" are the two directions of one axis, and their headings are not "
            "equal: make them equal, or read each sheet with its own command (--sheet \"{}\", --sheet "
            "\"{}\")",
            sheet.sheet, *beside, sheet.sheet, *beside));
  // The rows of the sheet forth show the way; the axis moved the other way in the sheet back.
  const int forth = name.sense > 0 ? order_of(sheet, table) : order_of(other, its_table);
  const bool way = name.way || directed(*beside).way;
  const int sense = way && forth < 0 ? -name.sense : name.sense;
  if (order_of(sheet, table) == -sense) turn_rows(sheet, table.first_data);
  if (order_of(other, its_table) == sense) turn_rows(other, its_table.first_data);
  add_direction(sheet, table.first_data, sense);
  table.headings.push_back(heading_of_directions());
  sheet.written.clear();
  sheet.notes.push_back(
      fmt::format("the name of the sheet \"{}\" states the approach direction {} of its rows", sheet.sheet,
                  sense > 0 ? "+" : "-"));
  if (!both) return;
  add_direction(other, its_table.first_data, -sense);
  for (std::size_t row = its_table.first_data; row < other.rows.size(); ++row) {
    other.rows[row].resize(table.headings.size());
    sheet.rows.push_back(std::move(other.rows[row]));
    sheet.line.push_back(other.line[row]);
  }
  for (const std::string& note : other.notes)
    sheet.notes.push_back(fmt::format("sheet \"{}\": {}", *beside, note));
  sheet.exact.insert(other.exact.begin(), other.exact.end());
  std::erase(sheet.tables_beside, *beside);
  std::erase_if(sheet.elsewhere, [&](const sheet::TextElsewhere& one) { return one.sheet == *beside; });
  sheet.notes.push_back(
      fmt::format("the rows of the sheet \"{}\" are added, with the approach direction {}; if "
                  "the two sheets do not belong together, give --sheet \"{}\"",
                  *beside, sense > 0 ? "-" : "+", sheet.sheet));
}

}  // namespace vernier::importer
