// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <cmath>
#include <functional>
#include <numbers>
#include <random>
#include <set>
#include <string>
#include <vector>

#include "tools/model/measurement.h"

namespace vernier::test {

using namespace vernier::model;

inline constexpr double kPi = std::numbers::pi;

/// A run round a circle of 100 mm at constant speed, as a controller commands it and a bar measures it.
struct CircleRun {
  std::string label = "CCW";
  int sense = +1;
  double turns = 2;
  double true_rows = 1000;                           // per turn that the motion takes
  double claimed_rows = 1000;                        // per turn that the positions are computed with
  double true_start_deg = 0, claimed_start_deg = 0;  // angle of the first row
  std::set<std::size_t> lost = {};  // true rows whose reading was lost: what follows moves up
};

/// Radial residual, um, by true angle (deg), sense, and turns since the start.
using RadialError = std::function<double(double, int, double)>;

/// Rows and residuals (mm, what a fit would leave) of some runs. `noise` gives the um to add for each row.
struct CircleRecord {
  Measurement measurement;
  Eigen::VectorXd residual;
};

inline CircleRecord circle_record(const std::vector<CircleRun>& runs, const RadialError& error,
                                  const std::function<double()>& noise) {
  std::vector<double> x, y, value;
  std::vector<std::size_t> run;
  for (std::size_t k = 0; k < runs.size(); ++k) {
    const CircleRun& r = runs[k];
    std::size_t written = 0;
    for (std::size_t i = 0; static_cast<double>(i) < r.turns * r.true_rows; ++i) {
      const double turned = static_cast<double>(i) / r.true_rows, n = noise();
      if (r.lost.contains(i)) continue;
      const double claimed =
          (r.claimed_start_deg + 360 * r.sense * static_cast<double>(written++) / r.claimed_rows) * kPi / 180;
      x.push_back(100 * std::cos(claimed));
      y.push_back(100 * std::sin(claimed));
      const double angle = r.true_start_deg + 360 * r.sense * turned;
      value.push_back(1e-3 * (error(angle - 360 * std::floor(angle / 360), r.sense, turned) + n));
      run.push_back(k);
    }
  }
  CircleRecord record;
  Measurement& m = record.measurement;
  m.states = make_states(x.size(), 2, {});
  m.states.run = run;
  m.states.run_names.clear();
  for (const auto& r : runs) m.states.run_names.push_back(r.label);
  m.check.assign(x.size(), 0);
  record.residual.resize(static_cast<Eigen::Index>(x.size()));
  for (std::size_t i = 0; i < x.size(); ++i) {
    const auto row = static_cast<Eigen::Index>(i);
    m.states.axis[0][row] = x[i];
    m.states.axis[1][row] = y[i];
    m.observations.push_back({ObservationKind::kLength, i, 100 + value[i]});
    record.residual[row] = value[i];
  }
  return record;
}

/// A repeating motion error such as a robot's: many harmonics, random phases, falling in size; rms um.
inline RadialError repeating_error(std::uint64_t seed, double rms_um, int harmonics,
                                   double sense_part = 0.3) {
  std::mt19937_64 random(seed);
  std::normal_distribution<double> normal;
  std::vector<std::array<double, 4>> waves;
  double power = 0;
  for (int k = 2; k < harmonics; ++k) {
    const double size = 1 / std::sqrt(1 + k / 12.0);
    waves.push_back({size * normal(random), size * normal(random), sense_part * size * normal(random),
                     sense_part * size * normal(random)});
    for (const double w : waves.back()) power += w * w / 2;
  }
  const double scale = rms_um / std::sqrt(power);
  return [waves, scale](double angle_deg, int sense, double) {
    double sum = 0;
    for (std::size_t k = 0; k < waves.size(); ++k) {
      const double at = static_cast<double>(k + 2) * angle_deg * kPi / 180;
      sum += (waves[k][0] + sense * waves[k][2]) * std::cos(at) +
             (waves[k][1] + sense * waves[k][3]) * std::sin(at);
    }
    return scale * sum;
  };
}

}  // namespace vernier::test
