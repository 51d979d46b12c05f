// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/fit/coverage/far_rows.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <vector>

#include "tools/fit/least_squares/statistics.h"
#include "tools/maths/median.h"

namespace vernier::fit {
namespace {

using Eigen::Index;

constexpr double kFar = 50;          // times the median: beyond the errors of a machine
constexpr double kTrim = 5;          // times the median: rows that the set-up does not count
constexpr double kMostShare = 0.05;  // of the rows: more are no single mistakes
constexpr double kPair = 2;          // two interchanged rows are named in a short file too
constexpr std::size_t kFewestRows = 12;

/// The size of the residual of each row, mm; rotations do not count.
std::vector<double> sizes_of(const model::Machine& machine, const model::Measurement& m) {
  const Eigen::VectorXd residual = residuals(machine, m);
  std::vector<double> squares(m.rows(), 0);
  for (std::size_t i = 0; i < m.observations.size(); ++i)
    if (!model::is_rotation(m.observations[i].kind))
      squares[m.observations[i].row] += std::pow(residual[static_cast<Index>(i)], 2);
  for (double& one : squares) one = std::sqrt(one);
  return squares;
}

}  // namespace

std::string far_rows(const model::Measurement& m,
                     const std::function<model::Machine(const model::Measurement& rows)>& posed) {
  if (m.rows() < kFewestRows) return {};
  std::vector<double> sizes = sizes_of(posed(m), m);
  std::vector<std::size_t> near;
  const double first = maths::median(sizes);
  for (std::size_t row = 0; row < sizes.size(); ++row)
    if (sizes[row] <= kTrim * first) near.push_back(row);
  if (near.size() < kFewestRows) return {};
  sizes = sizes_of(posed(model::select_rows(m, near)), m);
  const double usual = maths::median(sizes);
  std::vector<std::size_t> far;
  for (std::size_t row = 0; row < sizes.size(); ++row)
    if (sizes[row] > kFar * usual) far.push_back(row);
  const auto most = std::max(kPair, kMostShare * static_cast<double>(m.rows()));
  if (far.empty() || static_cast<double>(far.size()) > most) return {};
  std::string names;
  for (const std::size_t row : far)
    names += fmt::format("{}{}:{} ({:.3g} mm)", names.empty() ? "" : ", ", m.files[m.file[row]], m.line[row],
                         sizes[row]);
  return fmt::format(
      "{} {} far from the rest, which agrees with the machine file to {:.2g} mm: are points interchanged, or "
      "are these rows of other points? Correct the rows, or leave them out (vernier exclude)",
      names, far.size() == 1 ? "is" : "are", usual);
}

}  // namespace vernier::fit
