// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/import/reading/title_lines.h"

#include <fmt/format.h>

#include <algorithm>
#include <optional>
#include <set>
#include <string>
#include <string_view>
#include <utility>

#include "tools/format/columns.h"
#include "tools/import/reading/title_positions.h"
#include "tools/import/tables/column_guess.h"
#include "tools/import/words/sheet_words.h"
#include "tools/text/error.h"
#include "tools/text/numbers.h"
#include "tools/text/words.h"

namespace vernier::importer {
namespace {

using TitleWords = std::set<std::string, std::less<>>;

struct RunTitle {
  std::string run, text;
  int sense = 0;
};

/// Run and direction of a title that says nothing else: "Lauf 2 rückwärts", "Run 3, backward", "Achse X
/// zurück".
std::optional<RunTitle> run_title(const std::string& cell) {
  static const TitleWords kBeside = {"richtung", "direction", "nr", "no", "achse", "axis", "axe"};
  static const TitleWords kAxes = {"X", "Y", "Z", "A", "B", "C", "U", "V", "W"};
  RunTitle title{"", cell, 0};
  bool said = false;
  for (const std::string& word : heading_words(cell)) {
    const std::string small = text::in_small_letters(word);
    if (is_run_number(small)) {
      if (!title.run.empty() || !said) return std::nullopt;
      title.run = small;
    } else if (says_run(small)) {
      said = true;
    } else if (sense_said(small) != 0) {
      if (title.sense != 0) return std::nullopt;
      title.sense = sense_said(small);
    } else if (!kBeside.contains(small) && !kAxes.contains(word)) {
      return std::nullopt;
    }
  }
  if (title.run.empty() && title.sense == 0) return std::nullopt;
  return title;
}

/// The title that states one axis and the position of the axis of the headings: "Achse Y bei X=250 mm".
std::string title_of_both(const sheet::Sheet& sheet, const sheet::SheetTable& table,
                          const std::string& of_headings, const SheetWishes& wishes) {
  for (const std::string& cell : title_cells(sheet, table))
    for (const TitlePosition& one : positions_in_title(cell, wishes))
      if (one.read && one.axis == of_headings) return cell;
  return "";
}

/// The cell among the titles that states the axis without a position and without the axis of the headings:
/// not "Achse Y = 250 mm", and not "parallel zur Y-Achse".
std::string title_of_axis(const sheet::Sheet& sheet, const sheet::SheetTable& table, const std::string& axis,
                          const std::string& of_headings) {
  static const TitleWords kNoMotion = {"=",        "bei",      "at",     "auf",   "on",  "zur",  "zu",
                                       "to",       "parallel", "steht",  "still", "von", "from", "along",
                                       "entlang",  "fest",     "fixed",  "und",   "and", "ohne", "without",
                                       "constant", "konstant", "offset", "über",  "mit", "with"};
  bool named = false, other = false;
  std::string found;
  for (const std::string& cell : title_cells(sheet, table)) {
    bool axis_word = false, letter = false;
    for (const std::string& word : heading_words(cell)) {
      const std::string small = text::in_small_letters(word);
      axis_word |= small == "achse" || small == "axis";
      letter |= word == axis;
      other |= word == of_headings;
      other |= kNoMotion.contains(small) || (text::parse_number(small) && letter && axis_word);
    }
    if (!axis_word && !letter) continue;
    named = true;
    if (letter) found = cell;
  }
  return named && !other ? found : "";
}

bool has_column_of(const sheet::SheetTable& table, bool (*is)(const std::string&)) {
  const SheetWishes usual;
  const Guess guess(usual);
  return std::any_of(table.headings.begin(), table.headings.end(),
                     [&](const sheet::Heading& one) { return is(guess.column(one).name); });
}

void add_title_column(sheet::Sheet& sheet, sheet::SheetTable& table, sheet::Heading heading,
                      const std::string& value) {
  for (std::size_t row = 0; row < sheet.rows.size(); ++row)
    sheet.rows[row].push_back(row >= table.first_data && !sheet::is_blank(sheet.rows[row]) ? value : "");
  table.headings.push_back(std::move(heading));
}

}  // namespace

void add_run_of_title(sheet::Sheet& sheet, sheet::SheetTable& table,
                      const std::vector<MappedColumn>& constants) {
  RunTitle all;
  for (const std::string& cell : title_cells(sheet, table)) {
    const auto one = run_title(cell);
    if (!one) continue;
    const bool twice = (!one->run.empty() && !all.run.empty()) || (one->sense != 0 && all.sense != 0);
    if (twice) return;
    if (!one->run.empty()) all.run = one->run;
    if (one->sense != 0) all.sense = one->sense;
    all.text += (all.text.empty() ? "" : ", ") + one->text;
  }
  const auto stated = [&](bool (*is)(const std::string&)) {
    return has_column_of(table, is) ||
           std::any_of(constants.begin(), constants.end(), [&](const auto& one) { return is(one.name); });
  };
  const bool run =
      !all.run.empty() && !stated([](const std::string& name) { return name == format::columns::kRun; });
  const bool sense = all.sense != 0 && !stated([](const std::string& name) { return is_sense(name); });
  if (!run && !sense) return;
  // A direction of the survey ("vorwärts") is read as that of increasing positions, as in a heading.
  if (sense) add_title_column(sheet, table, heading_of_directions(), std::to_string(all.sense));
  if (run) add_title_column(sheet, table, heading_of_runs(), all.run);
  sheet.written.clear();
  sheet.notes.push_back(
      fmt::format("the title \"{}\" states {}{}{} of this table: each row gets {}", all.text,
                  run ? "the run " + all.run : "", run && sense ? " and " : "",
                  sense ? fmt::format("the approach direction {}", all.sense > 0 ? "+" : "-") : "",
                  run && sense ? "both" : "this value"));
}

void refuse_another_axis(const sheet::Sheet& sheet, const sheet::SheetTable& table,
                         const std::vector<SheetColumn>& columns, const SheetWishes& wishes) {
  if (!table.has_headings) return;
  const std::string titled = axis_of_titles(sheet, table);
  const Guess guess(wishes);
  if (titled.empty() || !guess.is_axis(titled)) return;
  for (const MappedColumn& one : wishes.constants)
    if (guess.is_axis(one.name) && !one.of_title) return;
  std::set<std::string> axes;
  for (const SheetColumn& column : columns) {
    if (column.use == SheetColumn::Use::kLeft) continue;
    if (column.use == SheetColumn::Use::kDeviation ? column.name == titled
                                                   : reading_of(titled) == column.name)
      return;
    if (!guess.is_axis(column.name)) continue;
    if (column.why != "by its heading") return;
    axes.insert(column.name);
  }
  if (axes.size() != 1 || axes.contains(titled)) return;
  const std::string axis = *axes.begin();
  std::string text = title_of_axis(sheet, table, titled, axis);
  if (text.empty()) text = title_of_both(sheet, table, axis, wishes);
  if (text.empty()) return;
  std::string by_title, by_heading;
  for (std::size_t k = 0; k < columns.size(); ++k) {
    const SheetColumn& column = columns[k];
    const bool deviation = column.use == SheetColumn::Use::kDeviation;
    std::string name;
    if (column.use == SheetColumn::Use::kLeft) continue;
    if (column.name == axis)
      name = titled;
    else if (reading_of(axis) == column.name)
      name = reading_of(titled).value_or("");
    else if (is_sense(column.name) && column.name.ends_with(axis))
      name = column.name.substr(0, column.name.size() - axis.size()) + titled;
    if (name.empty()) continue;
    by_title +=
        fmt::format(" --{} \"{}={}\"", deviation ? "deviation" : "column", name, table.headings[k].text);
    if (!deviation && column.name == axis)
      by_heading = fmt::format("--column \"{}={}\"", axis, table.headings[k].text);
  }
  throw text::InputError(
      {sheet.file, sheet.line[table.heading_row]}, text,
      fmt::format("this title states the axis {}, and the headings have the positions of {}. If the title is "
                  "right, give{}; if the headings are right, give {}",
                  titled, axis, by_title, by_heading));
}

}  // namespace vernier::importer
