// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/import/columns/point_columns.h"

#include <fmt/format.h>

#include <algorithm>
#include <optional>
#include <set>

#include "tools/format/columns.h"
#include "tools/format/units.h"
#include "tools/sheet/heading.h"
#include "tools/text/numbers.h"
#include "tools/text/words.h"

namespace vernier::importer {
namespace {

constexpr std::size_t kCoordinates = std::size(format::columns::kPoint);

std::optional<double> number_in(std::string cell) {
  std::replace(cell.begin(), cell.end(), ',', '.');
  return text::parse_number(cell);
}

bool is_coordinate(const std::string& name) {
  return std::find(std::begin(format::columns::kPoint), std::end(format::columns::kPoint), name) !=
         std::end(format::columns::kPoint);
}

/// A list of points: its rows, and its headings if the first line has headings.
class PointList {
 public:
  PointList(const std::string& text, const std::string& file, const DelimitedFormat& format)
      : read_(parse_delimited(text, file, format)) {
    if (read_.header.empty() && first_row_is_header()) {
      read_.header = read_.rows.front();
      read_.rows.erase(read_.rows.begin());
    }
  }

  std::size_t width() const { return read_.rows.front().size(); }
  std::size_t rows() const { return read_.rows.size(); }

  /// The heading of a column; its number if there are no headings, or others of this name.
  std::string source(std::size_t k) const {
    const bool own = !read_.header.empty() && !read_.header[k].empty() &&
                     std::count(read_.header.begin(), read_.header.end(), read_.header[k]) == 1 &&
                     !text::parse_count(read_.header[k]);
    return own ? read_.header[k] : std::to_string(k + 1);
  }
  sheet::Heading heading(std::size_t k) const {
    return read_.header.empty() ? sheet::Heading{} : sheet::parse_heading(read_.header[k]);
  }
  bool has_numbers(std::size_t k) const {
    bool any = false;
    for (const std::vector<std::string>& row : read_.rows) {
      if (!row[k].empty() && !number_in(row[k])) return false;
      any = any || !row[k].empty();
    }
    return any;
  }
  bool has_comma(std::size_t k) const {
    return std::any_of(read_.rows.begin(), read_.rows.end(),
                       [&](const auto& row) { return row[k].find(',') != std::string::npos; });
  }
  /// Numbers of the points: each is one more than the number above.
  bool counts(std::size_t k) const {
    for (std::size_t i = 0; i < read_.rows.size(); ++i) {
      const auto number = text::parse_count(read_.rows[i][k]);
      const auto before = i == 0 ? number : text::parse_count(read_.rows[i - 1][k]);
      if (!number || !before || *number != *before + (i == 0 ? 0 : 1)) return false;
    }
    return true;
  }
  /// Numbers of the points in any order: whole and different, and other columns have decimals.
  bool names_points(std::size_t k) const {
    std::set<std::size_t> seen;
    for (const std::vector<std::string>& row : read_.rows) {
      const auto number = text::parse_count(row[k]);
      if (!number || !seen.insert(*number).second) return false;
    }
    return std::any_of(read_.rows.begin(), read_.rows.end(), [&](const auto& row) {
      for (std::size_t other = 0; other < row.size(); ++other)
        if (other != k && number_in(row[other]) && !text::parse_count(row[other])) return true;
      return false;
    });
  }
  /// The word of --column that makes a column a coordinate; its unit is that of the heading, or mm.
  std::string word(std::size_t k, const std::string& coordinate) const {
    const std::string unit = heading(k).unit;
    return fmt::format("{}={}[{}]", source(k), coordinate, unit.empty() ? "mm" : unit);
  }

 private:
  bool first_row_is_header() const {
    if (read_.rows.size() < 2) return false;
    for (std::size_t k = 0; k < width(); ++k)
      if (!number_in(read_.rows[0][k]) && number_in(read_.rows[1][k])) return true;
    return false;
  }

