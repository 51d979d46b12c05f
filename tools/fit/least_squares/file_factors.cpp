// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/fit/least_squares/file_factors.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "tools/fit/least_squares/statistics.h"
#include "tools/maths/chance.h"

namespace vernier::fit {
namespace {

/// Ratio of the factors of two files from which one factor for both would be wrong: as for files without u
/// (file_noise.cpp).
constexpr double kOtherFactor = 3;
/// Probability of a residual by chance, below which the model leaves an error in the file.
constexpr double kByChance = 1e-3;

double factor_of(const FittedAlone& alone) {
  if (alone.freedom < 1 || maths::chi_square_tail(alone.chi_square, alone.freedom) > kByChance) return 1;
  return std::max(1.0, std::sqrt(alone.chi_square / alone.freedom));
}

}  // namespace

std::string FileFactor::sentence() const {
  return fmt::format(
      "{}: the model leaves {:.3g} times the standard uncertainty u of the readings in this file alone, so "
      "their u counts {:.3g} times in the fit",
      name, factor, factor);
}

std::vector<FileFactor> file_factors(const model::Measurement& rows, const FitOfFile& fit) {
  std::vector<FileFactor> list;
  if (rows.files.size() < 2 || !has_uncertainty(rows)) return list;
  std::vector<std::vector<std::size_t>> rows_of(rows.files.size());
  std::vector<char> fitted(rows.files.size(), 0);
  for (std::size_t row = 0; row < rows.rows(); ++row) {
    rows_of[rows.file[row]].push_back(row);
    if (rows.check[row] == 0) fitted[rows.file[row]] = 1;
  }
  double least = std::numeric_limits<double>::infinity(), most = 0;
  for (std::size_t file = 0; file < rows_of.size(); ++file) {
    if (fitted[file] == 0) continue;
    const std::optional<FittedAlone> alone = fit(model::select_rows(rows, rows_of[file]));
    if (!alone) return {};
    list.push_back({file, rows.files[file], factor_of(*alone)});
    least = std::min(least, list.back().factor);
    most = std::max(most, list.back().factor);
  }
  if (!(most >= kOtherFactor * least)) list.clear();
  return list;
}

model::Measurement with_factors(const model::Measurement& rows, const std::vector<FileFactor>& factors) {
  model::Measurement weighed = rows;
  for (std::size_t row = 0; row < rows.rows(); ++row)
    for (const FileFactor& one : factors) {
      if (rows.file[row] != one.file) continue;
      const auto at = static_cast<Eigen::Index>(row);
      for (model::Column* const u : {&weighed.uncertainty, &weighed.angle_uncertainty})
        if (u->size() > 0) (*u)[at] *= one.factor;
    }
  return weighed;
}

}  // namespace vernier::fit
