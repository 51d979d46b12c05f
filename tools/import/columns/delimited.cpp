// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/import/columns/delimited.h"

#include <fmt/format.h>

#include <algorithm>

#include "tools/text/csv.h"
#include "tools/text/error.h"
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
