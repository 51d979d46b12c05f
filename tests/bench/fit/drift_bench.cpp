// SPDX-License-Identifier: GPL-3.0-or-later
// The likelihood of a drift: readings of one series with an error that is correlated in time, whitened by the
// filter of tools/fit/noise. Processor time of one evaluation, the shortest and the median of 101.
// Arguments: rows (16384), columns of fitted parameters beside the residual (0).

#include <fmt/format.h>

#include <algorithm>
#include <cstdlib>
#include <random>
#include <vector>

#include "tests/bench/fit/ceres_bridge.h"
#include "tools/fit/noise/whitener.h"

int main(int argc, char** argv) {
  using namespace vernier;
  const auto rows = static_cast<Eigen::Index>(argc > 1 ? std::strtoull(argv[1], nullptr, 10) : 16384);
  const auto columns = static_cast<Eigen::Index>(argc > 2 ? std::strtoull(argv[2], nullptr, 10) : 0);
  constexpr std::uint64_t kSeed = 1;
  std::mt19937_64 random(kSeed);
  std::normal_distribution<double> normal;
  fit::NoiseLayout layout;
  fit::NoiseSeries series;
  double time = 0;
  for (Eigen::Index i = 0; i < rows; ++i) {
    time += 1 + 0.2 * std::abs(normal(random));  // s
    series.reading.push_back(i);
    series.time.push_back(time);
    series.row.push_back(static_cast<std::size_t>(i));
    series.setup.push_back(static_cast<int>(4 * i / rows));
    series.clock.push_back(0);
    series.pose.push_back(static_cast<int>(i));
  }
  layout.series = {series};
  Eigen::MatrixXd readings(columns + 1, rows);
  for (double& value : readings.reshaped()) value = normal(random);
  fit::NoiseRatios drift, all;
  drift.drift = all.drift = 4;
  drift.time_constant = all.time_constant = 300;
  drift.in_time = all.in_time = true;
  all.run = 0.5;
  all.pose = 0.3;
  for (const auto& [name, ratios] : {std::pair{"drift", drift}, {"drift, run and pose", all}}) {
    std::vector<double> seconds;
    double log_det = 0;
    for (int i = 0; i < 101; ++i) {
      Eigen::MatrixXd whitened = readings;
      const double from = bench::thread_seconds();
      log_det = fit::whiten(layout, ratios, whitened);
      seconds.push_back(bench::thread_seconds() - from);
    }
    std::sort(seconds.begin(), seconds.end());
    fmt::print("{:<20} {} rows, {} columns: shortest {:.2f} ms, median {:.2f} ms (log det {:.6f})\n", name,
               rows, columns + 1, 1e3 * seconds.front(), 1e3 * seconds[seconds.size() / 2], log_det);
  }
  return 0;
}
