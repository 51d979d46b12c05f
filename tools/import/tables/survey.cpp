// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/import/tables/survey.h"

#include <fmt/format.h>
#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <deque>

#include "tools/format/columns.h"
#include "tools/format/units.h"
#include "tools/maths/factors.h"

namespace vernier::importer {
namespace {

namespace columns = format::columns;

/// How far a direction or quaternion may be from length 1: rounding of four printed digits.
constexpr double kLengthOff = 1e-3;

std::string first_of(const std::string& names) { return names.substr(0, names.find(' ')); }

std::vector<std::string> words(const std::string& names) {
  std::vector<std::string> result(1);
  for (const char c : names) {
    if (c == ' ')
      result.emplace_back();
    else
      result.back() += c;
  }
  return result;
}

/// True if all of these columns are present, false if none is. An error if only some are.
bool has_all(const ImportTable& table, const std::string& names) {
  std::string missing;
  std::size_t found = 0;
  for (const std::string& name : words(names)) {
    if (table.find(name) != nullptr)
      ++found;
    else
      missing += (missing.empty() ? "" : " ") + name;
  }
  if (found > 0 && !missing.empty())
    throw text::InputError({table.file, 0}, missing, "not mapped, though others of " + names + " are");
  return found > 0;
}

/// Is one of the columns a reading?
bool has_reading(const ImportTable& table) {
  std::deque<format::CsvColumn> header;
  const auto find = [&](std::string_view name) -> const format::CsvColumn* {
    const ImportTable::Column* const found = table.find(std::string(name));
    return found == nullptr ? nullptr : &header.emplace_back(format::CsvColumn{found->name, found->unit});
  };
  return std::any_of(table.columns.begin(), table.columns.end(), [&](const ImportTable::Column& column) {
    return format::is_reading({column.name, column.unit}, find);
  });
}

void check_dimension(const ImportTable& table, const std::string& names, format::Dimension dimension) {
  for (const std::string& name : words(names)) {
    const std::string& unit = table.find(name)->unit;
    if (format::find_unit(unit)->dimension == dimension) continue;
    throw text::InputError(
        {table.file, 0}, name + (unit.empty() ? "" : "[" + unit + "]"),
        dimension == format::Dimension::kNone
            ? std::string("this column is a pure number and must not have a unit")
            : std::string("this column needs a unit, for example ") + format::base_unit(dimension));
  }
}

/// The columns `names` as rows of numbers in their base units.
std::vector<Eigen::VectorXd> rows(const ImportTable& table, const std::string& names,
                                  format::Dimension dimension) {
  check_dimension(table, names, dimension);
  const std::vector<std::string> list = words(names);
  std::vector<Eigen::VectorXd> result(table.line.size(),
                                      Eigen::VectorXd(static_cast<Eigen::Index>(list.size())));
  for (std::size_t k = 0; k < list.size(); ++k) {
    const std::vector<double> column = table.numbers(list[k]);
    for (std::size_t i = 0; i < column.size(); ++i) result[i][static_cast<Eigen::Index>(k)] = column[i];
  }
  return result;
}

void replace(ImportTable& table, const std::string& old, const std::string& names, const std::string& unit,
             const std::vector<Eigen::VectorXd>& values) {
  for (const std::string& name : words(old)) table.remove(name);
  const std::vector<std::string> list = words(names);
  for (std::size_t k = 0; k < list.size(); ++k) {
    std::vector<double> column;
    for (const Eigen::VectorXd& row : values) column.push_back(row[static_cast<Eigen::Index>(k)]);
    table.add(list[k], unit, column);
  }
}

/// Brings vectors to length 1; one that is not nearly so is an error.
void normalise(const ImportTable& table, std::vector<Eigen::VectorXd>& values, const std::string& names) {
  for (std::size_t i = 0; i < values.size(); ++i) {
    const double length = values[i].norm();
    if (!(std::abs(length - 1) <= kLengthOff))
      throw text::InputError(
          {table.file, table.line[i]}, first_of(names),
          fmt::format("{} is not a unit vector: its length is {}", names, std::to_string(length)));
    values[i] /= length;
  }
}

Eigen::Vector3d vector_of(Eigen::Quaterniond q) {
  if (q.w() < 0) q.coeffs() = -q.coeffs();
  const double sine = q.vec().norm();
  if (sine < 1e-300) return Eigen::Vector3d::Zero();
  return q.vec() * (maths::kDegPerRad * 2 * std::atan2(sine, q.w()) / sine);
}

}  // namespace

Eigen::Vector3d rotation_vector_of_angles(const std::array<double, 3>& angles_deg) {
  using Eigen::AngleAxisd;
  using Eigen::Vector3d;
  return vector_of(AngleAxisd(angles_deg[0] / maths::kDegPerRad, Vector3d::UnitX()) *
                   AngleAxisd(angles_deg[1] / maths::kDegPerRad, Vector3d::UnitY()) *
                   AngleAxisd(angles_deg[2] / maths::kDegPerRad, Vector3d::UnitZ()));
}

Eigen::Vector3d rotation_vector_of_quaternion(const std::array<double, 4>& wxyz) {
  return vector_of(Eigen::Quaterniond(wxyz[0], wxyz[1], wxyz[2], wxyz[3]));
}

void finish_tracker(ImportTable& table) {
  const std::string angles = "rX rY rZ", quaternion = "qw qx qy qz";
  const bool by_angles = has_all(table, angles), by_quaternion = has_all(table, quaternion);
  const bool by_vector = std::any_of(columns::kRotation.begin(), columns::kRotation.end(),
                                     [&](const char* name) { return table.find(name) != nullptr; });
  if (by_angles + by_quaternion + by_vector > 1)
    throw text::InputError({table.file, 0}, by_quaternion ? "qw" : "rX",
                           "the orientation is mapped twice, in two forms: map one form");
  std::vector<Eigen::VectorXd> vectors;
  if (by_angles) {
    for (const Eigen::VectorXd& row : rows(table, angles, format::Dimension::kAngle))
      vectors.emplace_back(rotation_vector_of_angles({row[0], row[1], row[2]}));
    replace(table, angles, format::words_of(columns::kRotation), "deg", vectors);
  }
  if (by_quaternion) {
    std::vector<Eigen::VectorXd> values = rows(table, quaternion, format::Dimension::kNone);
    normalise(table, values, quaternion);
    for (const Eigen::VectorXd& row : values)
      vectors.emplace_back(rotation_vector_of_quaternion({row[0], row[1], row[2], row[3]}));
    replace(table, quaternion, format::words_of(columns::kRotation), "deg", vectors);
  }
  if (has_reading(table)) return;
  throw text::InputError(
      {table.file, 0}, "",
      "no measured column is mapped: map at least one of x y z, rX rY rZ, qw qx qy qz, rx ry rz");
}

void finish_camera(ImportTable& table, bool on_tool) {
  finish_tracker(table);
  for (const auto& group : {columns::kPoint, columns::kRotation})
    if (!has_all(table, format::words_of(group)))
      throw text::InputError({table.file, 0}, group.front(),
                             "the pose of a board is not complete: map x, y, z and an orientation (rx ry rz, "
                             "rX rY rZ or qw qx qy qz)");
  check_dimension(table, format::words_of(columns::kPoint), format::Dimension::kLength);
  check_dimension(table, format::words_of(columns::kRotation), format::Dimension::kAngle);
  if (!on_tool) return;
  for (std::size_t k = 0; k < 3; ++k)
    for (ImportTable::Column& column : table.columns) {
      if (column.name == columns::kPoint[k]) column.name = columns::kBoard[k];
      if (column.name == columns::kRotation[k]) column.name = columns::kBoardRotation[k];
    }
}

void finish_probe(ImportTable& table, double radius_mm) {
  const std::string normals = format::words_of(columns::kNormal),
                    nominals = format::words_of(columns::kNominalPoint);
  if (!has_all(table, normals)) throw text::InputError({table.file, 0}, normals, "a touch needs its normal");
  if (!has_all(table, nominals))
    throw text::InputError({table.file, 0}, nominals,
                           "the nominal point of a touch is missing: map px, py and pz");
  const bool recorded = has_all(table, "mx my mz"), given = table.find(columns::kDeviation) != nullptr;
  if (recorded == given)
    throw text::InputError({table.file, 0}, columns::kDeviation,
                           recorded ? "both d and the recorded point mx my mz are mapped"
                                    : "neither d nor the recorded point mx my mz is mapped");
  std::vector<Eigen::VectorXd> normal = rows(table, normals, format::Dimension::kNone);
  std::vector<Eigen::VectorXd> nominal = rows(table, nominals, format::Dimension::kLength);
  normalise(table, normal, normals);
  for (std::size_t i = 0; i < nominal.size(); ++i) nominal[i] += radius_mm * normal[i];
  if (recorded) {
    std::vector<Eigen::VectorXd> d;
    const std::vector<Eigen::VectorXd> point = rows(table, "mx my mz", format::Dimension::kLength);
    for (std::size_t i = 0; i < point.size(); ++i)
      d.emplace_back(Eigen::VectorXd::Constant(1, normal[i].dot(point[i] - nominal[i])));
    replace(table, "mx my mz", columns::kDeviation, "mm", d);
  } else {
    check_dimension(table, columns::kDeviation, format::Dimension::kLength);
  }
  replace(table, normals, normals, "", normal);
  replace(table, nominals, nominals, "mm", nominal);
}

void set_roles(ImportTable& table, std::size_t every) {
  if (table.find(columns::kRole) != nullptr)
    throw text::InputError({table.file, 0}, columns::kRole, "the column role is already mapped");
  ImportTable::Column role{columns::kRole, "", {}};
  for (std::size_t i = 0; i < table.line.size(); ++i)
    role.cells.emplace_back((i + 1) % every == 0 ? format::kCheckRole : format::kFitRole);
  table.columns.push_back(std::move(role));
}

}  // namespace vernier::importer
