// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/import/tables/directions.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <map>
#include <optional>
#include <set>
#include <string>
#include <utility>

#include "tools/format/columns.h"
#include "tools/import/columns/column_guess.h"
#include "tools/import/order/row_order.h"
#include "tools/import/words/sheet_words.h"
#include "tools/sheet/sheet.h"
#include "tools/text/words.h"

namespace vernier::importer {
namespace {

/// Two codes of a column of directions, in small letters: that of increasing positions first.
struct Codes {
  std::string up, down;
  bool usual = true;      // false: only the positions can decide
  bool doubtful = false;  // the usual meaning is often another one
};

constexpr std::size_t kMostRuns = 40;  // different names of runs; more are names of points

std::string code_of(const std::string& cell) {
  std::string code = text::in_small_letters(cell);
  while (code.ends_with('.')) code.pop_back();
  return code;
}

/// The meaning of two codes; nullopt for signs, which need no decision, and for codes that no list has.
std::optional<Codes> meaning_of(const std::set<std::string>& codes) {
  static const std::array<Codes, 11> kPairs = {{{"v", "r"},
                                                {"v", "z"},
                                                {"h", "r"},
                                                {"h", "z"},
                                                {"f", "b"},
                                                {"f", "r"},
                                                {"1", "0", true, true},
                                                {"1", "2", true, true},
                                                {"re", "li", false},
                                                {"r", "l", false},
                                                {"rechts", "links", false}}};
  if (codes.size() != 2) return std::nullopt;
  const std::string &a = *codes.begin(), &b = *codes.rbegin();
  for (const Codes& pair : kPairs)
    if (codes == std::set<std::string>{pair.up, pair.down}) return pair;
  if (codes == std::set<std::string>{"left", "right"}) return Codes{"right", "left", false};
  static const std::set<std::string> kSigns = {"+",        "-",       "1",       "-1",   "+1",    "\u2212",
                                               "\u22121",  "pos",     "neg",     "plus", "minus", "positive",
                                               "negative", "positiv", "negativ", "up",   "down",  "auf",
                                               "ab",       "\u2191",  "\u2193"};
  if (kSigns.contains(a) || kSigns.contains(b) || sense_said(a) * sense_said(b) != -1) return std::nullopt;
  return sense_said(a) > 0 ? Codes{a, b} : Codes{b, a};
}

/// Steps from row to row with one code, by the direction of the motion.
struct Steps {
  std::size_t up = 0, down = 0;
  /// 1, -1: nearly all steps go in one direction. A table of several lines steps back at the end of each
  /// line.
  int direction() const {
    constexpr std::size_t kFewest = 2, kTimes = 3;  // steps in all; times as many in the one direction
    if (up + down < kFewest) return 0;
    return up > kTimes * down ? 1 : down > kTimes * up ? -1 : 0;
  }
};

std::map<std::string, Steps> steps_of(const sheet::Sheet& sheet, const sheet::SheetTable& table,
                                      std::size_t position, std::size_t code) {
  std::map<std::string, Steps> steps;
  std::optional<std::size_t> before;
  for (std::size_t row = table.first_data; row < sheet.rows.size(); ++row) {
    if (sheet::is_blank(sheet.rows[row])) continue;
    const auto here = sheet::number_at(sheet, row, position);
    if (before && here && code_of(sheet.rows[*before][code]) == code_of(sheet.rows[row][code])) {
      Steps& of = steps[code_of(sheet.rows[row][code])];
      const auto there = sheet::number_at(sheet, *before, position);
      of.up += there && *here > *there ? 1 : 0;
      of.down += there && *here < *there ? 1 : 0;
    }
    before = row;
  }
  return steps;
}

void write_directions(sheet::Sheet& sheet, const sheet::SheetTable& table, std::size_t column,
                      const Codes& codes) {
  for (std::size_t row = table.first_data; row < sheet.rows.size(); ++row) {
    std::string& cell = sheet.rows[row][column];
    if (code_of(cell) == codes.up)
      cell = "1";
    else if (code_of(cell) == codes.down)
      cell = "-1";
  }
}

/// 1, -1: the direction of the motion with all codes of this sense; 0: the rows do not show one.
int shown_direction(const std::map<std::string, Steps>& steps, int sense) {
  Steps all;
  for (const auto& [code, of] : steps) {
    const int said = code == "1" ? 1 : code == "-1" ? -1 : sense_said(code);
    if (said != sense) continue;
    all.up += of.up;
    all.down += of.down;
  }
  return all.direction();
}

/// Directions by signs or by words such as up and down, which contradict the order of the positions. Signs of
/// both directions are a doubt of the column, unless the user assigned it; otherwise the sheet gets a note.
void judge_signs(sheet::Sheet& sheet, const sheet::SheetTable& table, std::vector<SheetColumn>& columns,
                 std::size_t position, std::size_t k) {
  const std::map<std::string, Steps> steps = steps_of(sheet, table, position, k);
  const int up = shown_direction(steps, 1), down = shown_direction(steps, -1);
  // A table that is sorted by the position has one order in both directions, and shows none.
  if (up >= 0 && down <= 0) return;
  if (up == down) return;
  const std::string &heading = table.headings[k].text, &axis = columns[position].name;
  std::string codes;
  for (const auto& [code, of] : steps) codes += (codes.empty() ? "" : ", ") + code;
  const std::string order =
      fmt::format("the directions ({}) contradict the order of the rows: the positions of {} {}", codes, axis,
                  up < 0 ? "decrease from row to row in the direction + (up)"
                         : "increase from row to row in the direction - (down)");
  const bool own_name = heading == columns[k].name;
  if (up * down != -1 || columns[k].why != "by its heading" || own_name) {
    sheet.notes.push_back(fmt::format(
        "\"{}\": {}; the directions are used as written, + is the approach toward larger positions; if "
        "this is wrong, exchange + and - in this column, or leave it out (--leave \"{}\")",
        heading, order, heading));
    return;
  }
  columns[k].doubt_place = {sheet.file, sheet.line[table.heading_row]};
  columns[k].doubt_word = heading;
  columns[k].doubt = fmt::format(
      "{}; exchange the two directions in the file, or leave the column out (--leave \"{}\"); if the "
      "directions are right and the rows are sorted, give --column \"{}={}\"",
      order, heading, columns[k].name, heading);
}

/// Rows one after the other with one code whose positions go in one direction: a block ends where the code or
/// the motion reverses. Counts of the blocks that agree with their code, and that contradict it.
struct Blocks {
  std::size_t agreeing = 0, against_up = 0, against_down = 0;
  std::size_t line = 0;  // of the first row of the first block that contradicts
  /// Some runs have their directions exchanged. In a table that is sorted by the position, only the blocks
  /// of one direction contradict.
  bool mixed() const { return agreeing > 0 && against_up > 0 && against_down > 0; }
};

int sense_of_code(const std::string& code) { return code == "1" ? 1 : code == "-1" ? -1 : sense_said(code); }

Blocks blocks_of(const sheet::Sheet& sheet, const sheet::SheetTable& table, std::size_t position,
                 std::size_t k) {
  constexpr std::size_t kFewest = 2;  // steps; one step may be the way back to the next line of points
  Blocks blocks;
  std::size_t begin = 0, steps = 0;
  std::size_t still = 0;  // the last row without a motion since the row before it
  int motion = 0, sense = 0;
  std::optional<double> before;
  const auto close = [&] {
    if (steps < kFewest || sense == 0) return;
    blocks.agreeing += motion == sense ? 1 : 0;
    if (motion == sense) return;
    ++(sense > 0 ? blocks.against_up : blocks.against_down);
    if (blocks.line == 0) blocks.line = sheet.line[begin];
  };
  for (std::size_t row = table.first_data; row < sheet.rows.size(); ++row) {
    const auto here = sheet::number_at(sheet, row, position);
    if (sheet::is_blank(sheet.rows[row]) || !here) continue;
    const int said = sense_of_code(code_of(sheet.rows[row][k]));
    const int moved = !before ? 0 : *here > *before ? 1 : *here < *before ? -1 : 0;
    const std::size_t first = said == sense && still + 1 == row ? still : row;  // of a block that begins here
    if (moved == 0) still = row;
    before = here;
    if (said == sense && (moved == 0 || motion == 0 || moved == motion)) {
      steps += moved != 0 ? 1 : 0;
      motion = moved != 0 ? moved : motion;
      continue;
    }
    close();
    begin = first;
    motion = said == sense ? moved : 0;
    steps = motion != 0 ? 1 : 0;
    sense = said;
  }
  close();
  return blocks;
}

/// Directions that contradict the order of the rows in some runs only: a doubt, unless the user assigned the
/// column.
void judge_runs(sheet::Sheet& sheet, const sheet::SheetTable& table, std::vector<SheetColumn>& columns,
                std::size_t position, std::size_t k) {
  const Blocks blocks = blocks_of(sheet, table, position, k);
  if (!blocks.mixed() || !columns[k].doubt.empty()) return;
  const std::string& heading = table.headings[k].text;
  const std::string order = fmt::format(
      "the directions contradict the order of the rows in {} of {} runs, first in line {}: the positions of "
      "{} "
      "go the other way there",
      blocks.against_up + blocks.against_down, blocks.agreeing + blocks.against_up + blocks.against_down,
      std::to_string(blocks.line), columns[position].name);
  if (columns[k].why != "by its heading" || heading == columns[k].name) {
    sheet.notes.push_back(fmt::format("\"{}\": {}; the directions are used as written", heading, order));
    return;
  }
  columns[k].doubt_place = {sheet.file, blocks.line};
  columns[k].doubt_word = heading;
  columns[k].doubt = fmt::format(
      "{}; exchange the two directions in these runs, or leave the column out (--leave \"{}\"); if the "
      "directions are right and the rows are sorted, give --column \"{}={}\"",
      order, heading, columns[k].name, heading);
}

/// The rows of columns of runs have the order of their directions. Another order shows that the columns were
/// joined in the order of other values than the positions: a doubt, which the user cannot confirm.
void judge_joined_runs(const sheet::Sheet& sheet, const sheet::SheetTable& table,
                       std::vector<SheetColumn>& columns, std::size_t position, std::size_t k) {
  const Blocks blocks = blocks_of(sheet, table, position, k);
  if (blocks.agreeing > 0 || blocks.line == 0) return;
  columns[k].doubt_place = {sheet.file, blocks.line};
  columns[k].doubt_word = table.headings[k].text;
  columns[k].doubt = fmt::format(
      "the directions of the runs contradict the order of the positions of {0}: the rows of a run were not "
      "ordered by \"{1}\"; move the column \"{1}\" to the left of all other columns",
      columns[position].name, table.headings[position].text);
}

RowOrder order_of(const sheet::SheetTable& table, const std::vector<SheetColumn>& columns,
                  std::size_t position, std::size_t direction) {
  const SheetWishes usual;
  const Guess guess(usual);
  RowOrder order{table.first_data, position, direction, {}};
  for (std::size_t other = 0; other < columns.size(); ++other)
    if (other != position && columns[other].use == SheetColumn::Use::kColumn &&
        (guess.is_axis(columns[other].name) || columns[other].name == format::columns::kSetup))
      order.others.push_back(other);
  return order;
}

/// One direction in all rows of a motion out and back, and a change of the direction at another row than the
/// turn of the motion: a doubt if only this axis moves and the column has its meaning by its heading,
/// otherwise a note.
void judge_order(sheet::Sheet& sheet, const sheet::SheetTable& table, std::vector<SheetColumn>& columns,
                 std::size_t position, std::size_t k) {
  if (!columns[k].doubt.empty()) return;
  const DirectionDoubt doubt =
      doubt_of_directions(sheet, order_of(table, columns, position, k),
                          [](const std::string& cell) { return sense_of_code(code_of(cell)); });
  if (doubt.kind == DirectionDoubt::Kind::kNone) return;
  const bool same = doubt.kind == DirectionDoubt::Kind::kSame;
  const std::string &heading = table.headings[k].text, &axis = columns[position].name;
  const std::string words = fmt::format(
      "{}, and the positions of {} go the other way in {}",
      same ? fmt::format("all rows have the same direction ({})",
                         sheet.rows[table.first_data][k] == "1" ? "+" : sheet.rows[table.first_data][k])
           : std::string("the direction changes at another row than the motion"),
      axis, lines_text(doubt.lines));
  if (!doubt.certain || columns[k].why != "by its heading" || heading == columns[k].name) {
    sheet.notes.push_back(fmt::format("\"{}\": {}; the directions are used as written", heading, words));
    return;
  }
  columns[k].doubt_place = {sheet.file, doubt.lines.front()};
  columns[k].doubt_word = heading;
  columns[k].doubt = fmt::format(
      "{}; correct the directions in these rows, or leave the column out (--leave \"{}\"); if each row "
      "was approached in its written direction, give --column \"{}={}\"",
      words, heading, columns[k].name, heading);
}

/// Rows whose direction differs from those of the rows above and below, where the positions go on in one
/// direction, and the number of the other steps that agree with the direction of their row.
struct SingleRows {
  std::vector<std::size_t> lines;
  std::size_t agreeing = 0;
};

SingleRows single_rows_of(const sheet::Sheet& sheet, const RowOrder& order) {
  std::vector<std::size_t> rows;
  for (std::size_t row = order.first_data; row < sheet.rows.size(); ++row)
    if (!sheet::is_blank(sheet.rows[row])) rows.push_back(row);
  const auto sense = [&](std::size_t at) {
    return sense_of_code(code_of(sheet.rows[rows[at]][order.direction]));
  };
  /// Direction of the motion to the row `at`; 0 if another axis moves as well.
  const auto motion = [&](std::size_t at) {
    const auto &before = sheet.rows[rows[at - 1]], &here = sheet.rows[rows[at]];
    for (const std::size_t other : order.others)
      if (before[other] != here[other]) return 0;
    const auto from = sheet::number_at(sheet, rows[at - 1], order.position),
               to = sheet::number_at(sheet, rows[at], order.position);
    return !from || !to ? 0 : *to > *from ? 1 : *to < *from ? -1 : 0;
  };
  SingleRows found;
  for (std::size_t at = 1; at < rows.size(); ++at) {
    const int own = sense(at), moved = motion(at);
    if (own == 0 || moved == 0) continue;
    if (own == moved)
      ++found.agreeing;
    else if (at + 1 < rows.size() && motion(at + 1) == moved && sense(at - 1) == -own &&
             sense(at + 1) == -own)
      found.lines.push_back(sheet.line[rows[at]]);
  }
  return found;
}

/// A single row with the other direction inside a motion in one direction: a doubt, unless the user assigned
/// the column.
void judge_single_rows(sheet::Sheet& sheet, const sheet::SheetTable& table, std::vector<SheetColumn>& columns,
                       std::size_t position, std::size_t k) {
  constexpr std::size_t kTimes = 3;  // steps that agree for each row that does not: else the rows are sorted
  if (!columns[k].doubt.empty()) return;
  const SingleRows single = single_rows_of(sheet, order_of(table, columns, position, k));
  if (single.lines.empty() || single.agreeing < kTimes * single.lines.size()) return;
  const std::string& heading = table.headings[k].text;
  const std::string words = fmt::format(
      "the direction in {} differs from the rows above and below, and the positions of {} go on in one "
      "direction",
      lines_text(single.lines), columns[position].name);
  if (columns[k].why != "by its heading" || heading == columns[k].name) {
    sheet.notes.push_back(fmt::format("\"{}\": {}; the directions are used as written", heading, words));
    return;
  }
  columns[k].doubt_place = {sheet.file, single.lines.front()};
  columns[k].doubt_word = heading;
  columns[k].doubt = fmt::format(
      "{}; correct the direction, or leave the column out (--leave \"{}\"); if each row was approached in "
      "its "
      "written direction, give --column \"{}={}\"",
      words, heading, columns[k].name, heading);
}

void settle_column(sheet::Sheet& sheet, const sheet::SheetTable& table, std::vector<SheetColumn>& columns,
                   std::size_t k, bool unfolded) {
  const std::string axis =
      columns[k].name.substr(std::string(format::entry_of(format::AxisQuantity::kSense).prefix).size());
  const auto position = std::find_if(columns.begin(), columns.end(), [&](const SheetColumn& one) {
    return one.use == SheetColumn::Use::kColumn && one.name == axis;
  });
  std::set<std::string> found;
  for (std::size_t row = table.first_data; row < sheet.rows.size(); ++row)
    if (!sheet::is_blank(sheet.rows[row])) found.insert(code_of(sheet.rows[row][k]));
  // A column with the name of the measurement file keeps its numbers.
  std::optional<Codes> codes = table.headings[k].text == columns[k].name ? std::nullopt : meaning_of(found);
  if (!codes) {
    if (position == columns.end()) return;
    if (unfolded)
      return judge_joined_runs(sheet, table, columns, static_cast<std::size_t>(position - columns.begin()),
                               k);
    judge_signs(sheet, table, columns, static_cast<std::size_t>(position - columns.begin()), k);
    judge_runs(sheet, table, columns, static_cast<std::size_t>(position - columns.begin()), k);
    judge_order(sheet, table, columns, static_cast<std::size_t>(position - columns.begin()), k);
    judge_single_rows(sheet, table, columns, static_cast<std::size_t>(position - columns.begin()), k);
    return;
  }
  const std::string& heading = table.headings[k].text;
  int shown = 0;
  if (position != columns.end()) {
    std::map<std::string, Steps> steps =
        steps_of(sheet, table, static_cast<std::size_t>(position - columns.begin()), k);
    const int up = steps[codes->up].direction(), down = steps[codes->down].direction();
    shown = up * down == -1 ? up : 0;
  }
  if (shown == 0 && !codes->usual) return;
  const bool exchanged = shown < 0;
  if (exchanged) std::swap(codes->up, codes->down);
  if (exchanged || (shown != 0 && !codes->usual))
    sheet.notes.push_back(
        fmt::format("\"{}\": {} is the direction of increasing positions of {}, by the order of "
                    "the positions in the rows",
                    heading, codes->up, axis));
  else if (shown == 0 && codes->doubtful)
    sheet.notes.push_back(fmt::format(
        "\"{}\": {} is read as the direction of increasing positions of {}, {} as the other one, and "
        "the order of the positions does not show the direction; if this is wrong, write + and - in "
        "this column",
        heading, codes->up, axis, codes->down));
  write_directions(sheet, table, k, *codes);
  if (position == columns.end()) return;
  judge_runs(sheet, table, columns, static_cast<std::size_t>(position - columns.begin()), k);
  judge_order(sheet, table, columns, static_cast<std::size_t>(position - columns.begin()), k);
  judge_single_rows(sheet, table, columns, static_cast<std::size_t>(position - columns.begin()), k);
}

/// "1+", "2 hin" or "Lauf 1 +": the run and the direction; nullopt for other texts.
std::optional<std::pair<std::string, std::string>> run_and_direction(std::string cell) {
  const std::string_view digits = "0123456789";
  static const std::set<std::string> kRuns = {"lauf",      "run",  "messlauf", "messreihe",
                                              "durchgang", "pass", "zyklus",   "cycle"};
  if (const std::size_t first = cell.find_first_of(digits);
      first != std::string::npos && kRuns.contains(code_of(text::trimmed(cell.substr(0, first)))))
    cell.erase(0, first);
  std::size_t end = 0;
  while (end < cell.size() && digits.find(cell[end]) != std::string_view::npos) ++end;
  if (end == 0 || end == cell.size()) return std::nullopt;
  const std::string rest = text::trimmed(cell.substr(end));
  static const std::set<std::string> kLetters = {"v", "r", "h", "z"};
  if (digits.find(rest.front()) != std::string_view::npos) return std::nullopt;
  if (sense_said(rest) == 0 && !kLetters.contains(code_of(rest))) return std::nullopt;
  return std::pair(cell.substr(0, end), rest);
}

bool names(const sheet::Heading& heading, bool (*says)(const SheetColumn&)) {
  return says(Guess(SheetWishes()).column(heading));
}

}  // namespace

void split_runs(sheet::Sheet& sheet, sheet::SheetTable& table) {
  if (!table.has_headings) return;
  std::optional<std::size_t> runs;
  for (std::size_t k = 0; k < table.headings.size(); ++k) {
    if (names(table.headings[k], [](const SheetColumn& one) { return is_sense(one.name); })) return;
    if (names(table.headings[k], [](const SheetColumn& one) { return one.name == format::columns::kRun; }))
      runs = k;
  }
  if (!runs) return;
  std::set<std::string> directions;
  for (std::size_t row = table.first_data; row < sheet.rows.size(); ++row) {
    if (sheet.rows[row][*runs].empty()) continue;
    const auto both = run_and_direction(sheet.rows[row][*runs]);
    if (!both) return;
    directions.insert(both->second);
  }
  if (directions.size() != 2) return;
  std::string before;
  for (std::size_t row = 0; row < sheet.rows.size(); ++row) {
    std::string direction;
    std::string& cell = sheet.rows[row][*runs];
    if (row >= table.first_data && !sheet::is_blank(sheet.rows[row])) {
      if (const auto both = run_and_direction(cell)) {
        cell = both->first;
        before = both->second;
      }
      direction = before;
    }
    sheet.rows[row].push_back(std::move(direction));
  }
  table.headings.push_back(heading_of_directions());
  sheet.notes.push_back(
      fmt::format("\"{}\" has the run and the approach direction in one cell: they are read as "
                  "two columns",
                  table.headings[*runs].text));
}

namespace {

/// The axis that a column of directions is of: the one in its heading, or the only one of the table; empty:
/// open.
std::string axis_of_directions(const std::string& heading, const std::vector<SheetColumn>& columns) {
  const SheetWishes usual;
  const Guess guess(usual);
  std::set<std::string> axes, named;
  for (const SheetColumn& column : columns)
    if (column.use == SheetColumn::Use::kColumn && guess.is_axis(column.name)) axes.insert(column.name);
  for (const std::string& word : text::words_in(heading, " _-.()[]"))
    if (axes.contains(word)) named.insert(word);
  const std::set<std::string>& of = named.empty() ? axes : named;
  return of.size() == 1 ? *of.begin() : "";
}

/// Notes a column of words that looks like approach directions, if the table has no column of directions.
void note_direction_not_read(sheet::Sheet& sheet, const sheet::SheetTable& table,
                             const std::vector<SheetColumn>& columns) {
  for (const SheetColumn& column : columns)
    if (column.use == SheetColumn::Use::kColumn && is_sense(column.name)) return;
  for (std::size_t k = 0; k < columns.size(); ++k) {
    if (columns[k].use != SheetColumn::Use::kColumn || !(columns[k].words || is_label(columns[k].name)))
      continue;
    std::set<std::string> codes, ends;
    for (std::size_t row = table.first_data; row < sheet.rows.size() && codes.size() <= kMostRuns; ++row) {
      const std::string code = code_of(sheet.rows[row][k]);
      if (code.empty() || !codes.insert(code).second) continue;
      ends.insert(code.substr(code.find_last_of(" _") + 1));
    }
    const auto says = [](const std::string& code) { return sense_said(code) != 0; };
    const bool words = ends.size() == 2 && sense_said(*ends.begin()) * sense_said(*ends.rbegin()) == -1 &&
                       std::all_of(ends.begin(), ends.end(), says);
    const auto pair = meaning_of(ends);
    const std::string axis = axis_of_directions(table.headings[k].text, columns);
    if (words && !axis.empty() && codes.size() == 2 && std::all_of(codes.begin(), codes.end(), says)) {
      const bool from_first = !sheet.rows[table.first_data][k].empty();
      sheet.notes.push_back(fmt::format(
          "\"{0}\" may contain approach directions ({1}) and is not read as directions: give --column "
          "\"{2}={0}\"{3}",
          table.headings[k].text, fmt::format("{}, {}", *ends.begin(), *ends.rbegin()),
          format::axis_column(format::AxisQuantity::kSense, axis),
          from_first ? "" : "; write 0 into its empty cells if the direction is not known"));
      continue;
    }
    if (words || (pair && !pair->doubtful))
      sheet.notes.push_back(fmt::format(
          "\"{}\" may contain approach directions ({}) and is not read as directions: write them into "
          "a column of their own as + and -, with the heading Richtung",
          table.headings[k].text, fmt::format("{}, {}", *ends.begin(), *ends.rbegin())));
  }
}

/// Notes a motion of one axis out and back in a table without directions: no reversal error can be found.
void note_missing_direction(sheet::Sheet& sheet, const sheet::SheetTable& table,
                            const std::vector<SheetColumn>& columns) {
  const SheetWishes usual;
  const Guess guess(usual);
  if (std::any_of(columns.begin(), columns.end(), [](const SheetColumn& column) {
        return column.use == SheetColumn::Use::kColumn && is_sense(column.name);
      }))
    return;
  for (std::size_t k = 0; k < columns.size(); ++k) {
    if (columns[k].use != SheetColumn::Use::kColumn || !guess.is_axis(columns[k].name)) continue;
    // As if each row had the direction +: the rows on the way back contradict.
    const DirectionDoubt doubt =
        doubt_of_directions(sheet, order_of(table, columns, k, k), [](const std::string&) { return 1; });
    if (doubt.kind != DirectionDoubt::Kind::kSame || !doubt.certain) continue;
    sheet.notes.push_back(fmt::format(
        "the rows go out and back along {0} (back in {1}), and no column states the approach direction: no "
        "reversal error (backlash) can be found; add a column with the heading dir{0}, 1 in the rows out and "
        "-1 in the rows back",
        columns[k].name, lines_text(doubt.lines)));
  }
}

}  // namespace

void settle_directions(sheet::Sheet& sheet, const sheet::SheetTable& table, std::vector<SheetColumn>& columns,
                       bool unfolded) {
  const std::size_t notes = sheet.notes.size();
  note_direction_not_read(sheet, table, columns);
  if (!unfolded && sheet.notes.size() == notes) note_missing_direction(sheet, table, columns);
  for (std::size_t k = 0; k < columns.size(); ++k)
    if (columns[k].use == SheetColumn::Use::kColumn && is_sense(columns[k].name))
      settle_column(sheet, table, columns, k, unfolded);
}

}  // namespace vernier::importer
