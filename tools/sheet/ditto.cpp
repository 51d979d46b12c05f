// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/sheet/ditto.h"

#include <fmt/format.h>

#include <algorithm>

#include "tools/sheet/sheet_number.h"
#include "tools/text/error.h"
#include "tools/text/words.h"

namespace vernier::sheet {
namespace {

constexpr std::string_view kSeparators = ";\t|,";
constexpr std::string_view kDigits = "0123456789";

bool is_one_of(char c, std::string_view set) { return set.find(c) != std::string_view::npos; }

bool is_number(const std::string& cell) {
  return plain_number(cell, true).has_value() || plain_number(cell, false).has_value();
}

std::size_t numbers_in(const std::vector<std::string>& cells) {
  return static_cast<std::size_t>(std::count_if(
      cells.begin(), cells.end(), [](const std::string& cell) { return is_number(text::trimmed(cell)); }));
}

/// The quotes of one text, each of which is a ditto mark, or opens or closes a cell.
class Quotes {
 public:
  Quotes(const std::string& text, bool blanks) : text_(text), blanks_(blanks) {}

  std::string with_marks_in_quotes() const {
    std::string result;
    bool begin = true;  // of a cell
    for (std::size_t at = 0; at < text_.size(); ++at) {
      const char c = text_[at];
      result += c;
      if (c == '"' && begin && is_mark(at)) {
        result += "\"\"\"";
      } else if (c == '"' && begin) {
        const std::size_t close = end_of_cell(at);
        result += text_.substr(at + 1, close - at);
        at = close;
      }
      if (c != ' ' || blanks_) begin = is_one_of(c, blanks_ ? " \t\r\n" : ";\t|,\r\n");
    }
    return result;
  }

 private:
  std::size_t end_of_line(std::size_t at) const {
    return std::min(text_.find_first_of("\r\n", at), text_.size());
  }

  /// True if the cell ends at `at`: behind it are blanks, and then a separator or the end of the line.
  bool ends_cell(std::size_t at) const {
    const std::size_t next = text_.find_first_not_of(' ', at);
    if (blanks_ && next != at) return true;
    return next == std::string::npos || is_one_of(text_[next], ";\t|,\r\n");
  }

  /// Index of the quote that closes the cell which opens at `open`, or of the last sign of the line if none
  /// closes it, or if a row of numbers is before it.
  std::size_t end_of_cell(std::size_t open) const {
    const std::size_t last = std::max(end_of_line(open), open + 1) - 1;
    for (std::size_t at = open + 1; at < text_.size(); ++at) {
      if (text_[at] != '"') continue;
      if (at + 1 < text_.size() && text_[at + 1] == '"')
        ++at;
      else
        return at <= last || !holds_row(open + 1, at) ? at : last;
    }
    return last;
  }

  /// True if a line that begins behind `from` has the numbers of a row before `to`.
  bool holds_row(std::size_t from, std::size_t to) const {
    for (std::size_t at = end_of_line(from); at < to;) {
      const std::size_t end = std::min(end_of_line(at + 1), to);
      if (has_row_of_numbers(std::string_view(text_).substr(at + 1, end - at - 1))) return true;
      at = end;
    }
    return false;
  }

  /// True if the quote at the begin of a cell is alone in its cell. A quote before a separator can open a
  /// cell as well: ",5" is a number, and "; late" a remark.
  bool is_mark(std::size_t open) const {
    const std::size_t line = end_of_line(open), next = text_.find_first_not_of(' ', open + 1);
    if (blanks_) return ends_cell(open + 1);
    if (next == std::string::npos) return true;
    if (next >= line) {
      const std::size_t close = text_.find('"', line);
      return close == std::string::npos || holds_row(open + 1, close);
    }
    if (!is_one_of(text_[next], kSeparators)) return next > open + 1 && begins_blank_row(open, line);
    const std::size_t close = text_.find('"', next);
    if (close >= line || !ends_cell(close + 1)) return true;
    const std::size_t before = text_.find_last_not_of(' ', close - 1);
    if (is_one_of(text_[before], kSeparators)) return true;  // the mark of another column
    const bool digits = text_.find_first_not_of(kDigits, next + 1) == close;
    return is_one_of(text_[before], kDigits) && !(text_[next] == ',' && digits);
  }

  /// True for the quote that begins a line of numbers with blanks between them.
  bool begins_blank_row(std::size_t open, std::size_t line) const {
    if (open > 0 && !is_one_of(text_[open - 1], "\r\n")) return false;
    const std::vector<std::string> words = text::words_in(text_.substr(open + 1, line - open - 1), " \t");
    return !words.empty() && numbers_in(words) == words.size();
  }

  const std::string& text_;
  const bool blanks_;
};

bool is_ditto_mark(const std::string& cell) {
  const std::string small = text::in_small_letters(cell);
  for (const char* const mark : {"\"", "''", "„", "“", "”", "″", "〃", "-\"-", "dto.", "dto", "ditto"})
    if (small == mark) return true;
  return false;
}

}  // namespace

bool has_row_of_numbers(std::string_view line) {
  const std::string text(line);
  for (const char* const separator : {";", "\t", "|"})
    if (numbers_in(text::words_in(text, separator)) >= 2) return true;
  // Sentences have commas and blanks too.
  const std::vector<std::string> by_comma = text::words_in(text, ","), by_blank = text::words_in(text, " \t");
  const std::size_t numbers = numbers_in(by_comma);
  return (numbers >= 2 && numbers + 1 >= by_comma.size()) ||
         (by_blank.size() >= 2 && numbers_in(by_blank) == by_blank.size());
}

std::string with_quoted_ditto_marks(const std::string& text, bool blanks) {
  return Quotes(text, blanks).with_marks_in_quotes();
}

std::string repeat_above_ditto_marks(std::vector<std::vector<std::string>>& rows,
                                     const std::vector<std::size_t>& line, const std::string& file) {
  std::size_t repeated = 0, first_line = 0;
  std::string first_mark;
  for (std::size_t row = 0; row < rows.size(); ++row) {
    std::vector<std::string>& cells = rows[row];
    if (std::none_of(cells.begin(), cells.end(), is_ditto_mark) || numbers_in(cells) == 0) continue;
    for (std::size_t k = 0; k < cells.size(); ++k) {
      if (!is_ditto_mark(cells[k])) continue;
      if (row == 0 || numbers_in(rows[row - 1]) == 0)
        throw text::InputError({file, line[row]}, cells[k],
                               "this is a ditto mark, and no row of numbers is above it: write the value "
                               "into the cell");
      if (++repeated == 1) first_line = line[row], first_mark = cells[k];
      cells[k] = rows[row - 1][k];
    }
  }
  if (repeated == 0) return {};
  if (repeated == 1)
    return fmt::format("the ditto mark {} in line {} repeats the cell above it", first_mark, first_line);
  return fmt::format("{} ditto marks such as {} in line {} repeat the cells above them", repeated, first_mark,
                     first_line);
}

}  // namespace vernier::sheet
