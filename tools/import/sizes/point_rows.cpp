// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/import/sizes/point_rows.h"

#include <fmt/format.h>
#include <Eigen/Core>

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>

#include "tools/format/columns.h"
#include "tools/maths/alignment.h"

namespace vernier::importer {
namespace {

using Points = Eigen::Matrix3Xd;

constexpr Eigen::Index kFewestPoints = 8;  // fewer points agree with others by chance
/// Largest rms difference of points that fit, and smallest one of points that do not, as shares of their
/// spread: a machine errs by less than a thousandth of its travel.
constexpr double kFits = 0.005, kFails = 0.05;

struct Rows {
  Points targets, points;
  std::array<std::size_t, 3> measured = {};  // columns of x, y, z
};

/// The positions X, Y, Z and the points x, y, z of all rows; nullopt: a column or a cell is missing.
std::optional<Rows> rows_of(const sheet::Sheet& sheet, const sheet::SheetTable& table,
                            const std::vector<SizedColumn>& columns) {
  Rows rows;
  std::array<std::size_t, 3> targets = {};
  constexpr std::array<const char*, 3> kAxes = {"X", "Y", "Z"};
  for (std::size_t i = 0; i < kAxes.size(); ++i) {
    std::optional<std::size_t> target, measured;
    for (std::size_t k = 0; k < columns.size(); ++k) {
      const auto unit = sized_unit(columns[k]);
      if (!unit || unit->dimension != format::Dimension::kLength) continue;
      if (columns[k].axis && columns[k].name == kAxes[i]) target = k;
      if (columns[k].measures == kAxes[i]) measured = k;
    }
    if (!target || !measured) return std::nullopt;
    targets[i] = *target;
    rows.measured[i] = *measured;
  }
  std::vector<Eigen::Vector3d> from, to;
  for (std::size_t row = table.first_data; row < sheet.rows.size(); ++row) {
    if (sheet::is_blank(sheet.rows[row])) continue;
    Eigen::Vector3d at, point;
    for (std::size_t i = 0; i < kAxes.size(); ++i) {
      const auto a = sheet::number_at(sheet, row, targets[i]),
                 b = sheet::number_at(sheet, row, rows.measured[i]);
      if (!a || !b) return std::nullopt;
      at[static_cast<Eigen::Index>(i)] = *a * sized_unit(columns[targets[i]])->factor;
      point[static_cast<Eigen::Index>(i)] = *b * sized_unit(columns[rows.measured[i]])->factor;
    }
    from.push_back(at);
    to.push_back(point);
  }
  const auto count = static_cast<Eigen::Index>(from.size());
  rows.targets.resize(3, count);
  rows.points.resize(3, count);
  for (Eigen::Index i = 0; i < count; ++i) {
    rows.targets.col(i) = from[static_cast<std::size_t>(i)];
    rows.points.col(i) = to[static_cast<std::size_t>(i)];
  }
  return rows;
}

/// Rms difference of the points from their targets after the best rigid motion, as a share of their spread.
double misfit(const Points& from, const Points& to) {
  const double spread = (from.colwise() - from.rowwise().mean()).norm();
  return spread > 0 ? maths::aligned_error(maths::align(from, to), from, to).norm() / spread : 0;
}

/// A mirror image: the same points with one coordinate of the other sign.
Points mirrored(Points points) {
  points.row(0) *= -1;
  return points;
}

std::string fault_of(const Rows& rows) {
  const Eigen::Index count = rows.targets.cols();
  if (misfit(rows.targets, rows.points) < kFails) return "";
  if (misfit(rows.targets, mirrored(rows.points)) < kFits)
    return "the points x, y, z fit the positions X, Y, Z as a mirror image only: two of the columns x, y, z "
           "are "
           "exchanged, or one of them has the wrong sign; correct the headings or the sign in the file";
  const Eigen::Index rest = count - 1;
  for (const bool down : {true, false}) {
    const Points from = down ? rows.targets.leftCols(rest) : rows.targets.rightCols(rest),
                 to = down ? rows.points.rightCols(rest) : rows.points.leftCols(rest);
    if (misfit(from, to) >= kFits) continue;
    return fmt::format(
        "the points x, y, z fit the positions X, Y, Z of the row {} them, and not those of their own "
        "row: the two lists are shifted by one row; move the points in the file by one row",
        down ? "above" : "below");
  }
  return "";
}

}  // namespace

std::vector<SizeDoubt> judge_points(sheet::Sheet& sheet, const sheet::SheetTable& table,
                                    const std::vector<SizedColumn>& columns) {
  const auto rows = rows_of(sheet, table, columns);
  if (!rows || rows->targets.cols() < kFewestPoints || !maths::fixes_motion(rows->targets)) return {};
  const std::string fault = fault_of(*rows);
  if (fault.empty()) return {};
  const std::size_t k = rows->measured.front();
  if (columns[k].stated) {
    sheet.notes.push_back(fmt::format("\"{}\": {}", table.headings[k].text, fault));
    return {};
  }
  return {{k, sheet.line[table.heading_row], "",
           fmt::format("{}; if the table is right, give --column \"{}={}\"", fault, columns[k].name,
                       table.headings[k].text)}};
}

}  // namespace vernier::importer
