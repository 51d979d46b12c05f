// SPDX-License-Identifier: GPL-3.0-or-later
// How many poses a first plan needs for an uncertainty, beside random poses and beside lines and body
// diagonals as ISO 230-1 and 230-6 walk them; and whether a fit then keeps what the plan promised. Machines
// of three linear axes, drawn: order of the axes, travels, stations, which columns are free. Arguments:
// machines, seed.
#include <fmt/format.h>

#include <Eigen/QR>
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdlib>
#include <random>
#include <string>
#include <vector>

#include "tools/fit/fit.h"
#include "tools/fit/reach.h"
#include "tools/model/chain.h"
#include "tools/model/machine_reader.h"
#include "tools/model/prediction.h"
#include "tools/plan/first_plan.h"
#include "tools/plan/offered_poses.h"

namespace {

using namespace vernier;
using namespace vernier::fit;
using namespace vernier::model;
using namespace vernier::plan;
using Random = std::mt19937_64;

constexpr double kReadingUm = 3;

double between(double low, double high, Random& random) {
  return low + (high - low) * std::uniform_real_distribution<double>(0, 1)(random);
}

Machine drawn_machine(Random& random) {
  std::array<char, 3> order = {'X', 'Y', 'Z'};
  std::shuffle(order.begin(), order.end(), random);
  std::string axes, tables, chain;
  for (std::size_t i = 0; i < 3; ++i) {
    const char axis = order[i];
    const double travel = std::round(between(200, 1200, random));
    axes += fmt::format("<{} min=\"0\" max=\"{}\"/>", axis, travel);
    std::string columns;
    for (const char* column : {"X", "Y", "Z", "rX", "rY", "rZ"})
      if (between(0, 1, random) < 0.6) columns += (columns.empty() ? "" : " ") + std::string(column);
    const int stations = static_cast<int>(between(3, 6.99, random));
    tables += fmt::format("<table axis=\"{}\" fit=\"{}\">", axis, columns);
    for (int k = 0; k < stations; ++k)
      tables += fmt::format("<station loc=\"{}\"/>", travel * k / (stations - 1));
    tables += "</table>";
    chain += "<sixdof";
    for (const char direction : {'X', 'Y', 'Z'})
      chain += fmt::format(" {}=\"l{}{}{}{}\"", direction, axis, static_cast<char>(direction + 32),
                           direction == axis ? "+" : "", direction == axis ? std::string(1, axis) : "");
    for (const char turn : {'X', 'Y', 'Z'})
      chain += fmt::format(" r{}=\"r{}{}{}\"", turn, axis, static_cast<char>(turn + 32),
                           i == 0 ? "" : fmt::format("+s{}{}", axis, turn));
    chain += "/>";
  }
  std::string statics;
  for (std::size_t i = 1; i < 3; ++i)
    for (const char turn : {'X', 'Y', 'Z'})
      statics += fmt::format("<s{}{} value=\"0\" nominal=\"0\" unit=\"deg\"/>", order[i], turn);
  return parse_machine("<machine name=\"drawn\"><variables><static>" + statics +
                           "<BaseShift/></static><machineaxes>" + axes + "</machineaxes><comptables>" +
                           tables + "</comptables></variables><transforms branch=\"tool\">" + chain +
                           "<sixdof Z=\"-150\"/></transforms></machine>",
                       "drawn.xml");
}

States first_of(const States& states, std::size_t count) {
  std::vector<std::size_t> which(count);
  for (std::size_t i = 0; i < count; ++i) which[i] = i;
  return select_states(states, which);
}

/// Lines along every axis through the middle, and the four body diagonals, there and back, `each` places on
/// each.
States lines(const Machine& machine, std::size_t each) {
  std::vector<std::array<double, 3>> places;
  std::vector<double> senses;
  const auto walk = [&](const std::array<double, 3>& from, const std::array<double, 3>& to) {
    for (const double sense : {1.0, -1.0})
      for (std::size_t k = 0; k < each; ++k) {
        const double s = each == 1 ? 0.5 : static_cast<double>(k) / static_cast<double>(each - 1);
        std::array<double, 3> at{};
        for (std::size_t a = 0; a < 3; ++a) at[a] = from[a] + s * (to[a] - from[a]);
        places.push_back(at);
        senses.push_back(sense);
      }
  };
  for (std::size_t a = 0; a < 3; ++a) {
    std::array<double, 3> from{0.5, 0.5, 0.5}, to = from;
    from[a] = 0, to[a] = 1;
    walk(from, to);
  }
  for (int diagonal = 0; diagonal < 4; ++diagonal) {
    const double y = diagonal & 1, z = diagonal >> 1;
    walk({0, y, z}, {1, 1 - y, 1 - z});
  }
  States states = make_states(places.size(), 3, {});
  make_one_run(states, "");
  for (std::size_t i = 0; i < places.size(); ++i)
    for (std::size_t a = 0; a < 3; ++a) {
      const auto at = static_cast<Eigen::Index>(i);
      states.axis[a][at] =
          *machine.axes[a].min + places[i][a] * (*machine.axes[a].max - *machine.axes[a].min);
      states.direction[a][at] = senses[i];
    }
  return states;
}

/// Evenly drawn over the axes' ranges, either sense.
States anywhere(const Machine& machine, std::size_t count, Random& random) {
  States states = make_states(count, machine.axes.size(), {});
  make_one_run(states, "");
  for (std::size_t i = 0; i < count; ++i)
    for (std::size_t a = 0; a < machine.axes.size(); ++a) {
      const auto at = static_cast<Eigen::Index>(i);
      states.axis[a][at] = between(*machine.axes[a].min, *machine.axes[a].max, random);
      states.direction[a][at] = between(-1, 1, random) < 0 ? -1 : 1;
    }
  return states;
}

constexpr std::size_t kMost = 4000;

/// Fewest poses, of a family that grows, that reach an uncertainty: bisection, since more poses never know
/// less.
template <typename Poses>
std::size_t needed(const Machine& machine, double um, const FirstPlanOptions& options, const Poses& poses) {
  std::size_t low = 1, high = 1;
  while (high < kMost && planned_uncertainty_um(machine, poses(high), options) > um) low = high, high *= 2;
  if (high >= kMost) return kMost;
  while (high - low > 1) {
    const std::size_t middle = (low + high) / 2;
    (planned_uncertainty_um(machine, poses(middle), options) > um ? low : high) = middle;
  }
  return high;
}

/// A machine as far off as the plan expects: every parameter moves the tool point by 100 um rms, drawn.
Machine true_machine(const Machine& machine, const FirstPlanOptions& options, Random& random) {
  std::normal_distribution<double> normal(0, 1);
  Machine truth = machine;
  const Measurement rows = point_readings(offered_poses(machine, 400, 5000));
  const ParameterSet parameters(truth, {""});
  const Eigen::MatrixXd all(linearise(machine, rows, parameters).jacobian);
  Eigen::VectorXd values = parameters.get(truth);
  for (Eigen::Index j = 0; j < all.cols(); ++j) {
    const double size = all.col(j).norm() / std::sqrt(400.0);
    if (size > 0) values[j] = 1e-3 * options.expected_um / size * normal(random);
  }
  parameters.set(truth, values);
  return truth;
}

/// Squares of the tool point's error over the volume after a fit to the plan's poses, um^2; rigid motion
/// taken out.
double realised(const Machine& machine, const FirstPlan& plan, const FirstPlanOptions& options,
                Random& random) {
  std::normal_distribution<double> normal(0, 1e-3 * kReadingUm);
  const Machine truth = true_machine(machine, options, random);
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
  rest -= motions * motions.colPivHouseholderQr().solve(rest);
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
    const Machine machine = drawn_machine(random);
    FirstPlanOptions options;
    options.reading_um = kReadingUm;
    options.accuracy_um = 2 * kReadingUm;
    const FirstPlan plan = first_plan(machine, options);
    const auto chosen = static_cast<std::size_t>(std::count(plan.check.begin(), plan.check.end(), 0));
    std::vector<std::size_t> shuffled(kMost);
    for (std::size_t k = 0; k < kMost; ++k) shuffled[k] = k;
    std::shuffle(shuffled.begin(), shuffled.end(), random);
    const States offered = select_states(offered_poses(machine, kMost, 0), shuffled),
                 even = anywhere(machine, kMost, random);
    const std::size_t by_pool =
        needed(machine, plan.after_um, options, [&](std::size_t n) { return first_of(offered, n); });
    const std::size_t by_chance =
        needed(machine, plan.after_um, options, [&](std::size_t n) { return first_of(even, n); });
    const std::size_t places =
        needed(machine, plan.after_um, options, [&](std::size_t n) { return lines(machine, n); });
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
