// SPDX-License-Identifier: GPL-3.0-or-later
// `host`: the hash that every target must print. `list`, `count CASE N`: for callgrind, as tests/bench/run
// does.
#include "tests/bench/features/workload.h"
#include "tests/bench/kernels/counted.h"

using namespace vernier::bench;

int main(int argc, char** argv) {
  static VibrationLoad load;
  if (argc == 1) {
    for (const std::uint32_t samples : kLoadWindows) {
      if (!load.start(samples)) return 1;
      load.state = 1;
      for (std::uint32_t i = 0; i < samples + 100; ++i) load.push();
      for (int i = 0; i < 100; ++i) load.evaluate();
      for (int i = 0; i < 100; ++i) load.integrate();
    }
    std::printf("hash %016llx\n", static_cast<unsigned long long>(load.hash));
    return 0;
  }
  std::vector<Case> cases;
  for (const std::uint32_t samples : kLoadWindows) {
    const auto begin = [samples](std::size_t n) {
      if (n > 0 && load.weights.window != samples) load.start(samples);
    };
    const std::string text = " " + std::to_string(samples);
    cases.push_back({"sample" + text, [begin](std::size_t n) {
                       begin(n);
                       for (std::size_t i = 0; i < n; ++i) load.push();
                     }});
    cases.push_back({"features" + text, [begin](std::size_t n) {
                       begin(n);
                       load.push();
                       for (std::size_t i = 0; i < n; ++i) load.evaluate();
                     }});
  }
  cases.push_back({"displacement", [](std::size_t n) {
                     load.displacement.start({});
                     for (std::size_t i = 0; i < n; ++i) load.integrate();
                   }});
  return measure(cases, argc, argv);
}
