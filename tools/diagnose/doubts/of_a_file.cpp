// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/diagnose/doubts/of_a_file.h"

#include <algorithm>

#include "tools/diagnose/doubts/shape.h"

namespace vernier::diagnose {
namespace {

constexpr int kDegrees = 3;  // of the polynomial: a drift that turns back once, and its rate

/// The time of the readings of a file from -1 to 1, 0 for the readings of other files.
Eigen::ArrayXd time_of_file(const Evidence& evidence, std::size_t file) {
  const model::Measurement& m = evidence.measurement();
  const Eigen::ArrayXd time = evidence.at_readings(m.states.time);
  std::vector<Eigen::Index> of_file;
  for (std::size_t i = 0; i < evidence.rows().size(); ++i)
    if (m.file[evidence.rows()[i]] == file) of_file.push_back(static_cast<Eigen::Index>(i));
  Eigen::ArrayXd result = Eigen::ArrayXd::Zero(time.size());
  if (of_file.size() < 2) return result;
  const auto by_time = [&](Eigen::Index a, Eigen::Index b) { return time[a] < time[b]; };
  const auto [first, last] = std::minmax_element(of_file.begin(), of_file.end(), by_time);
  const double low = time[*first], high = time[*last];
  for (std::size_t i = 0; i < of_file.size(); ++i)
    result[of_file[i]] = high > low
                             ? 2 * (time[of_file[i]] - low) / (high - low) - 1
                             : 2 * static_cast<double>(i) / static_cast<double>(of_file.size() - 1) - 1;
  return result;
}

/// Does a polynomial of `time` in the readings of one kind decrease the BIC by more than `least`?
bool drift_explains(const Evidence& evidence, const Eigen::ArrayXd& time, const Eigen::MatrixXd& beside,
                    double least) {
  const Eigen::MatrixXd offsets = evidence.offset_columns();
  for (Eigen::Index kind = 0; kind < offsets.cols(); ++kind) {
    Eigen::MatrixXd columns(offsets.rows(), kDegrees);
    columns.col(0) = offsets.col(kind).array() * time;
    for (int degree = 1; degree < kDegrees; ++degree)
      columns.col(degree) = columns.col(degree - 1).array() * time;
    if (!(columns.norm() > 0)) continue;
    evidence.whiten(columns);
    for (int degree = 1; degree <= kDegrees; ++degree)
      if (bic_decrease(evidence, columns.leftCols(degree), beside, 0) > least) return true;
  }
  return false;
}

}  // namespace

std::string file_whose_drift_explains(const Evidence& evidence, const Pool& pool, std::size_t item,
                                      const std::vector<std::size_t>& others, double distance) {
  const model::Measurement& m = evidence.measurement();
  if (pool.candidate(item).choice.inputs.empty() || m.files.size() < 2) return {};
  const Eigen::MatrixXd beside = pool.columns(others);
  const double named = bic_decrease_by(evidence, pool, item, beside);
  for (std::size_t file = 0; file < m.files.size(); ++file)
    if (drift_explains(evidence, time_of_file(evidence, file), beside, named - distance))
      return m.files[file];
  return {};
}

}  // namespace vernier::diagnose
