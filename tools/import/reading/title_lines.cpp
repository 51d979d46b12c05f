// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/import/reading/title_lines.h"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <optional>
#include <set>
#include <string>
#include <string_view>
#include <utility>

#include "tools/format/columns.h"
#include "tools/import/columns/column_guess.h"
#include "tools/import/reading/title_positions.h"
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
  bool way = false;  // the direction is that of the survey: "Hinfahrt"
};

/// The words of a title; a sign that joins two words ("X-Achse") or parts them (" - ") is none.
std::vector<std::string> words_of_title(const std::string& cell) {
  const auto letter = [&](std::size_t at) {
    const auto c = at < cell.size() ? static_cast<unsigned char>(cell[at]) : ' ';
    return c >= 0x80 || std::isalnum(c) != 0;
  };
  std::string text = cell;
  for (std::size_t at = 1; at + 1 < cell.size(); ++at) {
    const bool joins = letter(at - 1) && letter(at + 1), parts = cell[at - 1] == ' ' && cell[at + 1] == ' ';
    if (cell[at] == '-' && (joins || parts)) text[at] = ' ';
  }
  return words_with_signs(text);
}

/// Words that are a direction only beside another word of a title: "Pos" alone is a position.
bool needs_company(const std::string& small) {
  static const TitleWords kWords = {"+",   "-",  "pos",  "neg", "auf", "ab",  "vor", "her",
                                    "zur", "up", "down", "cw",  "ccw", "rev", "back"};
  return kWords.contains(small);
}

