// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/import/reading/plain_cells.h"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <cstddef>
#include <optional>
#include <set>
#include <string_view>

#include "tools/format/columns.h"
#include "tools/format/units.h"
#include "tools/import/columns/column_guess.h"
#include "tools/import/words/sheet_words.h"
#include "tools/sheet/sheet_number.h"
#include "tools/text/numbers.h"
#include "tools/text/words.h"

namespace vernier::importer {
namespace {

namespace columns = format::columns;
using WordSet = std::set<std::string, std::less<>>;

bool is_named(const sheet::Heading& heading, const std::vector<std::string>& named) {
  return !heading.text.empty() && std::any_of(named.begin(), named.end(), [&](const std::string& option) {
    return option.find(heading.text) != std::string::npos;
  });
}

bool has_column(const sheet::SheetTable& table, const std::string& name) {
  const SheetWishes usual;
  const Guess guess(usual);
  return std::any_of(table.headings.begin(), table.headings.end(),
                     [&](const sheet::Heading& one) { return guess.column(one).name == name; });
}

void clear_column(sheet::Sheet& sheet, sheet::SheetTable& table, std::size_t k, const std::string& name) {
  for (std::size_t row = table.first_data; row < sheet.rows.size(); ++row) sheet.rows[row][k].clear();
  table.headings[k].name = name;
}

bool names_use(const sheet::Heading& heading) {
  static const WordSet kWords = {"verwendung", "zweck", "nutzung", "use", "usage", "purpose"};
  const std::vector<std::string> words = heading_words(text::in_small_letters(heading.name));
  return std::any_of(words.begin(), words.end(), [](const auto& word) { return kWords.contains(word); });
}

/// The coverage factor in a heading: 2 for "U (k = 2)"; nullopt if the heading states none.
std::optional<double> coverage_factor(const std::string& heading) {
  const std::string small = text::in_small_letters(heading);
  for (std::size_t at = small.find('k'); at != std::string::npos; at = small.find('k', at + 1)) {
    if (at > 0 && std::isalnum(static_cast<unsigned char>(small[at - 1])) != 0) continue;
    std::size_t begin = small.find_first_not_of(' ', at + 1);
    if (begin == std::string::npos || small[begin] != '=') continue;
    begin = small.find_first_not_of(' ', begin + 1);
    if (begin == std::string::npos) continue;
    const std::size_t end = std::min(small.find_first_not_of("0123456789.,", begin), small.size());
    std::string number = small.substr(begin, end - begin);
    std::replace(number.begin(), number.end(), ',', '.');
    if (const auto factor = text::parse_number(number); factor && *factor > 0) return factor;
  }
  return std::nullopt;
}

bool names_uncertainty(const sheet::Heading& heading) {
  const std::vector<std::string> words = heading_words(heading.name);
  return std::any_of(words.begin(), words.end(), [](const std::string& word) {
    const std::string small = text::in_small_letters(word);
    return small == columns::kUncertainty || small.ends_with("unsicherheit") || small == "uncertainty";
  });
}

/// True for the uncertainty of one coordinate: "Ux", "u_y", "U z".
bool names_uncertainty_of_coordinate(const sheet::Heading& heading) {
  std::string small = text::in_small_letters(heading.name);
  std::erase_if(small, [](char one) { return one == '_' || one == ' '; });
  const auto unit = heading.unit.empty() ? std::nullopt : format::find_unit(heading.unit);
  return unit && unit->dimension == format::Dimension::kLength && small.size() == 2 &&
         small.starts_with(columns::kUncertainty) &&
         std::string_view("xyz").find(small[1]) != std::string::npos;
}

void divide(sheet::Sheet& sheet, const sheet::SheetTable& table, std::size_t k, double factor) {
  for (std::size_t row = table.first_data; row < sheet.rows.size(); ++row)
    if (const auto value = sheet::number_at(sheet, row, k)) {
      std::string& cell = sheet.rows[row][k];
      cell = text::number_text(*value / factor);
      if (sheet.decimal_comma) std::replace(cell.begin(), cell.end(), '.', ',');
    }
}

/// The number before the sign ± of a cell; empty if the cell has not the form "3,2 ± 0,4".
std::string before_tolerance(const std::string& cell, bool decimal_comma) {
  for (const std::string_view sign : {"\u00b1", "+/-", "+-"}) {
    const std::size_t at = cell.find(sign);
    if (at == std::string::npos) continue;
    std::string value = text::trimmed(cell.substr(0, at));
    const std::string rest = text::trimmed(cell.substr(at + sign.size()));
    const auto is_number = [&](const std::string& one) {
      return sheet::plain_number(one, decimal_comma).has_value();
    };
    return is_number(value) && is_number(rest) ? value : "";
  }
  return "";
}

/// Takes the decimal sign from cells with a tolerance, if no other cell of the sheet shows the sign.
void take_decimal_sign(sheet::Sheet& sheet) {
  bool shown = false, other = false;
  for (const auto& row : sheet.rows)
    for (const std::string& cell : row) {
      const bool now = sheet::plain_number(cell, sheet.decimal_comma).has_value();
      shown |= now && !sheet::plain_number(cell, !sheet.decimal_comma);
      shown |= !before_tolerance(cell, sheet.decimal_comma).empty();
      other |= !before_tolerance(cell, !sheet.decimal_comma).empty();
    }
  if (other && !shown) sheet.decimal_comma = !sheet.decimal_comma;
}

/// Notes a column U with small values of one sign, in a table without a word of another axis U: it is an axis
/// of that name, or the expanded uncertainty.
void note_capital_u(sheet::Sheet& sheet, const sheet::SheetTable& table, std::size_t k) {
  const sheet::Heading& heading = table.headings[k];
  if (heading.name != "U" || coverage_factor(heading.text) || has_column(table, columns::kUncertainty))
    return;
  const auto known = heading.unit.empty() ? std::nullopt : format::find_unit(heading.unit);
  constexpr double kLargest_mm = 0.1;  // a larger uncertainty is no longer that of a measurement of a machine
  if (!known || known->dimension != format::Dimension::kLength) return;
  std::size_t rows = 0;
  for (std::size_t row = table.first_data; row < sheet.rows.size(); ++row) {
    const auto value = sheet::number_at(sheet, row, k);
    if (!value) continue;
    if (*value <= 0 || *value * known->factor > kLargest_mm) return;
    ++rows;
  }
  if (rows == 0) return;
  sheet.notes.push_back(
      fmt::format("\"{0}\" is read as the position of an axis U: if it is the expanded uncertainty, write U "
                  "(k=2) [{1}] as its "
                  "heading; if it is the standard uncertainty, give --column \"u={0}\"",
                  heading.text, heading.unit));
}

}  // namespace

void leave_tolerances(sheet::Sheet& sheet) {
  take_decimal_sign(sheet);
  std::string first;
  std::size_t line = 0, count = 0;
  for (std::size_t row = 0; row < sheet.rows.size(); ++row)
    for (std::string& cell : sheet.rows[row]) {
      std::string value = before_tolerance(cell, sheet.decimal_comma);
      if (value.empty()) continue;
      if (count++ == 0) first = cell, line = sheet.line[row];
      cell = std::move(value);
    }
  if (count > 0)
    sheet.notes.push_back(fmt::format(
        "line {}: \"{}\" and {} more cells have a value and its uncertainty: the value is read, and the "
        "uncertainty is left out; if it is the standard uncertainty, write it into a column u[um]",
        line, first, count - 1));
}

void leave_results(sheet::Sheet& sheet, sheet::SheetTable& table, const std::vector<std::string>& named) {
  constexpr std::size_t kMostValues = 2;  // more are a column of the table
  std::vector<std::string> omitted;
  for (std::size_t k = 0; table.has_headings && k < table.headings.size(); ++k) {
    const sheet::Heading& heading = table.headings[k];
    if (!text::trimmed(heading.text).ends_with('=') || is_named(heading, named)) continue;
    std::size_t filled = 0;
    for (std::size_t row = table.first_data; row < sheet.rows.size(); ++row)
      filled += sheet.rows[row][k].empty() ? 0 : 1;
    if (filled > kMostValues) continue;
    omitted.push_back("\"" + heading.text + "\"");
    clear_column(sheet, table, k, "result");
  }
  if (!omitted.empty())
    sheet.notes.push_back(
        fmt::format("the columns {} have results beside the rows of the table and are omitted",
                    text::joined(omitted, ", ")));
}

void settle_roles(sheet::Sheet& sheet, sheet::SheetTable& table, const std::vector<std::string>& named) {
  if (!table.has_headings || has_column(table, columns::kRole)) return;
  for (std::size_t k = 0; k < table.headings.size(); ++k) {
    const sheet::Heading& heading = table.headings[k];
    if (is_named(heading, named) || !names_use(heading)) continue;
    bool check = false, fit = false, other = false;
    for (std::size_t row = table.first_data; row < sheet.rows.size(); ++row) {
      const std::string role = role_said(sheet.rows[row][k]);
      check |= role == format::kCheckRole;
      fit |= role == format::kFitRole;
      other |= role.empty() && !is_missing(sheet.rows[row][k]);
    }
    if (!check || !fit || other) continue;
    sheet.notes.push_back(fmt::format(
        "\"{0}\" is the role of each row: the fit uses the rows with fit, and the rows with check "
        "test the model; if this is wrong, give --leave \"{0}\"",
        heading.text));
    table.headings[k].name = columns::kRole;
    return;
  }
}

void settle_uncertainties(sheet::Sheet& sheet, sheet::SheetTable& table,
                          const std::vector<std::string>& named) {
  std::vector<std::string> coordinates;
  for (std::size_t k = 0; table.has_headings && k < table.headings.size(); ++k) {
    const sheet::Heading& heading = table.headings[k];
    if (is_named(heading, named)) continue;
    if (names_uncertainty_of_coordinate(heading)) {
      coordinates.push_back(heading.text);
      clear_column(sheet, table, k, "uncertainty of a coordinate");
      continue;
    }
    note_capital_u(sheet, table, k);
    const auto factor = coverage_factor(heading.text);
    if (!factor || !names_uncertainty(heading) || has_column(table, columns::kUncertainty)) continue;
    divide(sheet, table, k, *factor);
    sheet.notes.push_back(fmt::format(
        "\"{}\" is an expanded uncertainty: its values divided by {:.4g} are the standard uncertainty u",
        heading.text, *factor));
    table.headings[k].name = columns::kUncertainty;
  }
  if (coordinates.empty()) return;
  sheet.notes.push_back(fmt::format(
      "the columns \"{}\" are uncertainties of single coordinates and are left out: a row has one standard "
      "uncertainty u; if one of them is a standard uncertainty and suits all coordinates, give --column "
      "\"u={}\"",
      text::joined(coordinates, "\", \""), coordinates.front()));
}

void note_order_of_time(sheet::Sheet& sheet, const sheet::SheetTable& table) {
  std::size_t back = 0;
  for (const sheet::Heading& heading : table.headings)
    for (const std::string& word : heading_words(heading.text))
      back += sense_said(word) < 0 && says_way(text::in_small_letters(word)) ? 1 : 0;
  if (back == 0) return;
  for (const std::string& title : title_cells(sheet, table)) {
    const std::string small = text::in_small_letters(title);
    const bool time =
        small.find("zeitlich") != std::string::npos || small.find("chronolog") != std::string::npos ||
        small.find("order of time") != std::string::npos || small.find("time order") != std::string::npos ||
        small.find("order of measurement") != std::string::npos;
    if (!time) continue;
    sheet.notes.push_back(fmt::format(
        "the title \"{}\" may state that the runs back are in the order of time: each value is read "
        "at the position in its row; if the first row of a run back is the largest position, "
        "reverse the cells of the columns of these runs in the file",
        title));
  }
}

}  // namespace vernier::importer