  DelimitedFile read_;
};

/// True if the column can be a length: its heading has no other unit.
bool may_be_length(const PointList& list, std::size_t k) {
  const std::string unit = list.heading(k).unit;
  const auto known = unit.empty() ? std::nullopt : format::find_unit(unit);
  return unit.empty() || (known && known->dimension == format::Dimension::kLength);
}

}  // namespace

PointColumns point_columns(const std::string& text, const std::string& file, const DelimitedFormat& format) {
  const PointList list(text, file, format);
  PointColumns found;
  if (list.rows() == 0) return found;
  std::vector<std::size_t> named, numbers;
  for (std::size_t k = 0; k < list.width(); ++k) {
    if (!list.has_numbers(k) || !may_be_length(list, k)) continue;
    numbers.push_back(k);
    if (is_coordinate(text::in_small_letters(list.heading(k).name))) named.push_back(k);
  }
  found.by_order = named.size() != kCoordinates;
  const std::size_t first = numbers.empty() ? 0 : numbers.front();
  const bool numbered =
      found.by_order && numbers.size() > kCoordinates &&
      (list.counts(first) || (numbers.size() == kCoordinates + 1 && list.names_points(first)));
  if (numbered) numbers.erase(numbers.begin());
  std::vector<std::size_t>& point = found.by_order ? numbers : named;
  if (point.size() < kCoordinates) return found;
  point.resize(kCoordinates);
  if (numbered || !list.has_numbers(0)) found.words.push_back(list.source(numbered ? first : 0) + "=point");
  for (std::size_t i = 0; i < kCoordinates; ++i) {
    const std::string coordinate = found.by_order ? std::string(format::columns::kPoint[i])
                                                  : text::in_small_letters(list.heading(point[i]).name);
    found.words.push_back(list.word(point[i], coordinate));
    found.decimal_comma = found.decimal_comma || list.has_comma(point[i]);
  }
  return found;
}

ColumnMap with_point_columns(ColumnMap map, const PointColumns& columns) {
  for (const std::string& word : columns.words) add_column(map, word);
  map.format.decimal_comma = map.format.decimal_comma || columns.decimal_comma;
  return map;
}

namespace {

/// True if a column keeps only the name that its heading or its number gives: it has no meaning.
bool has_no_meaning(const MappedColumn& column) {
  return column.unit.empty() && format::find_column(column.name) == nullptr &&
         (column.name == sheet::name_from_words(column.source) || column.name == "column_" + column.source);
}

}  // namespace

UnreadCoordinates unread_coordinates(const std::string& text, const std::string& file, const ColumnMap& map) {
  UnreadCoordinates unread;
  DelimitedFormat format = map.format;
  format.header = has_header(map);
  std::vector<std::string> sources;
  for (const MappedColumn& column : map.columns) {
    if (column.source.empty()) continue;
    if (!has_no_meaning(column)) sources.push_back(column.source);
    // Positions, rotations or uncertainties in the list: the other columns are no forgotten coordinates.
    if (!is_coordinate(column.name) && !column.unit.empty()) return {};
  }
  bool any = false;
  for (const char* const coordinate : format::columns::kPoint) {
    const bool mapped = std::any_of(map.columns.begin(), map.columns.end(),
                                    [&](const MappedColumn& one) { return one.name == coordinate; });
    any = any || mapped;
    if (!mapped) unread.missing.emplace_back(coordinate);
  }
  if (!any || unread.missing.empty()) return {};
  const PointList list(text, file, format);
  if (list.rows() == 0) return {};
  for (std::size_t k = 0; k < list.width(); ++k) {
    const bool read = std::any_of(sources.begin(), sources.end(), [&](const std::string& source) {
      return source == list.source(k) || source == std::to_string(k + 1);
    });
    if (!read && list.has_numbers(k) && may_be_length(list, k) && !list.counts(k))
      unread.columns.push_back(list.source(k));
  }
  return unread.columns.size() >= unread.missing.size() ? unread : UnreadCoordinates{};
}

}  // namespace vernier::importer
