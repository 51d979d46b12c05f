// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/import/columns/delimited.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <map>

#include "tools/format/columns.h"
#include "tools/sheet/heading.h"
#include "tools/text/csv.h"
#include "tools/text/error.h"
#include "tools/text/numbers.h"
#include "tools/text/words.h"

namespace vernier::importer {
namespace {

char separator_in(const std::string& line, bool decimal_comma) {
  for (const char c : {'\t', ';', ','})
    if (line.find(c) != std::string::npos && !(c == ',' && decimal_comma)) return c;
  return ' ';
}

class Lines {
 public:
  Lines(const std::string& text, const std::string& file) : text_(text), file_(file) {
    if (text.starts_with("\xEF\xBB\xBF")) at_ = 3;
  }
  bool next(std::string& line) {
    if (at_ >= text_.size()) return false;
    const std::size_t end = std::min(text_.find('\n', at_), text_.size());
    line = text_.substr(at_, end - at_);
    at_ = end + 1;
    ++number_;
    if (!line.empty() && line.back() == '\r') line.pop_back();
    if (line.find('\0') != std::string::npos)
      throw text::InputError(place(), "", "a zero byte: this is not a text file");
    return true;
  }
  text::Place place() const { return {file_, number_}; }

 private:
  const std::string& text_;
  const std::string& file_;
  std::size_t at_ = 0, number_ = 0;
};

/// A line that is not empty and no comment.
struct WrittenLine {
  std::size_t number = 0;
  std::string text;
  std::vector<std::string> fields;

  std::size_t numbers() const {
    return static_cast<std::size_t>(std::count_if(fields.begin(), fields.end(), [](std::string field) {
      std::replace(field.begin(), field.end(), ',', '.');
      return text::parse_number(field).has_value();
    }));
  }
  bool is_mostly_numbers() const { return 2 * numbers() > fields.size(); }
  /// True for a line of headings that names a coordinate or has a unit.
  bool has_coordinate() const {
    return std::any_of(fields.begin(), fields.end(), [](const std::string& field) {
      const sheet::Heading heading = sheet::parse_heading(field);
      return !heading.unit.empty() ||
             std::any_of(std::begin(format::columns::kPoint), std::end(format::columns::kPoint),
                         [&](const char* one) { return text::in_small_letters(heading.name) == one; });
    });
  }
  bool is_remark() const {
    constexpr std::array<const char*, 4> kSigns = {"//", "%", "!", "*"};
    return std::any_of(kSigns.begin(), kSigns.end(),
                       [&](const char* sign) { return text.starts_with(sign); });
  }
};

/// The key with the largest count. `counts`: not empty.
template <class Key>
Key most_frequent(const std::map<Key, std::size_t>& counts) {
  return std::max_element(counts.begin(), counts.end(),
                          [](const auto& a, const auto& b) { return a.second < b.second; })
      ->first;
}

std::vector<WrittenLine> written_lines(const std::string& text, const std::string& file,
                                       const DelimitedFormat& format) {
  std::vector<WrittenLine> list;
  Lines lines(text, file);
  std::string line;
  while (lines.next(line)) {
    const std::string bare = text::trimmed(line);
    if (bare.empty() || (!format.comment.empty() && bare.starts_with(format.comment))) continue;
    list.push_back({lines.place().line, bare, {}});
  }
  // A title can have another separator than the rows ("Date: 12.05.2026; 20,3 degC").
  std::map<char, std::size_t> lines_with;
  for (const WrittenLine& one : list) ++lines_with[separator_in(one.text, format.decimal_comma)];
  const char separator = format.separator != 0 ? format.separator
                         : list.empty()        ? ' '
                                               : most_frequent(lines_with);
  for (WrittenLine& one : list) {
    // A quote that a title does not close is no error of the table.
    if (std::count(one.text.begin(), one.text.end(), '"') % 2 != 0) continue;
    one.fields = text::fields_of(one.text, {separator, true}, {file, one.number});
  }
  return list;
}

constexpr std::pair<const char*, char> kSeparators[] = {
    {"comma", ','}, {"semicolon", ';'}, {"tab", '\t'}, {"space", ' '}, {"auto", 0}};

}  // namespace

std::vector<std::string> separator_words() {
  std::vector<std::string> words;
  for (const auto& [name, sign] : kSeparators) words.emplace_back(name);
  return words;
}

char separator_of(const std::string& name, const text::Place& place) {
  for (const auto& [known, sign] : kSeparators)
    if (name == known) return sign;
  throw text::InputError(place, name, "a separator is comma, semicolon, tab, space or auto");
}

TitleLines title_lines(const std::string& text, const std::string& file, const DelimitedFormat& format) {
  const std::vector<WrittenLine> lines = written_lines(text, file, format);
  std::map<std::size_t, std::size_t> lines_with;  // number of lines by number of fields
  for (const WrittenLine& line : lines) ++lines_with[line.fields.size()];
  if (lines.empty()) return {};
  const std::size_t width = most_frequent(lines_with);
  if (2 * lines_with[width] <= lines.size()) return {};
  std::map<std::size_t, std::size_t> rows_with;  // number of lines of this width by number of numbers
  for (const WrittenLine& line : lines)
    if (line.fields.size() == width) ++rows_with[line.numbers()];
  const std::size_t numbers = most_frequent(rows_with);
  if (numbers == 0) return {};
  const auto is_row = [&](const WrittenLine& line) {
    return !line.is_remark() &&
           (line.is_mostly_numbers() || (line.fields.size() == width && line.numbers() >= numbers));
  };
  TitleLines titles;
  for (std::size_t i = 0; i < lines.size(); ++i) {
    const WrittenLine& line = lines[i];
    const bool wide = line.fields.size() == width && !line.is_remark();
    const bool above_rows = i + 1 < lines.size() && is_row(lines[i + 1]);
    if (is_row(line)) break;
    if (wide && above_rows && (format.header || line.has_coordinate())) return titles;
    titles.skip = line.number;
    titles.texts.push_back(line.text);
  }
  // With names of columns, the line above the rows has them.
  return format.header ? TitleLines{} : titles;
}

DelimitedFile parse_delimited(const std::string& text, const std::string& file,
                              const DelimitedFormat& format) {
  DelimitedFile result;
  result.file = file;
  Lines lines(text, result.file);
  char separator = format.separator;
  std::string line;
  while (lines.next(line)) {
    const text::Place place = lines.place();
    const std::string bare = text::trimmed(line);
    if (place.line <= format.skip || bare.empty()) continue;
    if (!format.comment.empty() && bare.starts_with(format.comment)) continue;
    if (separator == 0) separator = separator_in(line, format.decimal_comma);
    std::vector<std::string> fields = text::fields_of(line, {separator, true}, place);
    if (format.header && result.header.empty()) {
      result.header = std::move(fields);
      result.header_line = place.line;
      continue;
    }
    const std::size_t wanted = format.header         ? result.header.size()
                               : result.rows.empty() ? fields.size()
                                                     : result.rows.front().size();
    if (fields.size() != wanted)
      throw text::InputError(
          place, bare.substr(0, 40),
          fmt::format("{} fields in this row; the number of fields in the rows above is {} (--skip N omits "
                      "lines of a title, "
                      "--separator states the separator; vernier import table finds both itself)",
                      fields.size(), std::to_string(wanted)));
    result.rows.push_back(std::move(fields));
    result.line.push_back(place.line);
  }
  if (result.rows.empty()) throw text::InputError({file, 0}, "", "no rows of data");
  return result;
}

}  // namespace vernier::importer
