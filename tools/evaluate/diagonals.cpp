// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/evaluate/diagonals.h"

#include <Eigen/Core>
#include <algorithm>
#include <cmath>

#include "tools/evaluate/positioning_page.h"
#include "tools/format/columns.h"
#include "tools/format/csv_file.h"
#include "tools/model/column_reader.h"
#include "tools/text/error.h"
#include "tools/text/numbers.h"

namespace vernier::evaluate {
namespace {

/// Steps whose directions differ by less are on one line: 1 mm across a metre is a set-up's, not another
/// line's.
constexpr double kSameDirection = 1e-3;
/// Commanded positions are numbers of the control: above this distance they are two targets.
constexpr double kSameTarget_mm = 1e-6;

struct Row {
  Eigen::Vector3d at = Eigen::Vector3d::Zero();
  double reading = 0;
  std::size_t line = 0;
};

/// Columns of a file for diagonals: positions of its linear axes, readings, the largest uncertainty; mm.
struct Columns {
  std::array<model::Column, 3> axis;  // empty: not in the file
  model::Column reading, u;
};

bool is_length(const model::ColumnReader& reader, const std::string& name) {
  return reader.has(name) && reader.dimension(name) == format::Dimension::kLength;
}

Columns columns_of(model::ColumnReader& reader, const std::string& reading) {
  Columns columns;
  std::size_t axes = 0;
  for (std::size_t k = 0; k < 3; ++k)
    if (const std::string name(1, "XYZ"[k]); is_length(reader, name)) {
      columns.axis[k] = reader.numbers(name, format::Dimension::kLength, false);
      ++axes;
    }
  reader.require(reading, "this column is missing");
  if (!is_length(reader, reading))
    throw text::InputError(reader.header(), reading, "a displacement needs a unit of length");
  columns.reading = reader.numbers(reading, format::Dimension::kLength, false);
  if (const std::string u = format::columns::kUncertainty; is_length(reader, u))
    columns.u = reader.numbers(u, format::Dimension::kLength, false);
  if (axes < 2)
    throw text::InputError(reader.header(), "X",
                           "the file of a diagonal must have columns of at least two linear axes");
  return columns;
}

std::string signs_of(const Eigen::Vector3d& direction) {
  std::string name;
  for (Eigen::Index k = 0; k < 3; ++k)
    if (std::abs(direction[k]) > kSameDirection)
      name += std::string(direction[k] > 0 ? "+" : "-") + static_cast<char>('X' + k);
  return name;
}

/// Consecutive rows along one line, in both approach directions; the direction has its first axis upwards.
struct Line {
  Eigen::Vector3d direction = Eigen::Vector3d::Zero();
  std::vector<Row> rows;
};

Eigen::Vector3d upwards(const Eigen::Vector3d& step) {
  for (Eigen::Index k = 0; k < 3; ++k)
    if (std::abs(step[k]) > kSameDirection * step.norm())
      return step[k] > 0 ? step.normalized() : -step.normalized();
  return step;
}

std::vector<Line> lines_of(const std::vector<Row>& rows, const std::string& file) {
  std::vector<Line> lines;
  for (std::size_t i = 0; i < rows.size(); ++i) {
    const Row& row = rows[i];
    // The line of the previous row continues if the motion is along it, or if the target is approached again.
    if (!lines.empty() && lines.back().direction.norm() > 0) {
      const Eigen::Vector3d way = row.at - lines.back().rows.front().at;
      const Eigen::Vector3d across = way - way.dot(lines.back().direction) * lines.back().direction;
      if (across.norm() <= kSameDirection * std::max(1.0, way.norm())) {
        lines.back().rows.push_back(row);
        continue;
      }
    }
    if (!lines.empty() && lines.back().direction.norm() == 0) {
      const Eigen::Vector3d step = row.at - lines.back().rows.front().at;
      if (step.norm() > kSameTarget_mm) lines.back().direction = upwards(step);
      lines.back().rows.push_back(row);
      continue;
    }
    lines.push_back({Eigen::Vector3d::Zero(), {row}});
  }
  for (const Line& line : lines) {
    const std::string name = signs_of(line.direction);
    if (name.size() < 4)
      throw text::InputError(
          {file, line.rows.front().line}, name,
          name.empty()
              ? "this row is not on a straight line with its neighbouring rows"
              : "the rows are along one axis: evaluate them by ISO 230-2 (vernier evaluate iso230-2)");
  }
  return lines;
}

DiagonalFile diagonal_of(const std::vector<Line>& passes, const std::string& name) {
  DiagonalFile result;
  result.name = name;
  result.positions.unit = "mm";
  result.positions.sense_from_order = true;
  const Eigen::Vector3d direction = passes.front().direction;
  double low = 0, high = 0;
  const Eigen::Vector3d origin = passes.front().rows.front().at;
  for (const Line& pass : passes)
    for (const Row& row : pass.rows) {
      low = std::min(low, (row.at - origin).dot(direction));
      high = std::max(high, (row.at - origin).dot(direction));
    }
  result.length = high - low;
  std::map<long long, TargetReadings> targets;
  for (const Line& pass : passes) {
    // The sign of the instrument is the one with which its displacement follows the distance.
    double together = 0, mean_way = 0, mean_reading = 0;
    for (const Row& row : pass.rows) {
      mean_way += (row.at - origin).dot(direction) / static_cast<double>(pass.rows.size());
      mean_reading += row.reading / static_cast<double>(pass.rows.size());
    }
    for (const Row& row : pass.rows)
      together += ((row.at - origin).dot(direction) - mean_way) * (row.reading - mean_reading);
    const double counts = together < 0 ? -1 : 1;
    double sense = 0, before = 0;
    for (std::size_t i = 0; i < pass.rows.size(); ++i) {
      const double way = (pass.rows[i].at - origin).dot(direction) - low;
      if (i > 0)
        sense = way > before + kSameTarget_mm ? 1 : way < before - kSameTarget_mm ? -1 : -sense;
      else if (pass.rows.size() > 1)
        sense = (pass.rows[1].at - pass.rows[0].at).dot(direction) >= 0 ? 1 : -1;
      before = way;
      TargetReadings& target = targets[std::llround(way / kSameTarget_mm)];
      target.target = way;
      target.deviation[sense > 0 ? 0 : 1].push_back(counts * pass.rows[i].reading - way);
      ++result.positions.rows;
    }
  }
  for (auto& [key, target] : targets) result.positions.readings.push_back(std::move(target));
  return result;
}

}  // namespace

std::vector<DiagonalFile> read_diagonals(const std::string& text, const std::string& file,
                                         const std::string& reading) {
  const format::CsvFile csv = format::parse_csv(text, file);
  model::ColumnReader reader(csv);
  const Columns columns = columns_of(reader, reading);
  std::vector<Row> rows;
  std::optional<double> u;
  for (Eigen::Index i = 0; i < columns.reading.size(); ++i) {
    if (std::isnan(columns.reading[i])) continue;
    Row row;
    row.line = csv.line[static_cast<std::size_t>(i)];
    row.reading = columns.reading[i];
    for (std::size_t k = 0; k < 3; ++k) {
      if (columns.axis[k].size() == 0) continue;
      row.at[static_cast<Eigen::Index>(k)] = columns.axis[k][i];
      if (std::isnan(columns.axis[k][i]))
        throw text::InputError({file, row.line}, std::string(1, "XYZ"[k]),
                               "the cells of this column must not be empty");
    }
    if (columns.u.size() > 0 && !std::isnan(columns.u[i])) u = std::max(u.value_or(0), columns.u[i]);
    rows.push_back(row);
  }
  std::map<std::string, std::vector<Line>> by_name;
  std::vector<std::string> order;
  for (Line& line : lines_of(rows, file)) {
    const std::string name = signs_of(line.direction);
    if (!by_name.contains(name)) order.push_back(name);
    by_name[name].push_back(std::move(line));
  }
  std::vector<DiagonalFile> list;
  for (const std::string& name : order) {
    list.push_back(diagonal_of(by_name[name], name));
    list.back().positions.u = u;
  }
  if (list.empty()) throw text::InputError({file, csv.header_line}, reading, "no row has a reading");
  return list;
}

std::map<std::string, double> machine_values(const std::map<std::string, PositioningResult>& body) {
  std::map<std::string, double> most;
  for (const auto& [name, result] : body)
    for (const char* letter : {"A", "E", "M", "R", "B"})
      if (const auto value = characteristic(result, letter)) {
        const auto [at, fresh] = most.try_emplace(letter, *value);
        if (!fresh) at->second = std::max(at->second, *value);
      }
  return most;
}

}  // namespace vernier::evaluate
