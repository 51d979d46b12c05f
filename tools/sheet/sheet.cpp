// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/sheet/sheet.h"

#include <fmt/format.h>

#include <algorithm>
#include <iterator>
#include <map>
#include <string_view>

#include "tools/sheet/ditto.h"
#include "tools/sheet/sheet_number.h"
#include "tools/text/csv.h"
#include "tools/text/error.h"
#include "tools/text/numbers.h"
#include "tools/text/words.h"

namespace vernier::sheet {
namespace {

void repeat_above_ditto_marks_of(Sheet& sheet) {
  std::string note = repeat_above_ditto_marks(sheet.rows, sheet.line, sheet.file);
  if (!note.empty()) sheet.notes.push_back(std::move(note));
}

struct Line {
  std::string text;
  std::size_t number = 0;
};

/// A row that begins with its number: "#12;100,5". Returns the number, else 0.
std::size_t number_of_row(const std::string& bare) {
  std::size_t at = 1;
  while (at < bare.size() && at < 8 && bare[at] >= '0' && bare[at] <= '9') ++at;
  if (!bare.starts_with("#") || at == 1 || at >= bare.size()) return 0;
  const char parts = bare[at];
  if (std::string_view(";,\t| ").find(parts) == std::string_view::npos) return 0;
  // "#1 first run" is a remark; a comma or a blank separates cells only if a number follows.
  const std::size_t next = bare.find_first_not_of(" \t", at + 1);
  const bool weak = parts == ',' || parts == ' ';
  if (next == std::string::npos ||
      (weak && std::string_view("0123456789+-.,").find(bare[next]) == std::string_view::npos))
    return 0;
  return text::parse_count(std::string_view(bare).substr(1, at - 1)).value_or(0);
}

/// True if the lines "#1;…", "#2;…" are numbered rows: their numbers are one, two, three … from the first
/// one, and no other row begins with a number. Rows beside them that begin with a number are a table in which
/// rows were switched off by the sign.
bool are_numbered(const std::vector<Line>& lines, const std::vector<Line>& signed_lines) {
  std::size_t expected = 0;
  for (const Line& line : signed_lines) {
    const std::size_t number = number_of_row(text::trimmed(line.text));
    if (expected != 0 && number != expected) return false;
    expected = number + 1;
  }
  return std::none_of(lines.begin(), lines.end(), [](const Line& line) {
    const std::string bare = text::trimmed(line.text);
    return std::string_view("0123456789+-.").find(bare.front()) != std::string_view::npos;
  });
}

/// True if a cell of this line begins with a quote that the line does not close. `open`: the line begins
/// inside a quoted cell.
bool leaves_quote_open(std::string_view line, bool open) {
  bool begin = true;
  for (std::size_t at = 0; at < line.size(); ++at) {
    const char c = line[at];
    if (open && c == '"' && at + 1 < line.size() && line[at + 1] == '"')
      ++at;
    else if (open && c == '"')
      open = false;
    else if (!open && begin && c == '"')
      open = true;
    if (!open && c != ' ') begin = std::string_view(",;\t|").find(c) != std::string_view::npos;
  }
  return open;
}

std::size_t end_of_line(const std::string& text, std::size_t at) {
  return std::min(text.find_first_of("\r\n", at), text.size());
}

/// True if the part of a line before the quote that closes its first cell has the numbers of a row.
bool row_before_quote(const std::string& part) {
  return has_row_of_numbers(std::string_view(part).substr(0, part.find('"')));
}

/// The line at `at`, up to `end`, and the lines that continue a quoted cell of it, with a blank for each line
/// break. `end`: moves to the end of the last line. `number`: counts the further lines. A row of numbers is
/// no part of a cell: then the line alone, with its open quote.
std::string whole_line(const std::string& text, std::size_t at, std::size_t& end, std::size_t& number) {
  constexpr std::size_t kMostLines = 10;  // of one heading
  std::string line = text.substr(at, end - at);
  bool open = leaves_quote_open(line, false), row = false;
  std::size_t last = end, more = 0;
  std::string joined = line;
  while (open && more < kMostLines && last < text.size()) {
    const std::size_t next = last + (text.compare(last, 2, "\r\n") == 0 ? 2 : 1);
    last = end_of_line(text, next);
    const std::string part = text.substr(next, last - next);
    joined += " " + part;
    row |= row_before_quote(part);
    open = leaves_quote_open(part, true);
    ++more;
  }
  if (open || row || more == 0) return line;
  end = last;
  number += more;
  return joined;
}

/// The lines of a table without remarks. `sheet`: gets the remarks, and a note for each remark that could be
/// a row.
std::vector<Line> lines_of(const std::string& text, std::size_t skip, const std::string& comment,
                           Sheet* sheet = nullptr) {
  std::vector<Line> lines, numbered;
  std::size_t number = 0;
  for (std::size_t at = 0; at < text.size();) {
    // Old Macintosh files end their lines by a carriage return alone.
    std::size_t end = end_of_line(text, at), further = 0;
    const std::string line = whole_line(text, at, end, further);
    at = end + (text.compare(end, 2, "\r\n") == 0 ? 2 : 1);
    ++number;
    const std::size_t first = number;
    number += further;
    const std::string bare = text::trimmed(line);
    if (first <= skip && sheet != nullptr && !bare.empty()) sheet->remarks.push_back({first, bare});
    if (first <= skip || bare.empty()) continue;
    const bool remark = !comment.empty() && bare.starts_with(comment) && !begins_with_error_value(bare);
    if (remark && sheet != nullptr) sheet->remarks.push_back({first, bare.substr(comment.size())});
    if (!remark)
      lines.push_back({line, first});
    else if (comment == "#" && number_of_row(bare) > 0)
      numbered.push_back({line, first});
  }
  if (numbered.empty()) return lines;
  if (are_numbered(lines, numbered)) {
    const auto earlier = [](const Line& a, const Line& b) { return a.number < b.number; };
    std::vector<Line> all;
    std::merge(lines.begin(), lines.end(), numbered.begin(), numbered.end(), std::back_inserter(all),
               earlier);
    return all;
  }
  for (std::size_t k = 0; sheet != nullptr && k < numbered.size() && k < 5; ++k)
    sheet->notes.push_back(
        fmt::format("line {} begins with # and is left out: \"{}\"; is it a row? (--comment none)",
                    std::to_string(numbered[k].number), text::trimmed(numbered[k].text).substr(0, 30)));
  return lines;
}

/// Number of separators outside quotes. A quote opens at the begin of a cell only: 30°00'03" has seconds.
std::size_t count_outside_quotes(const std::string& line, char separator) {
  std::size_t count = 0;
  bool quoted = false;
  char before = separator;
  for (const char c : line) {
    const bool begin = std::string_view(";,|\t ").find(before) != std::string_view::npos;
    if (c == '"' && (quoted || begin || before == '"')) quoted = !quoted;
    before = c;
    if (!quoted && c == separator) ++count;
  }
  return count;
}

/// The first line of a file from a spreadsheet may give it: sep=;
char said_separator(std::vector<Line>& lines) {
  if (lines.empty() || !text::trimmed(lines.front().text).starts_with("sep=") ||
      text::trimmed(lines.front().text).size() > 5)
    return 0;
  const std::string line = lines.front().text;
  lines.erase(lines.begin());
  return line[line.find('=') + 1];
}

/// Share of the lines that have the most frequent number of separators, if that is not 0.
double agreement(const std::vector<Line>& lines, char separator) {
  std::map<std::size_t, std::size_t> counts;
  for (const Line& line : lines) ++counts[count_outside_quotes(line.text, separator)];
  std::size_t best = 0;
  for (const auto& [count, times] : counts)
    if (count > 0) best = std::max(best, times);
  return lines.empty() ? 0 : static_cast<double>(best) / static_cast<double>(lines.size());
}

/// True for a line of numbers with decimal commas and blanks between them: "100,0000   -0,0032". Each comma
/// is inside a number that has blanks on both sides.
bool is_blank_separated(const std::string& line) {
  std::size_t numbers = 0, commas = 0;
  for (const std::string& word : text::words_in(line, " \t")) {
    const bool comma = word.find(',') != std::string::npos;
    const bool number = plain_number(word, true).has_value();
    if (comma && !number) return false;
    numbers += number ? 1 : 0;
    commas += comma ? 1 : 0;
  }
  return numbers >= 2 && commas > 0;
}

/// True if the commas of the lines are decimal signs, and blanks separate the columns.
bool has_decimal_commas_and_blanks(const std::vector<Line>& lines) {
  std::size_t with_commas = 0, aligned = 0;
  for (const Line& line : lines) {
    const auto comma = line.text.find(',');
    const bool number =
        comma != std::string::npos && line.text.find_first_of("0123456789") != std::string::npos;
    with_commas += number ? 1 : 0;
    aligned += number && is_blank_separated(line.text) ? 1 : 0;
  }
  // A title may have a comma too.
  return aligned >= 2 && 10 * aligned >= 8 * with_commas && 2 * aligned >= lines.size();
}

char separator_of_lines(const std::vector<Line>& lines) {
  constexpr double kMostAgree = 0.6;  // titles and remarks above a table are lines too
  char best = ' ';
  double most = 0;
  const bool blanks = has_decimal_commas_and_blanks(lines);
  for (const char separator : {'\t', ';', ',', '|'}) {
    if (separator == ',' && blanks) continue;
    const double agree = agreement(lines, separator);
    if (agree >= kMostAgree) return separator;
    if (agree > most) {
      most = agree;
      best = separator;
    }
  }
  return most > 0.3 ? best : ' ';
}

/// As many cells in each row. One row far wider than the others would make a small file a large table.
void make_even(Sheet& sheet) {
  // Cells, and empty cells for each existing one: largest size to which a small file may grow.
  constexpr std::size_t kMostEmpty = 4u << 20, kMostEmptyForOne = 2;
  std::size_t cells = 0, widest = 0;
  for (std::size_t i = 0; i < sheet.rows.size(); ++i) {
    cells += sheet.rows[i].size();
    if (sheet.rows[i].size() > sheet.rows[widest].size()) widest = i;
  }
  if (sheet.rows.empty()) return;
  const std::size_t width = sheet.rows[widest].size();
  if (width > (kMostEmpty + (1 + kMostEmptyForOne) * cells) / sheet.rows.size())
    throw text::InputError(
        {sheet.file, sheet.line[widest]}, "",
        fmt::format("this row has {} cells, but a row of this sheet has on average {}: this is no table",
                    std::to_string(width), std::to_string(cells / sheet.rows.size())));
  for (auto& row : sheet.rows) row.resize(width);
}

/// Cells of a line of aligned text, with at least two blanks or a tab between them: headings may have words.
std::vector<std::string> aligned_cells(const std::string& line) {
  std::vector<std::string> cells;
  for (std::size_t at = 0; at < line.size();) {
    const std::size_t end = std::min({line.find("  ", at), line.find('\t', at), line.size()});
    if (std::string cell = text::trimmed(line.substr(at, end - at)); !cell.empty())
      cells.push_back(std::move(cell));
    at = std::max(end, at + 1);
    while (at < line.size() && (line[at] == ' ' || line[at] == '\t')) ++at;
  }
  return cells;
}

/// The most frequent number of cells in a line.
std::size_t usual_width(const std::vector<std::vector<std::string>>& rows) {
  std::map<std::size_t, std::size_t> count;
  for (const auto& row : rows) ++count[row.size()];
  const auto most = std::max_element(count.begin(), count.end(),
                                     [](const auto& a, const auto& b) { return a.second < b.second; });
  return most == count.end() ? 0 : most->first;
}

bool is_a_number(const std::string& cell) {
  return plain_number(cell, true).has_value() || plain_number(cell, false).has_value();
}

/// True for a title above the headings of text that is separated by blanks: no number, no row of numbers
/// directly below, and fewer words than columns; or one cell above a line of aligned cells.
bool is_title(const std::vector<Line>& lines, const std::vector<std::vector<std::string>>& rows,
              std::size_t row, std::size_t width) {
  const auto numbers = [&](std::size_t at) {
    return static_cast<std::size_t>(std::count_if(rows[at].begin(), rows[at].end(), is_a_number));
  };
  if (row + 1 >= rows.size() || numbers(row) > 0 || 2 * numbers(row + 1) >= rows[row + 1].size())
    return false;
  return rows[row].size() < width ||
         (aligned_cells(lines[row].text).size() == 1 && aligned_cells(lines[row + 1].text).size() == width);
}

void split(Sheet& sheet, const std::vector<Line>& lines) {
  std::vector<std::vector<std::string>> rows;
  for (const Line& line : lines) {
    const std::string marked = sheet.separator == ' ' ? with_quoted_ditto_marks(line.text, true) : line.text;
    rows.push_back(text::fields_of(marked, {sheet.separator, true}, {sheet.file, line.number}));
    if (rows.back().size() > kMostColumns)
      throw text::InputError(
          {sheet.file, line.number}, "",
          fmt::format(
              "{} columns separated by {}: a sheet has at most {}; split the file, or give the separator",
              std::to_string(rows.back().size()), separator_word(sheet.separator),
              std::to_string(kMostColumns)));
  }
  const std::size_t width = usual_width(rows);
  std::vector<bool> titles;
  for (std::size_t i = 0; i < rows.size(); ++i)
    titles.push_back(sheet.separator == ' ' && is_title(lines, rows, i, width));
  for (std::size_t i = 0; i < lines.size(); ++i) {
    const Line& line = lines[i];
    std::vector<std::string>& cells = rows[i];
    if (sheet.separator == ' ' && (cells.size() > width || titles[i]))
      if (std::vector<std::string> aligned = aligned_cells(line.text); aligned.size() <= width)
        cells = std::move(aligned);
    if (is_blank(cells)) continue;
    sheet.written.push_back(cells.size());
    sheet.rows.push_back(std::move(cells));
    sheet.line.push_back(line.number);
  }
  make_even(sheet);
}

/// Columns at the right that no row fills, made by trailing separators of a spreadsheet.
void drop_empty_columns(Sheet& sheet) {
  while (
      !sheet.rows.empty() && !sheet.rows.front().empty() &&
      std::all_of(sheet.rows.begin(), sheet.rows.end(), [](const auto& row) { return row.back().empty(); }))
    for (auto& row : sheet.rows) row.pop_back();
}

/// The text in the brackets of a cell; empty for other cells.
std::string in_brackets(const std::string& cell) {
  return cell.size() > 2 && cell.front() == '(' && cell.back() == ')'
             ? text::trimmed(cell.substr(1, cell.size() - 2))
             : std::string();
}

bool is_number_in_brackets(const std::string& cell) {
  const std::string value = in_brackets(cell);
  return !value.empty() && value.front() >= '0' && value.front() <= '9' && is_a_number(value);
}

/// True if the numbers in brackets among these cells are in a series of whole numbers, one after the other:
/// "(1)", "(2)", "(3)". Such numbers count columns or rows. `cells`: without empty ones.
bool count_on(const std::vector<std::string>& cells) {
  std::optional<std::size_t> before;
  for (const std::string& cell : cells) {
    const auto count = text::parse_count(in_brackets(cell));
    if (!count || (before && *count != *before + 1)) return false;
    before = count;
  }
  return true;
}

/// True if the numbers in brackets of a column are values: other numbers of the column have no brackets, or
/// the numbers in brackets do not count the rows.
bool has_accounting_values(const Sheet& sheet, std::size_t k) {
  std::vector<std::string> bracketed;
  for (const auto& row : sheet.rows) {
    if (is_a_number(row[k])) return true;
    if (is_number_in_brackets(row[k])) bracketed.push_back(row[k]);
  }
  return !count_on(bracketed);
}

/// True for a row of values: one of them has no brackets, or all have brackets and do not count the columns.
/// A row with words alone beside them is a heading.
bool has_values(const std::vector<std::string>& row) {
  if (std::any_of(row.begin(), row.end(), is_a_number)) return true;
  std::vector<std::string> bracketed;
  for (const std::string& cell : row) {
    if (cell.empty()) continue;
    if (!is_number_in_brackets(cell)) return false;
    bracketed.push_back(cell);
  }
  return !count_on(bracketed);
}

/// Negative numbers in brackets, as accounting formats write them: "(4.5)" becomes "-4.5", with a note.
void read_accounting(Sheet& sheet) {
  std::size_t read = 0;
  std::string first;
  std::map<std::size_t, bool> of_values;  // by the column
  for (auto& row : sheet.rows) {
    if (!has_values(row)) continue;
    for (std::size_t k = 0; k < row.size(); ++k) {
      if (!is_number_in_brackets(row[k])) continue;
      if (!of_values.contains(k)) of_values[k] = has_accounting_values(sheet, k);
      if (!of_values[k]) continue;
      if (++read == 1) first = row[k];
      row[k] = "-" + in_brackets(row[k]);
    }
  }
  if (read > 0)
    sheet.notes.push_back(fmt::format("{} {} such as \"{}\" {} read as negative numbers (accounting format)",
                                      std::to_string(read), read == 1 ? "cell" : "cells", first,
                                      read == 1 ? "is" : "are"));
}

void guess_decimal(Sheet& sheet) {
  std::size_t point = 0, comma = 0, either_point = 0, either_comma = 0;
  text::Place at_point, at_comma;
  std::string point_word, comma_word;
  for (std::size_t row = 0; row < sheet.rows.size(); ++row)
    for (const std::string& cell : sheet.rows[row]) switch (decimal_sign_in(cell)) {
        case DecimalSign::kPoint:
          if (++point == 1) at_point = {sheet.file, sheet.line[row]}, point_word = cell;
          break;
        case DecimalSign::kComma:
          if (++comma == 1) at_comma = {sheet.file, sheet.line[row]}, comma_word = cell;
          break;
        case DecimalSign::kEither:
          ++(cell.find(',') != std::string::npos ? either_comma : either_point);
          break;
        case DecimalSign::kNeither:
          break;
      }
  if (point > 0 && comma > 0) {
    const bool few_commas = comma < point;
    const auto count = [](std::size_t cells) {
      return fmt::format("{} {}", cells, cells == 1 ? "cell" : "cells");
    };
    throw text::InputError(
        few_commas ? at_comma : at_point, few_commas ? comma_word : point_word,
        fmt::format(
            "a decimal {} here, a decimal {} in line {} ({}); {} with a comma, {} with a point: write all "
            "numbers of the file with one decimal sign (find and replace); --decimal comma or point helps "
            "only if the other cells are in columns that are left out (--leave)",
            few_commas ? "comma" : "point", few_commas ? "point" : "comma",
            (few_commas ? at_point : at_comma).line, few_commas ? point_word : comma_word, count(comma),
            count(point)));
  }
  // Where each sign could part thousands as well ("1,234") the one that is there is taken for the decimal
  // sign.
  sheet.decimal_comma = comma > 0 || (point == 0 && either_comma > either_point);
  sheet.decimal_doubtful = point == 0 && comma == 0 && either_comma + either_point > 0;
  sheet.decimal_known = point + comma > 0;
  // Where a comma parts the columns it is no decimal sign of an unquoted cell.
  if (sheet.separator == ',' && comma == 0) sheet.decimal_comma = false;
}

/// The decimal sign of the cells that are text. The numbers of a workbook have none; they get the same sign,
/// so that one rule reads all cells.
void settle_decimal(Sheet& sheet, const std::vector<std::vector<char>>& is_number,
                    std::optional<bool> decimal_comma) {
  Sheet texts = sheet;
  const auto each_number = [&](Sheet& of, const auto& change) {
    for (std::size_t row = 0; row < is_number.size(); ++row)
      for (std::size_t k = 0; k < is_number[row].size(); ++k)
        if (is_number[row][k] != 0) change(of.rows[row][k]);
  };
  each_number(texts, [](std::string& cell) { cell.clear(); });
  texts.separator = '\0';  // no comma separates the cells
  if (!decimal_comma) guess_decimal(texts);
  sheet.decimal_comma = decimal_comma.value_or(texts.decimal_comma);
  sheet.decimal_doubtful = !decimal_comma && texts.decimal_doubtful;
  sheet.decimal_known = decimal_comma.has_value() || texts.decimal_known;
  if (sheet.decimal_comma)
    each_number(sheet, [](std::string& cell) { std::replace(cell.begin(), cell.end(), '.', ','); });
  each_number(sheet, [&](const std::string& cell) {
    if (cell.find_first_of(".,") != std::string::npos) sheet.exact.insert(cell);
  });
}

/// A cell that makes its row a remark. In a workbook "#1" numbers a row: nobody switches rows off by it.
bool is_remark(const std::string& cell, const std::string& comment) {
  if (comment.empty() || !cell.starts_with(comment) || begins_with_error_value(cell)) return false;
  return comment != "#" || cell.size() == 1 || !text::parse_count(std::string_view(cell).substr(1));
}

void read_from_workbook(Sheet& sheet, const std::string& bytes, const SheetFormat& format) {
  WorkbookSheet read = read_workbook(bytes, sheet.file, format.sheet);
  sheet.workbook = true;
  sheet.sheet = read.name;
  sheet.sheets = std::move(read.all);
  sheet.elsewhere = std::move(read.elsewhere);
  sheet.tables_beside = std::move(read.tables_beside);
  if (read.hidden_rows > 0)
    sheet.notes.push_back(
        fmt::format("{} hidden rows are read as well; delete the rows that do not belong to the table",
                    std::to_string(read.hidden_rows)));
  if (!read.unread.empty()) {
    constexpr std::size_t kShown = 12;  // texts
    const std::size_t more = read.unread.size() > kShown ? read.unread.size() - kShown : 0;
    read.unread.resize(read.unread.size() - more);
    sheet.notes.push_back(
        fmt::format("in the workbook, but not read: {}{}. Does one of these change values, their sign "
                    "(--sign) or unit, or "
                    "mean that a row does not count? Then change the file accordingly",
                    text::joined(read.unread, ", "), more > 0 ? fmt::format(" and {} more", more) : ""));
  }
  sheet.formats = std::move(read.formats);
  std::vector<std::vector<char>> is_number;
  for (std::size_t i = 0; i < read.rows.size(); ++i) {
    if (read.line[i] <= format.skip || is_remark(read.rows[i].front(), format.comment)) {
      sheet.remarks.push_back({read.line[i], text::joined(read.rows[i], " ")});
      continue;
    }
    sheet.rows.push_back(std::move(read.rows[i]));
    sheet.line.push_back(read.line[i]);
    is_number.push_back(std::move(read.is_number[i]));
  }
  make_even(sheet);
  read_accounting(sheet);
  settle_decimal(sheet, is_number, format.decimal_comma);
  repeat_above_ditto_marks_of(sheet);
}

}  // namespace

bool begins_with_error_value(const std::string& line) {
  for (const char* word : {"#REF!", "#N/A", "#DIV/0!", "#VALUE!", "#NAME?", "#NUM!", "#NULL!", "#NV",
                           "#BEZUG!", "#WERT!", "#ZAHL!"})
    if (line.starts_with(word)) return true;
  return false;
}

bool is_blank(const std::vector<std::string>& row) {
  return std::all_of(row.begin(), row.end(), [](const std::string& cell) { return cell.empty(); });
}

void remove_row(Sheet& sheet, std::size_t row) {
  const auto at = static_cast<std::ptrdiff_t>(row);
  sheet.rows.erase(sheet.rows.begin() + at);
  sheet.line.erase(sheet.line.begin() + at);
  if (!sheet.written.empty()) sheet.written.erase(sheet.written.begin() + at);
}

bool is_workbook(std::string_view bytes) { return bytes.starts_with("PK\x03\x04"); }

char guess_separator(const std::string& text, const std::string& comment) {
  std::vector<Line> lines = lines_of(with_quoted_ditto_marks(text), 0, comment);
  const char said = said_separator(lines);
  return said != 0 ? said : separator_of_lines(lines);
}

const char* separator_word(char separator) {
  switch (separator) {
    case ',':
      return "comma";
    case ';':
      return "semicolon";
    case '\t':
      return "tab";
    case '|':
      return "bar";
    default:
      return "blanks";
  }
}

namespace {

/// Refuses files that only have the name of a table: pages and documents that programs save as .xls.
void refuse_document(const std::string& text, const std::string& file) {
  const std::size_t begin = std::min(text.find_first_not_of(" \t\r\n"), text.size());
  const std::string head = text::in_small_letters(text.substr(begin, 2000));
  const auto begins = [&](const char* with) { return head.starts_with(with); };
  const auto refuse = [&](const char* kind) {
    throw text::InputError(
        {file, 1}, "",
        fmt::format(
            "the file is {}: open it in the spreadsheet program, save it as .xlsx or as CSV, and import "
            "the saved file",
            kind));
  };
  const bool xml = begins("<?xml") || begins("<workbook");
  if (xml && head.find("urn:schemas-microsoft-com:office:spreadsheet") != std::string::npos)
    refuse("a workbook as XML (XML Spreadsheet 2003)");
  if (begins("<!doctype html") || begins("<html") || begins("<table") || begins("<head") || begins("<meta") ||
      (xml && head.find("<html") != std::string::npos))
    refuse("a web page (HTML) with a table, which some programs save with the ending .xls");
  if (begins("%pdf")) refuse("a document (PDF) and not a table");
  if (begins("{\\rtf")) refuse("a text document (RTF) and not a table");
}

}  // namespace

Sheet read_sheet(const std::string& bytes, const std::string& file, const SheetFormat& format) {
  Sheet sheet;
  sheet.file = file;
  if (bytes.starts_with("\xD0\xCF\x11\xE0"))
    throw text::InputError({file, 0}, "", "a workbook of the old kind (.xls): save it as .xlsx or as CSV");
  if (is_workbook(bytes)) {
    read_from_workbook(sheet, bytes, format);
  } else {
    sheet.encoding = encoding_of(bytes);
    if (mixes_encodings(bytes))
      sheet.notes.emplace_back(
          "the file has lines in UTF-8 and lines in Windows-1252: each line is read in its own encoding");
    const std::string text = text::with_plain_blanks(text::without_invisible(utf8_of(bytes, sheet.encoding)));
    if (text.find('\0') != std::string::npos)
      throw text::InputError({file, 0}, "",
                             "the file has bytes of value 0: it is neither a text nor a workbook (.xlsx)");
    refuse_document(text, file);
    std::vector<Line> lines = lines_of(with_quoted_ditto_marks(text), format.skip, format.comment, &sheet);
    const char said = said_separator(lines);
    sheet.separator = format.separator != 0 ? format.separator : said != 0 ? said : separator_of_lines(lines);
    split(sheet, lines);
    drop_empty_columns(sheet);
    repeat_above_ditto_marks_of(sheet);
    read_accounting(sheet);
    if (format.decimal_comma) {
      sheet.decimal_comma = *format.decimal_comma;
      sheet.decimal_known = true;
    } else {
      guess_decimal(sheet);
    }
  }
  if (sheet.rows.empty()) throw text::InputError({file, 0}, "", "no rows");
  return sheet;
}

std::optional<double> number_at(const Sheet& sheet, std::size_t row, std::size_t column) {
  const auto number = plain_number(sheet.rows[row][column], sheet.decimal_comma);
  return number ? text::parse_number(*number) : std::nullopt;
}

}  // namespace vernier::sheet
