// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#ifdef VERNIER_WITH_BENCHMARK
#include <benchmark/benchmark.h>
#endif

#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <functional>
#include <string>
#include <vector>

namespace vernier::bench {

/// One thing to measure: `run(n)` does it n times, the loop included. Results must go through keep().
struct Case {
  std::string name;
  std::function<void(std::size_t n)> run;
};

/// Makes the compiler believe that a value is used.
template <class T>
inline void keep(const T& value) {
  asm volatile("" : : "g"(&value) : "memory");
}

}  // namespace vernier::bench

/// callgrind collects inside this function alone.
extern "C" __attribute__((noinline)) inline void bench_counted(const vernier::bench::Case& c, std::size_t n) {
  c.run(n);
}

namespace vernier::bench {

/// `list`: the names; `count NAME N`: runs a case N times (under callgrind); `time [flags]`: Google Benchmark
/// over all cases. Returns the exit status.
inline int measure(const std::vector<Case>& cases, int argc, char** argv) {
  const std::string mode = argc > 1 ? argv[1] : "";
  if (mode == "list") {
    for (const Case& c : cases) std::printf("%s\n", c.name.c_str());
    return 0;
  }
  if (mode == "count" && argc == 4) {
    for (const Case& c : cases)
      if (c.name == argv[2]) return bench_counted(c, static_cast<std::size_t>(std::atoll(argv[3]))), 0;
    return std::fprintf(stderr, "no case %s\n", argv[2]), 1;
  }
  if (mode != "time") return std::fprintf(stderr, "usage: list | count CASE N | time [benchmark flags]\n"), 1;
#ifdef VERNIER_WITH_BENCHMARK
  for (const Case& c : cases)
    benchmark::RegisterBenchmark(c.name.c_str(), [&c](benchmark::State& state) {
      constexpr std::size_t kBatch = 64;
      while (state.KeepRunningBatch(kBatch)) c.run(kBatch);
    });
  --argc, ++argv;
  benchmark::Initialize(&argc, argv);
  benchmark::RunSpecifiedBenchmarks();
  return 0;
#else
  return std::fprintf(stderr, "built without Google Benchmark\n"), 1;
#endif
}

}  // namespace vernier::bench
