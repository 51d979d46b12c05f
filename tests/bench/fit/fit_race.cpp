// SPDX-License-Identifier: GPL-3.0-or-later
// The own least squares against Ceres: a three-axis bridge with station tables, five set-ups and a tool, the
// same data, one thread, processor time. Each solver runs in a process of its own, so that its peak memory is
// its own. Two figures count: the time to the solver's own stop, and the time until its cost is within 1e-6
// of the own solver's end. "the same held" fixes for Ceres what the own solver found unseen and left at its
// start; without that it goes on along directions that only products of errors show, for a cost that falls by
// about one unit (one variance) each.
// Arguments: stations of a table, points, [one] the same target in all set-ups, [far] set-ups unknown at the
// start.

#include <fmt/format.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cstdlib>
#include <cstring>
#include <functional>
#include <optional>
#include <string>

#include "tests/bench/fit/bridge_survey.h"
#include "tests/bench/fit/ceres_bridge.h"
#include "tools/fit/fit.h"

namespace {

using namespace vernier;
using namespace vernier::fit;
using namespace vernier::bench;

struct Outcome {
  Race race;
  double seconds = 0;     // all that was asked for
  double memory_MiB = 0;  // peak of its process, the survey included
};

/// Runs `what` in a process of its own. Exits where that fails.
Outcome in_its_own_process(const std::function<Race()>& what) {
  int ends[2];
  if (pipe(ends) != 0) std::exit(70);
  const pid_t child = fork();
  if (child < 0) std::exit(70);
  if (child == 0) {
    const double from = thread_seconds();
    const Race race = what();
    const double head[3] = {static_cast<double>(race.way.size()), race.converged ? 1.0 : 0.0,
                            thread_seconds() - from};
    bool written = write(ends[1], head, sizeof head) == sizeof head;
    for (const Waypoint& point : race.way)
      written = written && write(ends[1], &point, sizeof point) == sizeof point;
    _exit(written ? 0 : 1);
  }
  close(ends[1]);
  Outcome outcome;
  double head[3] = {};
  if (read(ends[0], head, sizeof head) != sizeof head) std::exit(70);
  outcome.race.converged = head[1] != 0;
  outcome.seconds = head[2];
  outcome.race.way.resize(static_cast<std::size_t>(head[0]));
  for (Waypoint& point : outcome.race.way)
    if (read(ends[0], &point, sizeof point) != sizeof point) std::exit(70);
  close(ends[0]);
  int status = 0;
  rusage usage{};
  if (wait4(child, &status, 0, &usage) != child || status != 0) std::exit(70);
  outcome.memory_MiB = static_cast<double>(usage.ru_maxrss) / 1024;
  return outcome;
}

Race race_own(const Survey& survey) {
  Race race;
  const double from = thread_seconds();
  FitOptions options;
  options.progress = [&](int, double cost) { race.way.push_back({thread_seconds() - from, cost}); };
  race.converged = fit::fit(survey.start, survey.readings, options).converged;
  return race;
}

std::optional<double> time_to(const Race& race, double cost) {
  for (const Waypoint& point : race.way)
    if (point.cost <= cost) return point.seconds;
  return std::nullopt;
}

void print(const char* name, const Outcome& outcome, double target, double best_s) {
  const auto there = time_to(outcome.race, target);
  const Waypoint& end = outcome.race.way.back();
  const std::string reached = there ? fmt::format("{:8.3f} s", *there) : "     never";
  const std::string ratio = there && best_s > 0 ? fmt::format("{:5.2f}", *there / best_s) : "    -";
  fmt::print("{:<34} {} {} {:9.3f} s {:9.3f} s {:4} {:14.4f} {:8.0f} MiB{}\n", name, reached, ratio,
             end.seconds, outcome.seconds, outcome.race.way.size(), end.cost, outcome.memory_MiB,
             outcome.race.converged ? "" : "  stopped at 100");
}

}  // namespace

int main(int argc, char** argv) {
  const auto stations = argc > 1 ? std::strtoull(argv[1], nullptr, 10) : 26;
  const auto points = argc > 2 ? std::strtoull(argv[2], nullptr, 10) : 5000;
  Targets targets = Targets::kFiveTargets;
  Start start = Start::kAligned;
  for (int i = 3; i < argc; ++i) {
    if (std::strcmp(argv[i], "one") == 0) targets = Targets::kOneTarget;
    if (std::strcmp(argv[i], "far") == 0) start = Start::kFar;
  }
  constexpr std::uint64_t kSeed = 1;
  const Survey survey = make_survey(stations, points, targets, start, kSeed);
  const FitResult known = fit::fit(survey.start, survey.readings);
  const double target = known.chi_square * (1 + 1e-6);
  fmt::print("{} parameters ({} seen), {} points, seed {}, {}, {}\n", known.parameters.size(),
             known.observability.rank, points, kSeed,
             targets == Targets::kOneTarget ? "one target" : "five targets",
             start == Start::kFar ? "set-ups unknown" : "set-ups aligned");
  const Outcome own = in_its_own_process([&] { return race_own(survey); });
  const Outcome best = in_its_own_process([&] { return race_ceres(survey, Configuration::kBest); });
  const Outcome plain = in_its_own_process([&] { return race_ceres(survey, Configuration::kDefaults); });
  double best_s = 1e300;
  if (const auto there = time_to(best.race, target)) best_s = *there;
  if (best_s == 1e300) best_s = 0;
  fmt::print("{:<34} {:>10} {:>5} {:>11} {:>11} {:>4} {:>14} {:>12}\n", "", "same cost", "ratio", "own stop",
             "in all", "it", "cost", "peak");
  print("own, no derivative written", own, target, best_s);
  print("Ceres best, all free", best, target, best_s);
  print("Ceres automatic derivatives", plain, target, best_s);
  return 0;
}
