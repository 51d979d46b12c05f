// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/probe/touch_table.h"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "tools/format/units.h"
#include "tools/text/error.h"
#include "tools/text/numbers.h"

namespace vernier::probe {
namespace {

// Units at the end of a name, longest first.
constexpr std::pair<const char*, const char*> kSuffixes[] = {
    {"_mm_min", "mm/min"}, {"_mm_s2", "mm/s^2"}, {"_mm_s", "mm/s"}, {"_degC", "degC"}, {"_deg", "deg"},
    {"_um", "um"},         {"_mm", "mm"},        {"_in", "in"},     {"_ms", "ms"},     {"_s", "s"}};
constexpr std::string_view kPrinted = "_printed";

bool take_suffix(std::string& name, std::string_view suffix) {
  if (name.size() <= suffix.size() || name.substr(name.size() - suffix.size()) != suffix) return false;
  name.resize(name.size() - suffix.size());
  return true;
}

/// Returns the unit at the end of a name, ignoring a word behind it; empty if there is none.
std::string unit_in_name(std::string name) {
  take_suffix(name, kPrinted);
  for (const auto& [suffix, unit] : kSuffixes)
    if (take_suffix(name, suffix)) return unit;
  return "";
}

std::pair<std::string, std::string> split(const std::string& words, const char* option) {
  const auto at = words.find('=');
  if (at == 0 || at == std::string::npos || at + 1 == words.size())
    throw text::InputError(fmt::format("{} \"{}\": not of the form column=value", option, words));
  return {words.substr(0, at), words.substr(at + 1)};
}

void rename(format::CsvFile& csv, const std::string& words) {
  auto parts = split(words, "--column");
  std::string &from = parts.first, &to = parts.second;
  const auto found = std::find_if(csv.columns.begin(), csv.columns.end(),
                                  [&](const format::CsvColumn& c) { return c.name == from; });
  if (found == csv.columns.end()) throw text::InputError({csv.file, csv.header_line}, from, "no such column");
  if (const auto bracket = to.find('['); bracket != std::string::npos && to.back() == ']') {
    found->unit = to.substr(bracket + 1, to.size() - bracket - 2);
    to.resize(bracket);
    if (!format::find_unit(found->unit))
      throw text::InputError({csv.file, csv.header_line}, found->unit, "unknown unit");
  }
  // "mean_lp_um=lower" remains a column in um.
  if (found->unit.empty()) found->unit = unit_in_name(from);
  // A column that already had the name loses it.
  for (format::CsvColumn& column : csv.columns)
    if (column.name == to && &column != &*found) column.name += "_before";
  found->name = to;
}

std::size_t column_of(const format::CsvFile& csv, const std::string& name) {
  const auto found = std::find_if(csv.columns.begin(), csv.columns.end(),
                                  [&](const format::CsvColumn& c) { return c.name == name; });
  if (found == csv.columns.end()) throw text::InputError({csv.file, csv.header_line}, name, "no such column");
  return static_cast<std::size_t>(found - csv.columns.begin());
}

void keep_rows(format::CsvFile& csv, const std::string& name, const std::string& value) {
  const std::size_t index = column_of(csv, name);
  format::CsvFile kept = csv;
  kept.rows.clear(), kept.line.clear();
  for (std::size_t i = 0; i < csv.rows.size(); ++i) {
    if (csv.rows[i][index] != value) continue;
    kept.rows.push_back(csv.rows[i]);
    kept.line.push_back(csv.line[i]);
  }
  if (kept.rows.empty())
    throw text::InputError({csv.file, csv.header_line}, value, "no row has this " + name);
  csv = std::move(kept);
}

}  // namespace

TouchTable::TouchTable(const std::string& text, const std::string& file,
                       const std::vector<std::string>& renames, const std::vector<std::string>& where)
    : csv_(format::parse_csv(text, file)) {
  for (const std::string& words : renames) rename(csv_, words);
  for (const std::string& words : where) {
    const auto [name, value] = split(words, "--where");
    keep_rows(csv_, name, value);
  }
  for (std::size_t i = 0; i < csv_.columns.size(); ++i) {
    Column column{csv_.columns[i].name, csv_.columns[i].unit, false, i};
    column.printed = take_suffix(column.name, kPrinted);
    for (const auto& [suffix, unit] : kSuffixes)
      if (column.unit.empty() && take_suffix(column.name, suffix)) column.unit = unit;
    columns_.push_back(column);
  }
}

TouchTable TouchTable::only(const std::string& column, const std::string& value) const {
  TouchTable part = *this;
  keep_rows(part.csv_, column, value);
  part.notes_.clear();
  return part;
}

std::vector<std::string> TouchTable::values_of(const std::string& column) const {
  const std::size_t index = column_of(csv_, column);
  std::vector<std::string> values;
  for (const auto& row : csv_.rows)
    if (std::find(values.begin(), values.end(), row[index]) == values.end()) values.push_back(row[index]);
  return values;
}

std::optional<Eigen::VectorXd> TouchTable::find(const std::vector<std::string>& names) {
  const Column* found = nullptr;
  for (const std::string& name : names) {
    for (const Column& column : columns_) {
      if (column.name != name) continue;
      if (found != nullptr && found->printed != column.printed)
        notes_.push_back(
            fmt::format("{}: the values are as printed, not from the repaired column (--column {}={} uses "
                        "the repaired column)",
                        name, csv_.columns[(column.printed ? *found : column).index].name, names.front()));
      if (found == nullptr || column.printed) found = &column;
    }
    if (found != nullptr) break;
  }
  if (found == nullptr) return std::nullopt;
  const std::string& unit_name = found->unit;
  const bool per_minute = unit_name == "mm/min";  // the unit of feeds here
  const auto unit = format::find_unit(unit_name);
  Eigen::VectorXd values(static_cast<Eigen::Index>(rows()));
  for (std::size_t i = 0; i < rows(); ++i) {
    const std::string& cell = csv_.rows[i][found->index];
    const auto number = text::parse_number(cell);
    if (!number)
      throw text::InputError({csv_.file, csv_.line[i]}, cell,
                             "not a number in column " + csv_.columns[found->index].name);
    const double value = per_minute || !unit ? *number : unit->factor * *number + unit->offset;
    values(static_cast<Eigen::Index>(i)) =
        unit && unit->dimension == format::Dimension::kSpeed && !per_minute ? 60 * value : value;
  }
  return values;
}

Eigen::VectorXd TouchTable::need(const std::vector<std::string>& names, const std::string& what) {
  if (auto values = find(names)) return *values;
  throw text::InputError({csv_.file, csv_.header_line}, names.front(), "the table has no column " + what);
}

std::optional<Eigen::VectorXd> TouchTable::uncertainty() {
  auto u = find({"u"});
  if (u && u->minCoeff() <= 0)
    throw text::InputError(fmt::format("{}: u is not above 0 in every row", csv_.file));
  return u;
}

}  // namespace vernier::probe
