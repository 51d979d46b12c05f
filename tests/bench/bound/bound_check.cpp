// SPDX-License-Identifier: GPL-3.0-or-later
// bound_check [POSES [MACHINE...]]: the executed fixed-point program of each reference machine against the
// double chain of tools/model, 10^7 poses: seven tenths anywhere, the rest on stations, one count beside
// stations, and at the ends of the axes. Prints the proved bound of `vernier compile` beside what was seen,
// and fails where it does not hold.
#include <fmt/format.h>

#include <cstdio>
#include <cstdlib>

#include "tests/bench/reference/reference_machine.h"
#include "tests/unit/compile/agreement.h"

namespace vernier::bench {

using namespace vernier::compile;
using namespace vernier::model;
using namespace vernier::text;
namespace {

constexpr unsigned kSeed = 20261122;
constexpr std::size_t kBatch = 10000;

enum class Place { kAnywhere, kStation, kBesideStation, kEnd };

// Puts every axis of a pose where the place says; an axis without a table stays where it was drawn.
void put(const TestMachine& test, Place place, std::mt19937_64& random, CycleInput& pose) {
  for (std::size_t i = 0; i < test.machine.axes.size(); ++i) {
    const Axis& axis = test.machine.axes[i];
    const double unit = test.axis_unit(i);
    const std::int64_t low = std::llround(*axis.min / unit), high = std::llround(*axis.max / unit);
    std::int64_t& count = pose.axis[i].position.count;
    if (place == Place::kEnd) {
      count = random() % 2 == 0 ? low : high;
    } else if (const Table* const table = test.machine.table_of(i)) {
      count = std::llround(table->stations[random() % table->stations.size()].loc / unit);
      if (place == Place::kBesideStation) count += random() % 2 == 0 ? 1 : -1;
      count = std::clamp(count, low, high);
    }
  }
}

Place place_of(std::size_t pose) {
  const std::size_t tenth = pose % 10;
  return tenth == 7   ? Place::kStation
         : tenth == 8 ? Place::kBesideStation
         : tenth == 9 ? Place::kEnd
                      : Place::kAnywhere;
}

/// The error of the least squares at one pose if every operation had its largest error in the worst
/// direction, mm: the effect of each register on the tool point, from a run in which the register is moved. A
/// bound that holds at every pose cannot be smaller than this at any pose.
double worst_case_mm(const TestMachine& test, const Compensator& compensator,
                     const Eigen::Matrix3Xd& directions) {
  constexpr std::int32_t kMoved = 1 << 10;  // counts: far above the output's rounding, far below a bend
  const LoweredProgram& p = test.compiled.program;
  const Equation& whole = test.loaded->view.program().equation;
  EquationState state;
  compensator.state(state);
  std::vector<std::int32_t> start(kMaxRegisters);
  std::copy_n(whole.constants.data, whole.constants.size, start.begin());
  std::copy_n(state.channel, whole.channel_count, start.begin() + whole.first_channel());
  const auto run = [&](std::vector<std::int32_t>& registers, std::uint32_t from, std::uint32_t to,
                       std::uint32_t results) {
    Equation part = whole;
    part.instructions = {whole.instructions.data + from, to - from};
    part.channel_count += results;
    run_equation(part, registers.data(), state.lag, false);
  };
  const std::uint32_t count = whole.instructions.size;
  std::vector<std::int32_t> plain = start;
  run(plain, 0, count, 0);
  double sum = 0;
  const auto move = [&](std::uint32_t id, std::uint32_t from, std::uint32_t results) {
    if (p.registers[id].own_error == 0) return;
    std::vector<std::int32_t> moved = plain;
    moved[id] += moved[id] > 0 ? -kMoved : kMoved;
    run(moved, from, count, results);
    Eigen::VectorXd by(directions.cols());
    for (Eigen::Index k = 0; k < by.size(); ++k) {
      const std::uint32_t source = p.outputs[static_cast<std::size_t>(k)].source;
      by[k] =
          std::ldexp(static_cast<double>(moved[source] - plain[source]), -p.registers[source].fraction_bits);
    }
    sum += (directions * by).norm() * std::ldexp(p.registers[id].own_error, p.registers[id].fraction_bits) /
           kMoved;
  };
  for (std::uint32_t id = 0; id < p.first_result(); ++id) move(id, 0, 0);
  std::uint32_t results = 0;
  for (std::uint32_t i = 0; i < count; ++i) {
    const std::uint32_t own = p.results_of(p.instructions[i]);
    for (std::uint32_t k = 0; k < own; ++k) move(p.first_result() + results + k, i + 1, results + own);
    results += own;
  }
  return sum;
}

/// The largest of worst_case_mm over poses at which the correction is not reduced.
void print_worst_case(const TestMachine& test, std::mt19937_64& random) {
  constexpr std::size_t kDrawn = 20000, kLooked = 300;
  const std::vector<CycleInput> inputs = test.random_poses(kDrawn, random);
  const States states = test.states_of(inputs);
  std::vector<std::size_t> axes;
  for (const Output& out : test.compiled.program.outputs) axes.push_back(out.axis);
  const std::vector<Eigen::Matrix3Xd> moved = nominal_directions(test.machine, states, axes);
  const LeastSquares& least = *test.compiled.least_squares;
  std::vector<std::pair<double, std::size_t>> order;  // by the determinant
  const auto directions_at = [&](std::size_t i) {
    Eigen::Matrix3Xd directions(3, static_cast<Eigen::Index>(axes.size()));
    for (std::size_t k = 0; k < axes.size(); ++k)
      directions.col(static_cast<Eigen::Index>(k)) = moved[k].col(static_cast<Eigen::Index>(i));
    return directions;
  };
  for (std::size_t i = 0; i < inputs.size(); ++i) {
    Eigen::Matrix3Xd scaled = directions_at(i);
    for (std::size_t k = 0; k < axes.size(); ++k) scaled.col(static_cast<Eigen::Index>(k)) /= least.lever[k];
    const double determinant = (scaled * scaled.transpose()).determinant();
    if (determinant > least.floor * 1.001) order.emplace_back(determinant, i);
  }
  std::sort(order.begin(), order.end());
  double worst_um = 0;
  for (std::size_t n = 0; n < std::min(kLooked, order.size()); ++n) {
    Compensator compensator(test.loaded->view.program());
    compensator.step(inputs[order[n].second]);
    worst_um = std::max(worst_um, 1000 * worst_case_mm(test, compensator, directions_at(order[n].second)));
  }
  fmt::print(
      "{:<20} {:.4f} um with exact sensitivities and every rounding at its worst, {} poses nearest "
      "to singular of {}\n",
      "", worst_um, kLooked, kDrawn);
}

bool check(const std::string& name, std::size_t poses) {
  const TestMachine test(reference_machine(name), name);
  std::mt19937_64 random(kSeed);
  Agreement seen;
  for (std::size_t done = 0; done < poses; done += kBatch) {
    std::vector<CycleInput> inputs = test.random_poses(std::min(kBatch, poses - done), random);
    for (std::size_t i = 0; i < inputs.size(); ++i)
      if (place_of(i) != Place::kAnywhere) put(test, place_of(i), random, inputs[i]);
    compare_poses(test, inputs, seen);
  }
  OutputBound worst;
  for (const OutputBound& b : test.compiled.bounds)
    if (b.total_um > worst.total_um) worst = b;
  const double quantisation =
      worst.table_um + worst.function_um + worst.input_um + worst.rounding_um + worst.lag_um;
  fmt::print("{:<20} {:>10} {:>10.1f} {:>10.4f} {:>10.4f} {:>7.2f} {:>11.4f} {:>12.4f}\n", name, seen.poses,
             seen.largest_um, worst.total_um, seen.worst_um, worst.total_um / seen.worst_um,
             worst.linearisation_um, quantisation);
  if (test.compiled.least_squares) print_worst_case(test, random);
  std::fflush(stdout);
  return seen.worst_share <= 1;
}

}  // namespace
}  // namespace vernier::bench

int main(int argc, char** argv) {
  const std::size_t poses = argc > 1 ? static_cast<std::size_t>(std::atoll(argv[1])) : 10000000;
  std::vector<std::string> machines(argv + std::min(argc, 2), argv + argc);
  if (machines.empty())
    machines.assign(vernier::bench::kReferenceMachines.begin(), vernier::bench::kReferenceMachines.end());
  fmt::print("{:<20} {:>10} {:>10} {:>10} {:>10} {:>7} {:>11} {:>12}\n", "um", "poses", "deviation", "proved",
             "seen", "ratio", "truncation", "quantisation");
  bool holds = true;
  try {
    for (const std::string& name : machines) holds = vernier::bench::check(name, poses) && holds;
  } catch (const vernier::text::InputError& e) {
    return std::fprintf(stderr, "bound_check: %s\n", e.what()), 1;
  }
  if (!holds) std::printf("the proved bound does not hold\n");
  return holds ? 0 : 2;
}
