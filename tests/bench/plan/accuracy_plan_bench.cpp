// SPDX-License-Identifier: GPL-3.0-or-later
// How many poses a plan for accuracy needs where it matters, beside random poses and the lines of ISO 230-1
// and 230-6, each over the whole volume and over the region alone; and whether a fit of all rows then keeps
// what was promised. Machines of three linear axes, drawn, of which a first, coarse survey is at hand; the
// region is a drawn third of every travel. Arguments: machines, seed.
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdlib>
#include <random>
#include <vector>

#include "tests/bench/plan/drawn_machine.h"
#include "tools/fit/coverage/point_readings.h"
#include "tools/fit/coverage/reach.h"
#include "tools/fit/fit.h"
#include "tools/maths/decompositions.h"
#include "tools/model/chain/chain.h"
#include "tools/model/chain/prediction.h"
#include "tools/plan/accuracy/accuracy_aim.h"
#include "tools/plan/accuracy/accuracy_plan.h"
#include "tools/plan/offered_poses.h"

namespace {

using namespace vernier;
using namespace vernier::fit;
using namespace vernier::model;
using namespace vernier::plan;
using Random = std::mt19937_64;

constexpr double kReadingUm = 3, kExpectedUm = 30;
constexpr std::size_t kFirst = 40, kMostPoses = 4000;

Measurement read_at(const Machine& truth, const States& poses, Random& random) {
  std::normal_distribution<double> normal(0, 1e-3 * kReadingUm);
  Measurement rows = point_readings(poses);
  rows.uncertainty = Column::Constant(static_cast<Eigen::Index>(poses.count), 1e-3 * kReadingUm);
  const Eigen::VectorXd ideal = predict(truth, rows);
  for (std::size_t i = 0; i < rows.observations.size(); ++i)
    rows.observations[i].value = ideal[static_cast<Eigen::Index>(i)] + normal(random);
  return rows;
}

/// Mean square of the fitted machine's error over the region but for a rigid motion, um^2.
double error_square(const Machine& fitted, const Machine& truth, const Machine& region) {
  const States fresh = offered_poses(region, 150, 7919);
  const Eigen::Matrix3Xd off = forward(fitted, fresh).position - forward(truth, fresh).position;
  const Eigen::MatrixXd motions = rigid_motions(forward(region, fresh).position);
  Eigen::VectorXd rest = off.reshaped();
  rest -= motions * maths::least_squares(motions, rest);
  return 1e6 * rest.squaredNorm() / static_cast<double>(off.cols());
}

double median(std::vector<double> values) {
  std::sort(values.begin(), values.end());
  return values[values.size() / 2];
}

}  // namespace

int main(int argc, char** argv) {
  const int machines = argc > 1 ? std::atoi(argv[1]) : 50;
  const auto seed = static_cast<std::uint64_t>(argc > 2 ? std::atoll(argv[2]) : 1);
  fmt::print("seed {}\n{:>8} {:>8} {:>6} {:>7} {:>7} {:>8} {:>8} {:>9} {:>9} {:>7}\n", seed, "now um",
             "U95 um", "plan", "random", "ISO", "random-r", "ISO-r", "promised", "kept", "ratio");
  std::array<std::vector<double>, 4> shares;  // of random and ISO over the volume, over the region
  double promised = 0, kept = 0;
  std::size_t beyond = 0;
  for (int i = 0; i < machines; ++i) {
    Random random(seed * 1000003 + static_cast<std::uint64_t>(i));
    const Machine machine = bench::drawn_machine(random);
    const Machine truth = bench::true_machine(machine, kExpectedUm, random);
    const Measurement first = read_at(truth, bench::anywhere(machine, kFirst, random), random);
    const FitResult at_hand = fit::fit(machine, first);
    const Knowledge knowledge = knowledge_of(at_hand, first);
    AccuracyAim aim;
    for (std::size_t a = 0; a < machine.axes.size(); ++a) {
      const double low = *machine.axes[a].min, span = *machine.axes[a].max - low;
      const double from = low + bench::between(0, 2.0 / 3, random) * span;
      aim.region.push_back({a, from, from + span / 3});
    }
    const Machine region = with_region(machine, aim.region);
    AccuracyOptions options;
    const double now = expected_accuracy_um(knowledge, aim, bench::first_of(first.states, 0));
    options.accuracy_um = now / 2;
    options.most = 400;
    const AccuracyPlan plan = accuracy_plan(knowledge, aim, options);
    const auto needed = [&](const auto& poses, std::size_t most) {
      return bench::fewest(most, plan.after_um, [&](std::size_t count) {
        return expected_accuracy_um(knowledge, aim, poses(count));
      });
    };
    const States even = bench::anywhere(machine, kMostPoses, random),
                 near = bench::anywhere(region, kMostPoses, random);
    constexpr std::size_t kLines = 14;  // three axes and four diagonals, both ways
    const std::array<std::size_t, 4> others = {
        needed([&](std::size_t n) { return bench::first_of(even, n); }, kMostPoses),
        kLines * needed([&](std::size_t n) { return bench::iso_lines(machine, n); }, kMostPoses / kLines),
        needed([&](std::size_t n) { return bench::first_of(near, n); }, kMostPoses),
        kLines * needed([&](std::size_t n) { return bench::iso_lines(region, n); }, kMostPoses / kLines)};
    for (std::size_t k = 0; k < others.size(); ++k) {
      shares[k].push_back(static_cast<double>(plan.states.count) / static_cast<double>(others[k]));
      beyond += others[k] + kLines > kMostPoses ? 1 : 0;
    }
    Measurement all = first;
    append_measurement(all, read_at(truth, plan.states, random));
    const double square = error_square(fit::fit(machine, all).machine, truth, region);
    promised += plan.after_um * plan.after_um, kept += 4 * square;
    fmt::print("{:>8.2f} {:>8.2f} {:>6} {:>7} {:>7} {:>8} {:>8} {:>9.2f} {:>9.2f} {:>7.3f}\n", plan.now_um,
               plan.after_um, plan.states.count, others[0], others[1], others[2], others[3], plan.after_um,
               2 * std::sqrt(square), plan.after_um / 2 / std::sqrt(square));
    std::fflush(stdout);
  }
  fmt::print(
      "poses of the plan over random ones, median {:.3f}, over ISO 230 lines {:.3f}; both in the region "
      "alone {:.3f}, "
      "{:.3f} ({} families of {} do not get there with {} poses)\n",
      median(shares[0]), median(shares[1]), median(shares[2]), median(shares[3]), beyond, 4 * machines,
      kMostPoses);
  fmt::print("promised over kept, rms over {} machines: {:.3f}\n", machines, std::sqrt(promised / kept));
  return 0;
}