/// Run and direction of a title that says nothing else: "Lauf 2 rückwärts", "Run 3, backward", "Achse X
/// zurück", "X+", "Lauf 1-".
std::optional<RunTitle> run_title(const std::string& cell) {
  static const TitleWords kBeside = {"richtung", "direction", "nr", "no", "achse", "axis", "axe"};
  static const TitleWords kAxes = {"X", "Y", "Z", "A", "B", "C", "U", "V", "W"};
  RunTitle title{"", cell, 0};
  bool said = false, alone = true;
  const std::vector<std::string> words = words_of_title(cell);
  for (const std::string& word : words) {
    std::string small = text::in_small_letters(word);
    if (small.size() == 2 && (small[0] == '+' || small[0] == '-')) std::swap(small[0], small[1]);  // "+X"
    const bool sign = small.size() > 1 && (small.back() == '+' || small.back() == '-');
    const bool of_run = sign && is_run_number(small.substr(0, small.size() - 1));
    if (is_run_number(small) || of_run) {
      if (!title.run.empty() || !said || (of_run && title.sense != 0)) return std::nullopt;
      if (of_run) title.sense = small.back() == '+' ? 1 : -1;
      title.run = of_run ? small.substr(0, small.size() - 1) : small;
    } else if (says_run(small)) {
      said = true;
    } else if (sense_said(small) != 0) {
      if (title.sense != 0) return std::nullopt;
      title.sense = sense_said(small);
      title.way = says_way(small);
      alone = words.size() == 1 && needs_company(small);
    } else if (!kBeside.contains(small) && !kAxes.contains(word)) {
      return std::nullopt;
    }
  }
  if (title.run.empty() && (title.sense == 0 || alone)) return std::nullopt;
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

/// True if a cell above the headings has the letter of this axis as a word.
bool titles_name(const sheet::Sheet& sheet, const sheet::SheetTable& table, const std::string& axis) {
  for (const std::string& cell : title_cells(sheet, table))
    for (const std::string& word : heading_words(cell))
      if (word == axis) return true;
  return false;
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

std::vector<RunLine> take_run_lines(sheet::Sheet& sheet) {
  std::vector<RunLine> lines;
  std::vector<std::size_t> rows;
  bool data = false, open = false;  // a row of data before; a line without rows of data behind it
  for (std::size_t row = 0; row < sheet.rows.size(); ++row) {
    const auto filled = std::count_if(sheet.rows[row].begin(), sheet.rows[row].end(),
                                      [](const std::string& cell) { return !cell.empty(); });
    const auto cell = std::find_if(sheet.rows[row].begin(), sheet.rows[row].end(),
                                   [](const std::string& one) { return !one.empty(); });
    if (const auto title = filled == 1 ? run_title(*cell) : std::nullopt; title) {
      lines.push_back({sheet.line[row], title->text, title->run, title->sense, title->way});
      rows.push_back(row);
      open = true;
    } else if (sheet::is_row_of_data(sheet, row)) {
      if (lines.empty()) return {};  // rows that no line is about
      data = true;
      open = false;
    }
  }
  const auto differs = [&](const RunLine& one) {
    return one.run.empty() != lines.front().run.empty() || (one.sense == 0) != (lines.front().sense == 0);
  };
  if (lines.size() < 2 || !data || open || std::any_of(lines.begin(), lines.end(), differs)) return {};
  for (auto row = rows.rbegin(); row != rows.rend(); ++row) sheet::remove_row(sheet, *row);
  return lines;
}

void add_run_lines(sheet::Sheet& sheet, sheet::SheetTable& table, const std::vector<RunLine>& lines) {
  if (lines.empty()) return;
  const auto add = [&](sheet::Heading heading, const auto& value) {
    for (std::size_t row = 0; row < sheet.rows.size(); ++row) {
      const RunLine* above = nullptr;
      for (const RunLine& one : lines)
        if (one.line < sheet.line[row]) above = &one;
      const bool data = row >= table.first_data && above != nullptr && !sheet::is_blank(sheet.rows[row]);
      sheet.rows[row].push_back(data ? value(*above) : "");
    }
    table.headings.push_back(std::move(heading));
  };
  const bool run = !lines.front().run.empty(), sense = lines.front().sense != 0;
  if (sense) add(heading_of_directions(), [](const RunLine& one) { return std::to_string(one.sense); });
  if (run) add(heading_of_runs(), [](const RunLine& one) { return one.run; });
  sheet.written.clear();
  std::vector<std::string> texts;
  for (const RunLine& one : lines) texts.push_back(fmt::format("\"{}\" (line {})", one.text, one.line));
  sheet.notes.push_back(fmt::format("the lines {} state {} of the rows below them", text::joined(texts, ", "),
                                    run && sense ? "the run and the approach direction"
                                    : run        ? "the run"
                                                 : "the approach direction"));
}

namespace {

/// The direction of the motion from row to row: 1 or -1 for nearly all steps; 0: both directions, or none.
int motion_of_rows(const sheet::Sheet& sheet, const sheet::SheetTable& table, bool& both) {
  constexpr std::size_t kTimes = 3;  // as many steps in the one direction; a run begins with a step back
  const auto position = column_of_positions(table);
  std::size_t up = 0, down = 0;
  for (std::size_t row = table.first_data + 1; position && row < sheet.rows.size(); ++row) {
    const auto before = sheet::number_at(sheet, row - 1, *position),
               at = sheet::number_at(sheet, row, *position);
    if (!before || !at) continue;
    up += *at > *before ? 1 : 0;
    down += *at < *before ? 1 : 0;
  }
  const int motion = up > kTimes * down ? 1 : down > kTimes * up ? -1 : 0;
  both = motion == 0 && up + down > 0;
  return motion;
}

RunTitle run_of_titles(const sheet::Sheet& sheet, const sheet::SheetTable& table) {
  RunTitle all;
  for (const std::string& cell : title_cells(sheet, table)) {
    const auto one = run_title(cell);
    if (!one) continue;
    const bool twice = (!one->run.empty() && !all.run.empty()) || (one->sense != 0 && all.sense != 0);
    if (twice) return {};
    if (!one->run.empty()) all.run = one->run;
    if (one->sense != 0) all.sense = one->sense, all.way = one->way;
    all.text += (all.text.empty() ? "" : ", ") + one->text;
  }
  return all;
}

}  // namespace

void add_run_of_title(sheet::Sheet& sheet, sheet::SheetTable& table,
                      const std::vector<MappedColumn>& constants, bool one_of_several) {
  RunTitle all = run_of_titles(sheet, table);
  const auto stated = [&](bool (*is)(const std::string&)) {
    return has_column_of(table, is) ||
           std::any_of(constants.begin(), constants.end(), [&](const auto& one) { return is(one.name); });
  };
  const bool run =
      !all.run.empty() && !stated([](const std::string& name) { return name == format::columns::kRun; });
  bool sense = all.sense != 0 && !stated([](const std::string& name) { return is_sense(name); });
  // The only table of a file is not one of several runs.
  if (!one_of_several && all.sense == 0) return;
  bool both = false;
  const int motion = sense ? motion_of_rows(sheet, table, both) : 0;
  if (both && !one_of_several) {
    sheet.notes.push_back(
        fmt::format("the title \"{}\" states one approach direction, and the rows of the table "
                    "go in both: the title is not read as the direction of the rows",
                    all.text));
    sense = false;
  }
  if (!run && !sense) return;
  // "Hinfahrt" is the way that the rows go, as in a table with a column for each run.
  if (sense && all.way && motion != 0) all.sense = motion;
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
  const bool by_name =
      text.empty() && axis_of_title_cells(sheet, table).empty() && !titles_name(sheet, table, axis);
  for (const sheet::Heading& heading : table.headings)
    for (const std::string& word : heading_words(heading.text))
      if (by_name && word == titled) return;  // straightness: "Abweichung Y" beside "X"
  if (by_name) text = sheet.sheet;
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
      fmt::format("this {0} states the axis {1}, and the headings have the positions of {2}. If the {0} is "
                  "right, give{3}; if the headings are right, give {4}",
                  by_name ? "name of the sheet" : "title", titled, axis, by_title, by_heading));
}

void note_axis_of_name(sheet::Sheet& sheet, const sheet::SheetTable& table,
                       const std::vector<SheetColumn>& columns, const SheetWishes& wishes) {
  const std::string named = axis_of_title_cells(sheet, table).empty() ? axis_of_sheet_name(sheet) : "";
  const Guess guess(wishes);
  if (named.empty() || !guess.is_axis(named)) return;
  std::string from_name, given;
  for (std::size_t k = 0; k < columns.size(); ++k) {
    const SheetColumn& column = columns[k];
    if (column.use == SheetColumn::Use::kLeft) continue;
    if (column.name == named || reading_of(named) == column.name) {
      const std::vector<std::string> words = heading_words(text::in_small_letters(table.headings[k].text));
      if (std::find(words.begin(), words.end(), text::in_small_letters(named)) != words.end()) return;
      if (column.why == "as given") return;
      if (column.name == named && column.use == SheetColumn::Use::kColumn) from_name = table.headings[k].text;
    } else if (column.why == "as given" && guess.is_axis(column.name)) {
      given = column.name;
    }
  }
  if (!from_name.empty())
    sheet.notes.push_back(
        fmt::format("\"{}\" is the position of {}: the name of the sheet \"{}\" states this axis", from_name,
                    named, sheet.sheet));
  else if (!given.empty())
    sheet.notes.push_back(fmt::format(
        "the name of the sheet \"{}\" states the axis {}, and the columns are assigned to {}: check "
        "the axis",
        sheet.sheet, named, given));
}

}  // namespace vernier::importer
