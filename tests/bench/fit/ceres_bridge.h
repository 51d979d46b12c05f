// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <string>
#include <vector>

#include "tests/bench/fit/bridge_survey.h"

namespace vernier::bench {

/// One state of a solver on its way.
struct Waypoint {
  double seconds = 0;  // processor time of the thread since the start, set-up of the problem included
  double cost = 0;     // sum of squared weighted residuals
};

/// Where a solver has been; it ends where its own stop rule says, at most 100 iterations.
struct Race {
  std::vector<Waypoint> way;
  bool converged = false;
};

/// Processor time of the calling thread, s.
double thread_seconds();

/// kBest: hand-written derivatives, sparse normal Cholesky, initial radius 1e8. kDefaults: automatic
/// derivatives, sparse normal Cholesky, initial radius 1e4. Both stop at the library's default, a relative
/// fall of the cost of 1e-6.
enum class Configuration { kBest, kDefaults };

/// The survey written for Ceres by hand: one cost function a point (three residuals), a block of six for each
/// station and each BaseShift.
Race race_ceres(const Survey& survey, Configuration configuration);

}  // namespace vernier::bench
