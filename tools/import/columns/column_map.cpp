// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/import/columns/column_map.h"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <optional>

#include "tools/format/columns.h"
#include "tools/format/csv_file.h"
#include "tools/format/units.h"
#include "tools/sheet/heading.h"
#include "tools/sheet/sheet_number.h"
#include "tools/text/csv.h"
#include "tools/text/numbers.h"
#include "tools/text/words.h"

namespace vernier::importer {
namespace {

/// Does the format keep words in this column?
bool is_word(const std::string& name) {
  const format::ColumnGroup* const column = format::find_column(name);
  return column != nullptr && column->words;
}

/// "left = right", both trimmed; split at the last sign where the right side is a column, at the first else.
std::pair<std::string, std::string> sides(const std::string& words, bool last, const text::Place& place,
                                          const char* form) {
  const auto at = last ? words.rfind('=') : words.find('=');
  if (at == std::string::npos) throw text::InputError(place, words, std::string("not of the form ") + form);
  std::pair<std::string, std::string> result = {text::trimmed(words.substr(0, at)),
                                                text::trimmed(words.substr(at + 1))};
  if (result.first.empty() || result.second.empty())
    throw text::InputError(place, words, std::string("not of the form ") + form);
  return result;
}

void set_target(MappedColumn& column, const std::string& target) {
  const auto open = target.find('[');
  column.name = text::trimmed(target.substr(0, open));
  if (open == std::string::npos) return;
  if (target.back() != ']') throw text::InputError(column.place, target, "a column is name[unit]");
  column.unit = text::trimmed(target.substr(open + 1, target.size() - open - 2));
  if (column.unit.empty() || !format::find_unit(column.unit))
    throw text::InputError(column.place, column.unit, "unknown unit; known are " + format::known_units());
  column.unit = format::canonical_unit(column.unit);
}

void add(ColumnMap& map, MappedColumn column) {
  for (const MappedColumn& other : map.columns)
    if (other.name == column.name)
      throw text::InputError(column.place, column.name, "the column map gives this column twice");
  map.columns.push_back(std::move(column));
}

void set_option(ColumnMap& map, const std::string& key, const std::string& value, const text::Place& place) {
  const auto one_of = [&](const char* yes, const char* no) {
    if (value != yes && value != no)
      throw text::InputError(place, value, std::string("is neither ") + yes + " nor " + no);
    return value == yes;
  };
  if (key == "separator")
    map.format.separator = separator_of(value, place);
  else if (key == "decimal")
    map.format.decimal_comma = one_of("comma", "point");
  else if (key == "header")
    map.format.header = one_of("yes", "no");
  else if (key == "comment")
    map.format.comment = value == "none" ? "" : value;
  else if (key == "skip" && text::parse_count(value))
    map.format.skip = *text::parse_count(value);
  else
    throw text::InputError(place, key,
                           "this line of the column map has an unknown keyword; known keywords are column, "
                           "set, separator, decimal, header, comment, skip");
}

/// A number in the form of measurement files, or `nullopt`.
std::optional<std::string> number_cell(std::string text, bool decimal_comma) {
  if (decimal_comma) std::replace(text.begin(), text.end(), ',', '.');
  if (!text::parse_number(text)) return std::nullopt;
  return text.front() == '+' ? text.substr(1) : text;
}

std::size_t source_index(const DelimitedFile& file, const MappedColumn& column) {
  if (const auto number = text::parse_count(column.source)) {
    const std::size_t width = file.rows.front().size();
    if (*number >= 1 && *number <= width) return *number - 1;
    throw text::InputError(
        column.place.file.empty() ? text::Place{file.file, file.line.front()} : column.place, column.source,
        fmt::format("this column does not exist: the rows have {} columns", std::to_string(width)));
  }
  const auto found = std::find(file.header.begin(), file.header.end(), column.source);
  if (found == file.header.end())
    throw text::InputError({file.file, file.header_line}, column.source,
                           "the header has no column of this name");
  if (std::count(file.header.begin(), file.header.end(), column.source) > 1)
    throw text::InputError({file.file, file.header_line}, column.source,
                           "several columns have this name: give the number of the column");
  return static_cast<std::size_t>(found - file.header.begin());
}

/// A unit in the brackets of a heading is a fact of the file.
void refuse_another_unit(const DelimitedFile& file, std::size_t index, const MappedColumn& column) {
  const sheet::Heading heading = sheet::parse_heading(file.header[index]);
  if (heading.text.find_first_of("[(<") == std::string::npos || heading.unit.empty() || column.unit.empty() ||
      heading.unit == column.unit)
    return;
  throw text::InputError(
      {file.file, file.header_line}, heading.text,
      fmt::format(
          "the table states the unit {}, the assignment to {} states {}: correct one of the two units",
          heading.unit, column.name, column.unit));
}

/// may_be_heading: the cell is in the first line of a table that was read without headings.
std::string cell_of(const std::string& text, const MappedColumn& column, bool decimal_comma,
                    bool may_be_heading, const text::Place& place) {
  if (column.name == format::columns::kRole && !text.empty() && !format::is_role(text))
    throw text::InputError(place, text, format::kRoleRule);
  if (is_word(column.name) || text.empty()) return text;
  const auto number = number_cell(text, decimal_comma);
  if (!number)
    throw text::InputError(place, text,
                           "not a number, for " + column.name +
                               (!decimal_comma && number_cell(text, true)
                                    ? "; if the table has a decimal comma, give --decimal comma"
                                : may_be_heading ? "; if this line has the headings, give --header"
                                                 : ""));
  return *number;
}

/// True for a column of names ("point"): its name has no meaning in the format, and no cell is a number.
bool holds_names(const DelimitedFile& file, const MappedColumn& column, std::size_t index) {
  // dirX, vJ1: columns of an axis have numbers.
  const auto is_axis = [](const std::string& word) {
    return !word.empty() && word.size() <= 2 && std::isupper(static_cast<unsigned char>(word[0])) != 0;
  };
  if (column.source.empty() || !column.unit.empty() || column.name.size() < 3 ||
      format::find_column(column.name) != nullptr || format::axis_column_named(column.name, is_axis))
    return false;
  return std::none_of(file.rows.begin(), file.rows.end(), [&](const std::vector<std::string>& row) {
    return number_cell(row[index], false) || number_cell(row[index], true);
  });
}

}  // namespace

void add_column(ColumnMap& map, const std::string& words, const text::Place& place) {
  const auto [source, target] = sides(words, true, place, "COLUMN=name[unit]");
  MappedColumn column{source, "", "", "", place};
  set_target(column, target);
  add(map, std::move(column));
}

void add_constant(ColumnMap& map, const std::string& words, const text::Place& place) {
  const auto [target, value] = sides(words, false, place, "name[unit]=VALUE");
  MappedColumn column{"", value, "", "", place};
  set_target(column, target);
  add(map, std::move(column));
}

std::string constant_cell(const MappedColumn& column, bool decimal_comma) {
  const std::string& text = column.constant;
  if (is_word(column.name) || text::parse_number(text)) return text;
  const sheet::DecimalSign sign = sheet::decimal_sign_in(text);
  const bool comma = text.find(',') != std::string::npos;
  if (comma && (sign == sheet::DecimalSign::kComma || (sign == sheet::DecimalSign::kEither && decimal_comma)))
    return *sheet::plain_number(text, true);
  if (comma && sign == sheet::DecimalSign::kEither)
    throw text::InputError(
        column.place, text,
        fmt::format("for {}: a decimal comma or thousands? Write the number with a decimal point",
                    column.name));
  // A column without a unit that the format does not know may have words.
  if (column.unit.empty() && format::find_column(column.name) == nullptr) return text;
  throw text::InputError(column.place, text, "not a number, for " + column.name);
}

void read_column_map(ColumnMap& map, const std::string& text, const std::string& file) {
  std::size_t at = 0, number = 0;
  while (at < text.size()) {
    const std::size_t end = std::min(text.find('\n', at), text.size());
    const std::string line = text::trimmed(text.substr(at, end - at));
    at = end + 1;
    const text::Place place{file, ++number};
    if (line.empty() || line.front() == '#') continue;
    if (line.starts_with("column "))
      add_column(map, line.substr(7), place);
    else if (line.starts_with("set "))
      add_constant(map, line.substr(4), place);
    else {
      const auto [key, value] = sides(line, false, place, "STATEMENT = VALUE");
      set_option(map, key, value, place);
    }
  }
}

const ImportTable::Column* ImportTable::find(const std::string& name) const {
  for (const Column& column : columns)
    if (column.name == name) return &column;
  return nullptr;
}

std::vector<double> ImportTable::numbers(const std::string& name) const {
  const Column& column = *find(name);
  const format::Unit unit = *format::find_unit(column.unit);
  std::vector<double> result;
  for (std::size_t i = 0; i < line.size(); ++i) {
    if (column.cells[i].empty())
      throw text::InputError({file, line[i]}, "", fmt::format("the row has an empty cell, for {}", name));
    result.push_back(*text::parse_number(column.cells[i]) * unit.factor + unit.offset);
  }
  return result;
}

void ImportTable::remove(const std::string& name) {
  std::erase_if(columns, [&](const Column& column) { return column.name == name; });
}

void ImportTable::add(const std::string& name, const std::string& unit, const std::vector<double>& values) {
  Column column{name, unit, {}};
  for (const double value : values) column.cells.push_back(text::number_text(value));
  columns.push_back(std::move(column));
}

bool has_header(const ColumnMap& map) {
  return map.format.header || std::any_of(map.columns.begin(), map.columns.end(), [](const auto& column) {
           return !column.source.empty() && !text::parse_count(column.source);
         });
}

ImportTable mapped_table(const std::string& text, const std::string& file, const ColumnMap& map) {
  DelimitedFormat format = map.format;
  format.header = has_header(map);
  const DelimitedFile read = parse_delimited(text, file, format);
  ImportTable table{file, {}, read.line};
  for (const MappedColumn& column : map.columns) {
    ImportTable::Column cells{column.name, column.unit, {}};
    const bool constant = column.source.empty();
    const std::size_t index = constant ? 0 : source_index(read, column);
    if (!constant && !read.header.empty()) refuse_another_unit(read, index, column);
    const bool names = holds_names(read, column, index);
    const std::string same = constant ? constant_cell(column, format.decimal_comma) : "";
    for (std::size_t i = 0; i < read.rows.size(); ++i)
      cells.cells.push_back(
          names ? read.rows[i][index]
                : cell_of(constant ? same : read.rows[i][index], column, !constant && format.decimal_comma,
                          !constant && i == 0 && read.header.empty(), {file, read.line[i]}));
    table.columns.push_back(std::move(cells));
  }
  return table;
}

std::string measurement_csv(const ImportTable& table) {
  std::string text;
  for (const auto& column : table.columns)
    text += (text.empty() ? "" : ",") + column.name + (column.unit.empty() ? "" : "[" + column.unit + "]");
  text += "\n";
  for (std::size_t i = 0; i < table.line.size(); ++i) {
    for (std::size_t k = 0; k < table.columns.size(); ++k)
      text += (k > 0 ? "," : "") + text::csv_cell(table.columns[k].cells[i]);
    text += "\n";
  }
  const format::CsvFile back = format::parse_csv(text, table.file);
  if (back.rows.size() != table.line.size())
    throw text::InputError({table.file, 0}, "", "the row has only empty cells");
  return text;
}

}  // namespace vernier::importer
