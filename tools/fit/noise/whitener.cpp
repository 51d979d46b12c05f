// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/fit/noise/whitener.h"

#include <cmath>

namespace vernier::fit {
namespace {

void begin(Eigen::MatrixXd& state, Eigen::Matrix3d& p, Eigen::Index which, double variance) {
  state.col(which).setZero();
  p.row(which).setZero();
  p.col(which).setZero();
  p(which, which) = variance;
}

double whiten(const NoiseSeries& series, const NoiseRatios& ratios, Eigen::MatrixXd& readings) {
  Eigen::MatrixXd state = Eigen::MatrixXd::Zero(readings.rows(), 3);
  Eigen::Matrix3d p = Eigen::Matrix3d::Zero();
  const double drift = is_drifting(ratios.drifts, series.kind) ? ratios.drift : 0;
  double log_det = 0;
  Eigen::VectorXd innovation(readings.rows());
  for (std::size_t i = 0; i < series.reading.size(); ++i) {
    const bool new_setup = i == 0 || series.setup[i] != series.setup[i - 1];
    if (new_setup) begin(state, p, 1, ratios.run);
    if (i == 0 || series.clock[i] != series.clock[i - 1]) {
      begin(state, p, 0, drift);
    } else if (drift > 0) {
      const double rho = std::exp(-passed(series, i, ratios.in_time) / ratios.time_constant);
      state.col(0) *= rho;
      p.row(0) *= rho;
      p.col(0) *= rho;
      p(0, 0) += (1 - rho * rho) * drift;
    }
    if (new_setup || series.pose[i] != series.pose[i - 1]) begin(state, p, 2, ratios.pose);
    const double variance = 1 + p.sum();
    const Eigen::Vector3d gain = p.rowwise().sum() / variance;
    auto reading = readings.col(series.reading[i]);
    innovation = reading - state.rowwise().sum();
    state.noalias() += innovation * gain.transpose();
    p -= variance * gain * gain.transpose();
    reading = innovation / std::sqrt(variance);
    log_det += std::log(variance);
  }
  return log_det;
}

}  // namespace

double whiten(const NoiseLayout& layout, const NoiseRatios& ratios, Eigen::MatrixXd& readings) {
  double log_det = 0;
  for (const NoiseSeries& series : layout.series) log_det += whiten(series, ratios, readings);
  return log_det;
}

}  // namespace vernier::fit
