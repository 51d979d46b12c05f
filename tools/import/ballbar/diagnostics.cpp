// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/import/ballbar/diagnostics.h"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <numbers>
#include <numeric>
#include <stdexcept>

#include "tools/maths/decompositions.h"
#include "tools/maths/factors.h"

namespace vernier::importer {
namespace {

double sign(double x) { return x > 0 ? 1.0 : (x < 0 ? -1.0 : 0.0); }

// Direction of motion of both axes at an angle of the circle.
struct Senses {
  double a, b;
};

Senses senses(double angle_rad, int direction) {
  return {-direction * sign(std::sin(angle_rad)), direction * sign(std::cos(angle_rad))};
}

bool near_reversal(double angle_deg, double gap_deg) {
  const double in_quadrant = angle_deg - 90 * std::floor(angle_deg / 90);
  return std::min(in_quadrant, 90 - in_quadrant) < gap_deg;
}

// The cyclic columns: (axis, direction of the axis, direction of the circle) times cosine and sine.
constexpr std::size_t kCyclicPerAxis = 8;

void cyclic_columns(const DiagnosticsSample& sample, char axis, const DiagnosticsSetup& setup,
                    double* columns) {
  const double angle = sample.angle_deg * maths::kRadPerDeg;
  const Senses moving = senses(angle, sample.direction);
  const double along = axis == 'A' ? std::cos(angle) : std::sin(angle);
  const double pitch = axis == 'A' ? setup.pitch_a_mm : setup.pitch_b_mm;
  const double sense = axis == 'A' ? moving.a : moving.b;
  for (std::size_t i = 0; i < kCyclicPerAxis; ++i) columns[i] = 0;
  if (sense == 0) return;
  const std::size_t block = (sample.direction > 0 ? 0u : 4u) + (sense > 0 ? 0u : 2u);
  const double phase = 2 * std::numbers::pi * setup.radius_mm * along / pitch;
  columns[block] = std::cos(phase) * along;
  columns[block + 1] = std::sin(phase) * along;
}

std::vector<char> cyclic_axes(const DiagnosticsSetup& setup) {
  std::vector<char> axes;
  if (setup.pitch_a_mm > 0) axes.push_back('A');
  if (setup.pitch_b_mm > 0) axes.push_back('B');
  return axes;
}

Eigen::MatrixXd design(const std::vector<DiagnosticsSample>& samples, const DiagnosticsSetup& setup) {
  const std::vector<char> axes = cyclic_axes(setup);
  const std::size_t columns = kDiagnosticsCount + kCyclicPerAxis * axes.size();
  Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor> rows(samples.size(), columns);
  for (std::size_t i = 0; i < samples.size(); ++i) {
    double* row = rows.data() + i * columns;
    const auto basis = diagnostics_basis(samples[i].angle_deg, samples[i].direction, setup);
    std::copy(basis.begin(), basis.end(), row);
    for (std::size_t axis = 0; axis < axes.size(); ++axis) {
      cyclic_columns(samples[i], axes[axis], setup, row + kDiagnosticsCount + axis * kCyclicPerAxis);
    }
  }
  return rows;
}

// Over all samples, those at the reversals too.
CyclicEffect cyclic_effect(const std::vector<DiagnosticsSample>& samples, const DiagnosticsSetup& setup,
                           char axis, int direction, const double* amplitudes) {
  double low = HUGE_VAL, high = -HUGE_VAL;
  for (const auto& sample : samples) {
    if (sample.direction != direction) continue;
    std::array<double, kCyclicPerAxis> columns{};
    cyclic_columns(sample, axis, setup, columns.data());
    const double um = std::inner_product(columns.begin(), columns.end(), amplitudes, 0.0);
    low = std::min(low, um), high = std::max(high, um);
  }
  return {axis, direction, std::max(high - low, 0.0)};
}

}  // namespace

std::array<double, kDiagnosticsCount> diagnostics_basis(double angle_deg, int direction,
                                                        const DiagnosticsSetup& setup) {
  const double t = angle_deg * maths::kRadPerDeg, d = direction;
  const double c = std::cos(t), s = std::sin(t);
  const auto [va, vb] = senses(t, direction);
  const double radius_m = setup.radius_mm / 1000, speed_um_ms = setup.feed_mm_min / 60;  // mm/s = um/ms
  return {1,
          c,
          s,
          std::cos(2 * t) / 4,
          -radius_m / 2 * std::sin(2 * t),
          std::sin(3 * t) / 4,
          -std::cos(3 * t) / 4,
          d * speed_um_ms / 2 * std::sin(2 * t),
          d * std::sin(4 * t) / 2,
          d / 2,
          d * c / 2,
          d * s / 2,
          -va * c / 2,
          -va * c * c / 2,
          -vb * s / 2,
          -vb * s * s / 2,
          va * s / 2,
          va * s * c / 2,
          vb * c / 2,
          vb * c * s / 2};
}

DiagnosticsResult fit_diagnostics(const std::vector<DiagnosticsSample>& samples,
                                  const DiagnosticsSetup& setup) {
  std::vector<DiagnosticsSample> used;
  for (const auto& sample : samples) {
    if (!near_reversal(sample.angle_deg, setup.reversal_gap_deg)) used.push_back(sample);
  }
  const Eigen::MatrixXd basis = design(used, setup);
  if (basis.rows() < basis.cols()) throw std::invalid_argument("diagnostics: fewer samples than terms");
  Eigen::VectorXd deviation(basis.rows());
  for (std::size_t i = 0; i < used.size(); ++i)
    deviation[static_cast<Eigen::Index>(i)] = used[i].deviation_um;
  Eigen::CompleteOrthogonalDecomposition<Eigen::MatrixXd> solver;
  solver.setThreshold(1e-12);
  solver.compute(basis);
  const Eigen::VectorXd solution = solver.solve(deviation);
  const Eigen::VectorXd residual = deviation - basis * solution;

  DiagnosticsResult result;
  for (std::size_t i = 0; i < kDiagnosticsCount; ++i)
    result.value[i] = solution[static_cast<Eigen::Index>(i)];
  const std::vector<char> axes = cyclic_axes(setup);
  for (std::size_t i = 0; i < axes.size() * kCyclicPerAxis / 2; ++i) {
    const auto at = static_cast<Eigen::Index>(kDiagnosticsCount + 2 * i);
    const std::size_t block = i % 4;
    result.cyclic.push_back(
        {axes[i / 4], block % 2 == 0, block < 2 ? +1 : -1, 2 * std::hypot(solution[at], solution[at + 1])});
  }
  for (std::size_t i = 0; i < axes.size(); ++i)
    for (const int direction : {+1, -1})
      result.cyclic_effect.push_back(cyclic_effect(samples, setup, axes[i], direction,
                                                   solution.data() + kDiagnosticsCount + i * kCyclicPerAxis));
  result.samples = used.size();
  result.rank = static_cast<std::size_t>(solver.rank());
  result.columns = static_cast<std::size_t>(basis.cols());
  result.rms_um = std::sqrt(residual.squaredNorm() / static_cast<double>(used.size()));
  result.max_um = residual.cwiseAbs().maxCoeff();
  return result;
}

}  // namespace vernier::importer
