// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/text/csv.h"

#include <set>

#include "tools/text/numbers.h"
#include "tools/text/units.h"
#include "tools/text/words.h"

namespace vernier::text {
namespace {

CsvColumn column_of(const std::string& field, const Place& place) {
  CsvColumn column{field, ""};
  const auto open = field.find('[');
  if (open != std::string::npos) {
    if (field.back() != ']') throw InputError(place, field, "a column is name[unit]");
    column.name = trimmed(field.substr(0, open));
    column.unit = trimmed(field.substr(open + 1, field.size() - open - 2));
    if (column.unit.empty()) throw InputError(place, field, "no unit in the brackets");
  }
  if (!is_name(column.name)) throw InputError(place, field, "a column name is letters, digits and _");
  if (!find_unit(column.unit))
    throw InputError(place, column.unit, "unknown unit; known are " + known_units());
  column.unit = canonical_unit(column.unit);
  return column;
}

}  // namespace

std::string csv_cell(const std::string& text) {
  if (text.find_first_of(",\"# \t\n\r") == std::string::npos) return text;
  std::string quoted = "\"";
  for (const char c : text) quoted += c == '"' ? std::string("\"\"") : std::string(1, c);
  return quoted + "\"";
}

std::vector<std::string> fields_of(const std::string& line, const FieldRules& rules, const Place& place) {
  const bool blanks = rules.separator == ' ';
  const auto is_separator = [&](char c) { return c == rules.separator || (blanks && c == '\t'); };
  const std::string text = blanks ? trimmed(line) : line;
  std::vector<std::string> fields(1);
  bool quoted = false, was_quoted = false;
  const auto close = [&] {
    if (!was_quoted) fields.back() = trimmed(fields.back());
    was_quoted = false;
  };
  for (std::size_t i = 0; i < text.size(); ++i) {
    const char c = text[i];
    const bool at_begin = !was_quoted && trimmed(fields.back()).empty();
    if (quoted) {
      const bool doubled = c == '"' && i + 1 < text.size() && text[i + 1] == '"';
      quoted = c != '"' || doubled;
      if (quoted) fields.back() += c;
      if (doubled) ++i;
    } else if (is_separator(c)) {
      if (blanks && is_separator(text[i - 1])) continue;
      close();
      fields.emplace_back();
    } else if (c == '"' && at_begin) {
      fields.back().clear();
      quoted = was_quoted = true;
    } else if (c == '"' && (was_quoted || !rules.quotes_inside)) {
      throw InputError(place, text.substr(i, 20), "a stray quote");
    } else if (!was_quoted) {
      fields.back() += c;
    } else if (c != ' ' && c != '\t') {
      throw InputError(place, text.substr(i, 20), "text behind a closing quote");
    }
  }
  if (quoted) throw InputError(place, fields.back(), "a closing quote is missing");
  close();
  return fields;
}

CsvFile parse_csv(const std::string& text, const std::string& file) {
  CsvFile csv;
  csv.file = file;
  std::set<std::string> names;
  std::size_t at = text.starts_with("\xEF\xBB\xBF") ? 3 : 0, line = 0;
  while (at < text.size()) {
    ++line;
    std::size_t end = text.find('\n', at);
    if (end == std::string::npos) end = text.size();
    std::string content = text.substr(at, end - at);
    at = end + 1;
    if (!content.empty() && content.back() == '\r') content.pop_back();
    const std::string bare = trimmed(content);
    if (bare.empty() || bare.front() == '#') continue;
    const Place place{file, line};
    if (content.find('\0') != std::string::npos)
      throw InputError(place, "", "a zero byte: this is not a text file");
    std::vector<std::string> fields = fields_of(content, {}, place);
    if (csv.columns.empty()) {
      csv.header_line = line;
      for (const std::string& field : fields) {
        csv.columns.push_back(column_of(field, place));
        if (!names.insert(csv.columns.back().name).second)
          throw InputError(place, csv.columns.back().name, "this column stands twice");
      }
      continue;
    }
    if (fields.size() != csv.columns.size())
      throw InputError(place, bare.substr(0, 40),
                       std::to_string(fields.size()) + " fields where the header has " +
                           std::to_string(csv.columns.size()));
    csv.rows.push_back(std::move(fields));
    csv.line.push_back(line);
  }
  if (csv.columns.empty()) throw InputError({file, 0}, "", "no header line");
  if (csv.rows.empty()) throw InputError({file, csv.header_line}, "", "no rows below the header");
  return csv;
}

}  // namespace vernier::text
