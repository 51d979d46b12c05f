// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/simulate/path.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "tools/format/columns.h"
#include "tools/text/error.h"
#include "tools/text/files.h"
#include "tools/text/numbers.h"

namespace vernier::simulate {

Path::Path(const std::string& text, const std::string& file) : csv_(format::parse_csv(text, file)) {
  if (!has(format::columns::kTime))
    throw text::InputError({file, csv_.header_line}, format::columns::kTime,
                           "the column of the path's time is missing");
  time_ = numbers(format::columns::kTime, format::Dimension::kTime);
  for (std::size_t row = 1; row < rows(); ++row) {
    const auto at = static_cast<Eigen::Index>(row);
    if (!(time_[at] > time_[at - 1]))
      throw text::InputError({file, csv_.line[row]}, csv_.rows[row][*index_of(format::columns::kTime)],
                             "the time of a path must increase from row to row");
  }
}

std::optional<std::size_t> Path::index_of(const std::string& name) const {
  for (std::size_t i = 0; i < csv_.columns.size(); ++i)
    if (csv_.columns[i].name == name) return i;
  return std::nullopt;
}

model::Column Path::read(std::size_t column) const {
  model::Column values(static_cast<Eigen::Index>(rows()));
  for (std::size_t row = 0; row < rows(); ++row) {
    const std::string& cell = csv_.rows[row][column];
    const auto number = text::parse_number(cell);
    if (!number)
      throw text::InputError({csv_.file, csv_.line[row]}, cell,
                             cell.empty() ? "empty, in column " + csv_.columns[column].name
                                          : "not a number, in column " + csv_.columns[column].name);
    values[static_cast<Eigen::Index>(row)] = *number;
  }
  return values;
}

model::Column Path::numbers(const std::string& name, format::Dimension dimension) const {
  const auto column = index_of(name);
  if (!column) throw text::InputError({csv_.file, csv_.header_line}, name, "this column is missing");
  const std::string& written = csv_.columns[*column].unit;
  const format::Unit unit = *format::find_unit(written);
  if (unit.dimension != dimension)
    throw text::InputError(
        {csv_.file, csv_.header_line}, name + (written.empty() ? "" : "[" + written + "]"),
        dimension == format::Dimension::kNone
            ? std::string("this column is a pure number and must not have a unit")
            : std::string("this column needs a unit, for example ") + format::base_unit(dimension));
  return unit.factor * read(*column) + unit.offset;
}

model::Column Path::input(const model::Input& input) const {
  const std::size_t column = index_of(input.name).value();
  const std::string& written = csv_.columns[column].unit;
  if (written == input.unit || input.unit.empty()) return read(column);
  const auto declared = format::find_unit(input.unit);
  const format::Unit unit = *format::find_unit(written);
  if (!declared || declared->dimension != unit.dimension)
    throw text::InputError({csv_.file, csv_.header_line}, input.name + "[" + written + "]",
                           fmt::format("the machine file declares this input in {}", input.unit));
  return (unit.factor * read(column) + unit.offset - declared->offset) / declared->factor;
}

std::vector<std::string> Path::words(const std::string& name) const {
  std::vector<std::string> result;
  const std::size_t column = index_of(name).value();
  for (const auto& row : csv_.rows) result.push_back(row[column]);
  return result;
}

Path read_path(const std::string& file) { return {text::read_file(file), file}; }

Ticks ticks_of(const Path& path, double period_s) {
  const model::Column& t = path.time();
  const double span = t[t.size() - 1] - t[0];
  // A millionth of a period, so that 0.3 s is 300 periods and not 299.
  const auto count = static_cast<std::size_t>(std::floor(span / period_s + 1e-6)) + 1;
  Ticks ticks{
      model::Column(static_cast<Eigen::Index>(count)), {}, model::Column(static_cast<Eigen::Index>(count))};
  ticks.segment.reserve(count);
  Eigen::Index row = 0;
  for (std::size_t k = 0; k < count; ++k) {
    const double now = t[0] + static_cast<double>(k) * period_s;
    // The same millionth: a tick on a row belongs to the segment that starts there.
    while (row + 2 < t.size() && t[row + 1] <= now + 1e-6 * period_s) ++row;
    const double length = t.size() > 1 ? t[row + 1] - t[row] : 1;
    const auto at = static_cast<Eigen::Index>(k);
    ticks.time[at] = now;
    ticks.fraction[at] = t.size() > 1 ? std::clamp((now - t[row]) / length, 0.0, 1.0) : 0;
    ticks.segment.push_back(static_cast<std::size_t>(row));
  }
  return ticks;
}

}  // namespace vernier::simulate
