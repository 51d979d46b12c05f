// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/format/csv_file.h"

#include <set>

#include "tools/format/units.h"
#include "tools/text/csv.h"
#include "tools/text/numbers.h"
#include "tools/text/words.h"

namespace vernier::format {
namespace {

CsvColumn column_of(const std::string& field, const text::Place& place) {
  CsvColumn column{field, ""};
  const auto open = field.find('[');
  if (open != std::string::npos) {
    if (field.back() != ']') throw text::InputError(place, field, "a column is name[unit]");
    column.name = text::trimmed(field.substr(0, open));
    column.unit = text::trimmed(field.substr(open + 1, field.size() - open - 2));
    if (column.unit.empty())
      throw text::InputError(place, field, "the brackets in the heading of this column contain no unit");
  }
  if (!text::is_name(column.name))
    throw text::InputError(place, field, "a column name may have only letters, digits and _");
  if (!find_unit(column.unit))
    throw text::InputError(place, column.unit, "unknown unit; known are " + known_units());
  column.unit = canonical_unit(column.unit);
  return column;
}

}  // namespace

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
    const std::string bare = text::trimmed(content);
    if (bare.empty() || bare.front() == '#') continue;
    const text::Place place{file, line};
    if (content.find('\0') != std::string::npos)
      throw text::InputError(place, "", "a zero byte: this is not a text file");
    std::vector<std::string> fields = text::fields_of(content, {}, place);
    if (csv.columns.empty()) {
      csv.header_line = line;
      for (const std::string& field : fields) {
        csv.columns.push_back(column_of(field, place));
        if (!names.insert(csv.columns.back().name).second)
          throw text::InputError(place, csv.columns.back().name, "this column occurs twice");
      }
      continue;
    }
    if (fields.size() != csv.columns.size())
      throw text::InputError(place, bare.substr(0, 40),
                             std::to_string(fields.size()) + " fields where the header has " +
                                 std::to_string(csv.columns.size()));
    csv.rows.push_back(std::move(fields));
    csv.line.push_back(line);
  }
  if (csv.columns.empty()) throw text::InputError({file, 0}, "", "the file has no header line");
  if (csv.rows.empty())
    throw text::InputError({file, csv.header_line}, "", "the file has no rows below the header");
  return csv;
}

}  // namespace vernier::format
