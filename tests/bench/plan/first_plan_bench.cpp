// SPDX-License-Identifier: GPL-3.0-or-later
// How many poses a first plan needs for an uncertainty, beside random poses and beside lines and body
// diagonals as ISO 230-1 and 230-6 walk them; and whether a fit then keeps what the plan promised. Machines
// of three linear axes, drawn: order of the axes, travels, stations, which columns are free. Arguments:
// machines, seed.
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdlib>
#include <random>
#include <string>
#include <vector>

#include "tests/bench/plan/drawn_machine.h"
#include "tools/fit/coverage/point_readings.h"
#include "tools/fit/coverage/reach.h"
#include "tools/fit/fit.h"
#include "tools/maths/decompositions.h"
#include "tools/model/chain/chain.h"
#include "tools/model/chain/prediction.h"
#include "tools/model/machine_reader.h"
#include "tools/plan/first_plan.h"
#include "tools/plan/offered_poses.h"

namespace {

using namespace vernier;
using namespace vernier::fit;
using namespace vernier::model;
using namespace vernier::plan;
using Random = std::mt19937_64;

constexpr double kReadingUm = 3;

constexpr std::size_t kMost = 4000;

/// Fewest poses of a family that grows that reach an uncertainty.
template <typename Poses>
std::size_t needed(const Machine& machine, double um, const FirstPlanOptions& options, const Poses& poses) {
  return bench::fewest(
      kMost, um, [&](std::size_t count) { return planned_uncertainty_um(machine, poses(count), options); });
}

/// Squares of the tool point's error over the volume after a fit to the plan's poses, um^2; rigid motion
/// taken out.
double realised(const Machine& machine, const FirstPlan& plan, const FirstPlanOptions& options,
                Random& random) {
  std::normal_distribution<double> normal(0, 1e-3 * kReadingUm);
  const Machine truth = bench::true_machine(machine, options.expected_um, random);
  std::vector<std::size_t> fit_rows;
  for (std::size_t i = 0; i < plan.check.size(); ++i)
    if (plan.check[i] == 0) fit_rows.push_back(i);
  Measurement rows = point_readings(select_states(plan.states, fit_rows));
  rows.uncertainty = Column::Constant(static_cast<Eigen::Index>(fit_rows.size()), 1e-3 * kReadingUm);
  const Eigen::VectorXd ideal = predict(truth, rows);
  for (std::size_t i = 0; i < rows.observations.size(); ++i)
    rows.observations[i].value = ideal[static_cast<Eigen::Index>(i)] + normal(random);
  const FitResult fitted = fit::fit(machine, rows);
  // Where the plan judges itself.
  const States fresh = offered_poses(machine, 150, 7919);
  const Eigen::Matrix3Xd off = forward(fitted.machine, fresh).position - forward(truth, fresh).position;
  // The best small motion: what is left of the error after translation and rotation.
  const Eigen::Matrix3Xd at = forward(machine, fresh).position;
  const Eigen::MatrixXd motions = rigid_motions(at);
  Eigen::VectorXd rest = Eigen::Map<const Eigen::VectorXd>(off.data(), off.size());
  rest -= motions * maths::least_squares(motions, rest);
  return 1e6 * rest.squaredNorm() / static_cast<double>(off.cols());
}

}  // namespace

int main(int argc, char** argv) {
  const int machines = argc > 1 ? std::atoi(argv[1]) : 50;
  const auto seed = static_cast<std::uint64_t>(argc > 2 ? std::atoll(argv[2]) : 1);
  fmt::print("seed {}\n{:>8} {:>6} {:>6} {:>6} {:>7} {:>9} {:>9} {:>9}\n", seed, "U95 um", "plan", "random",
             "pool", "ISO 230", "promised", "kept", "ratio");
  std::vector<double> to_random, to_pool, to_lines;
  double promised = 0, kept = 0;
  for (int i = 0; i < machines; ++i) {
    Random random(seed * 1000003 + static_cast<std::uint64_t>(i));
    const Machine machine = bench::drawn_machine(random);
    FirstPlanOptions options;
    options.reading_um = kReadingUm;
    options.accuracy_um = 2 * kReadingUm;
    const FirstPlan plan = first_plan(machine, options);
    const auto chosen = static_cast<std::size_t>(std::count(plan.check.begin(), plan.check.end(), 0));
    std::vector<std::size_t> shuffled(kMost);
    for (std::size_t k = 0; k < kMost; ++k) shuffled[k] = k;
    std::shuffle(shuffled.begin(), shuffled.end(), random);
    const States offered = select_states(offered_poses(machine, kMost, 0), shuffled),
                 even = bench::anywhere(machine, kMost, random);
    const std::size_t by_pool =
        needed(machine, plan.after_um, options, [&](std::size_t n) { return bench::first_of(offered, n); });
    const std::size_t by_chance =
        needed(machine, plan.after_um, options, [&](std::size_t n) { return bench::first_of(even, n); });
    const std::size_t places =
        needed(machine, plan.after_um, options, [&](std::size_t n) { return bench::iso_lines(machine, n); });
    const std::size_t by_lines = std::min(kMost, 14 * places);
    const double square = realised(machine, plan, options, random);
    // The first pose comes again, which the plan's own figure does not count.
    std::vector<std::size_t> read;
    for (std::size_t k = 0; k < plan.check.size(); ++k)
      if (plan.check[k] == 0) read.push_back(k);
    const double u95 = planned_uncertainty_um(machine, select_states(plan.states, read), options);
    promised += u95 * u95, kept += 4 * square;
    to_pool.push_back(static_cast<double>(chosen) / static_cast<double>(by_pool));
    to_random.push_back(static_cast<double>(chosen) / static_cast<double>(by_chance));
    to_lines.push_back(static_cast<double>(chosen) / static_cast<double>(by_lines));
    fmt::print("{:>8.2f} {:>6} {:>6} {:>6} {:>6}{} {:>9.2f} {:>9.2f} {:>9.3f}\n", plan.after_um, chosen,
               by_chance, by_pool, by_lines, by_lines == kMost ? "+" : " ", u95, 2 * std::sqrt(square),
               u95 / 2 / std::sqrt(square));
    std::fflush(stdout);
  }
  const auto median = [](std::vector<double> values) {
    std::sort(values.begin(), values.end());
    return values[values.size() / 2];
  };
  fmt::print(
      "poses of the plan over random ones, median {:.3f}; over random ones of its own pool {:.3f}; over ISO "
      "230 lines {:.3f}\n",
      median(to_random), median(to_pool), median(to_lines));
  fmt::print("promised over kept, rms over {} machines: {:.3f}\n", machines, std::sqrt(promised / kept));
  return 0;
}
