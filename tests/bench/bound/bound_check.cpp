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
