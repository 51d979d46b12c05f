// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/diagnose/day.h"

#include <numbers>

#include "tools/diagnose/doubts/shape.h"

namespace vernier::diagnose {
namespace {

constexpr double kDay = 86400;  // s

/// Returns columns for each kind of reading: sine and cosine of the time of day.
std::vector<Eigen::MatrixXd> daily_shifts(const Evidence& evidence) {
  const Eigen::MatrixXd offsets = evidence.offset_columns();
  const Eigen::ArrayXd turn =
      2 * std::numbers::pi * evidence.at_readings(evidence.measurement().states.time) / kDay;
  std::vector<Eigen::MatrixXd> all;
  for (Eigen::Index kind = 0; kind < offsets.cols(); ++kind) {
    Eigen::MatrixXd columns(offsets.rows(), 2);
    columns.col(0) = offsets.col(kind).array() * turn.sin();
    columns.col(1) = offsets.col(kind).array() * turn.cos();
    evidence.whiten(columns);
    all.push_back(std::move(columns));
  }
  return all;
}

}  // namespace

bool daily_drift_explains(const Evidence& evidence, const Pool& pool, std::size_t item,
                          const std::vector<std::size_t>& others, double distance) {
  const Evidence::Range time = evidence.time_range();
  if (pool.candidate(item).choice.inputs.empty() || time.high <= time.low) return false;
  const Eigen::MatrixXd beside = pool.columns(others);
  const double named = bic_decrease_by(evidence, pool, item, beside);
  for (const Eigen::MatrixXd& shift : daily_shifts(evidence))
    if (bic_decrease(evidence, shift, beside, 0) > named - distance) return true;
  return false;
}

}  // namespace vernier::diagnose
