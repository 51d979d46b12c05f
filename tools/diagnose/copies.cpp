// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/diagnose/copies.h"

#include <fmt/format.h>

#include <algorithm>

namespace vernier::diagnose {
namespace {

/// True if a column has the same numbers in a row and the row before, or does not exist.
bool is_repeated(const Eigen::Matrix3Xd& columns, Eigen::Index row) {
  return columns.cols() == 0 || columns.col(row) == columns.col(row - 1);
}

/// True if a row was read at the position of the row before, at the same point, in the same run and with the
/// same role.
bool is_at_the_same_stay(const model::Measurement& rows, std::size_t row) {
  const auto now = static_cast<Eigen::Index>(row);
  return rows.check[row] == rows.check[row - 1] && rows.states.run[row] == rows.states.run[row - 1] &&
         is_repeated(rows.centre, now) && is_repeated(rows.nominal_point, now) &&
         is_repeated(rows.direction, now) &&
         std::all_of(rows.states.axis.begin(), rows.states.axis.end(),
                     [&](const model::Column& axis) { return axis[now] == axis[now - 1]; });
}

}  // namespace

std::optional<WithoutCopies> without_copies(const model::Measurement& rows) {
  constexpr double kNearlyAll = 0.95;  // of the repeated rows: copies, and not a coarse resolution
  // A distance names a row at its other end.
  if (std::any_of(rows.other_end.begin(), rows.other_end.end(),
                  [](std::size_t other) { return other != model::kNoRow; }))
    return std::nullopt;
  std::vector<std::vector<double>> readings(rows.rows());
  for (const model::Observation& one : rows.observations) {
    readings[one.row].push_back(static_cast<double>(one.kind));
    readings[one.row].push_back(one.value);
  }
  WithoutCopies result;
  std::size_t repeated = 0;
  for (std::size_t row = 0; row < rows.rows(); ++row) {
    const bool same_stay = row > 0 && is_at_the_same_stay(rows, row);
    repeated += same_stay ? 1 : 0;
    if (!same_stay || readings[row] != readings[row - 1]) result.kept.push_back(row);
  }
  const std::size_t copies = rows.rows() - result.kept.size();
  if (copies == 0 || static_cast<double>(copies) < kNearlyAll * static_cast<double>(repeated))
    return std::nullopt;
  result.sentence =
      fmt::format("{} of {} rows repeat the previous row digit for digit; each repeated reading counts once.",
                  copies, rows.rows());
  return result;
}

}  // namespace vernier::diagnose
