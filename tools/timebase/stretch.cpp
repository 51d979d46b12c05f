// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/timebase/stretch.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "tools/maths/chance.h"

namespace vernier::timebase {
namespace {

using Block = Eigen::MatrixXd;
using Index = Eigen::Index;

double autocorrelation(const Block& a, Index lag) {
  const double all = a.squaredNorm();
  return all > 0 ? a.topRows(a.rows() - lag).cwiseProduct(a.bottomRows(a.rows() - lag)).sum() / all : 0;
}

}  // namespace

std::optional<Block> stretch(const Eigen::MatrixXd& series, Index first, Index rows) {
  if (first < 0 || first + rows > series.rows()) return std::nullopt;
  Block block = series.middleRows(first, rows);
  if (!block.allFinite()) return std::nullopt;
  const Eigen::ArrayXd place = Eigen::ArrayXd::LinSpaced(rows, -1, 1);
  const double norm = place.square().sum();
  for (Index c = 0; c < block.cols(); ++c) {
    const double mean = block.col(c).mean();
    const double slope = (block.col(c).array() * place).sum() / norm;
    block.col(c).array() -= mean + slope * place;
  }
  return block;
}

double concordance(const Block& a, const Block& b) {
  const double sum = a.squaredNorm() + b.squaredNorm();
  return sum > 0 ? 2 * a.cwiseProduct(b).sum() / sum : 0;
}

double effective_rows(const Block& a, const Block& b) {
  double sum = 1;
  for (Index k = 1; k < a.rows() / 2; ++k) sum += 2 * std::abs(autocorrelation(a, k) * autocorrelation(b, k));
  return static_cast<double>(a.size()) / sum;
}

// With so few independent rows no probability is known: the spreads below divide by the roots of rows - 3 and
// of rows - 2.
constexpr double kLeastRows = 4;

double chance_of_agreement(double correlation, double rows) {
  if (rows <= kLeastRows) return 1;
  constexpr double kBelowOne = 1e-12;  // below a correlation of 1, whose transform is infinite
  return maths::upper_tail(std::atanh(std::min(correlation, 1 - kBelowOne)) * std::sqrt(rows - 3));
}

double chance_of_ratio(double larger, double smaller, double rows) {
  if (rows <= kLeastRows || smaller <= 0) return larger > 0 && smaller <= 0 ? 0 : 1;
  return maths::upper_tail(std::log(larger / smaller) * std::sqrt(rows - 2));
}

}  // namespace vernier::timebase
