// SPDX-License-Identifier: Apache-2.0
#include "firmware/daemon/report.h"

#include <cerrno>
#include <cstdio>
#include <cstdlib>
#include <memory>
#include <new>

#include "hal/support/output_file.h"

namespace vernier {
namespace {

double us(std::int64_t ns) { return static_cast<double>(ns) * 1e-3; }

void print_histogram(std::FILE* out, const char* name, const Histogram& h) {
  std::fprintf(out, "%-22s p50 %7.2f  p99 %7.2f  p99.9 %7.2f  max %9.2f us\n", name,
               us(h.percentile_ns(500000)), us(h.percentile_ns(990000)), us(h.percentile_ns(999000)),
               us(h.max_ns()));
}

void print_json(std::FILE* out, const Histogram& h) {
  std::fprintf(out, "{\"p50\": %.3f, \"p99\": %.3f, \"p999\": %.3f, \"max\": %.3f, \"count\": %llu}",
               us(h.percentile_ns(500000)), us(h.percentile_ns(990000)), us(h.percentile_ns(999000)),
               us(h.max_ns()), static_cast<unsigned long long>(h.count()));
}

struct Counter {
  const char* name;
  std::uint64_t value;
};

void print_result(std::FILE* out, const TickTimes& times, const Cycle& cycle, const GrantReport& grant) {
  const Health& h = cycle.health();
  std::fprintf(out, "{\n \"equation\": \"%s\",\n",
               cycle.program().compensator.printed() ? "printed" : "executed");
  std::fprintf(out, " \"mode\": \"%s\",\n \"fault\": \"%s\",\n", name_of(cycle.mode()),
               name_of(cycle.latched()));
  const Counter counters[] = {{"ticks", h.ticks},
                              {"active_ticks", h.active_ticks},
                              {"overruns", h.overruns},
                              {"skipped", h.skipped},
                              {"missing_readings", h.missing_readings},
                              {"missing_inputs", h.missing_inputs},
                              {"unreferenced", h.unreferenced},
                              {"implausible", h.implausible},
                              {"failed_writes", h.failed_writes},
                              {"saturated", h.saturated},
                              {"slewing", h.slewing},
                              {"beyond_range", h.beyond_range},
                              {"faults", h.faults},
                              {"programs", h.programs}};
  for (const Counter& counter : counters)
    std::fprintf(out, " \"%s\": %llu,\n", counter.name, static_cast<unsigned long long>(counter.value));
  const auto word = [](bool yes) { return yes ? "true" : "false"; };
  std::fprintf(out, " \"realtime\": {\"fifo\": %s, \"locked\": %s, \"awake\": %s},\n", word(grant.fifo),
               word(grant.locked), word(grant.awake));
  std::fputs(" \"latency_us\": ", out);
  print_json(out, times.latency);
  std::fputs(",\n \"execution_us\": ", out);
  print_json(out, times.execution);
  std::fputs("\n}\n", out);
}

std::string result_text(const TickTimes& times, const Cycle& cycle, const GrantReport& grant) {
  char* text = nullptr;
  std::size_t size = 0;
  std::FILE* const out = ::open_memstream(&text, &size);
  if (out == nullptr) throw std::bad_alloc();
  print_result(out, times, cycle, grant);
  std::fclose(out);
  const std::unique_ptr<char, decltype(&std::free)> owned(text, &std::free);
  return {text, size};
}

}  // namespace

bool report_run(const Runner& runner, const Cycle& cycle, const GrantReport& grant, const std::string& json) {
  const Health& health = cycle.health();
  std::FILE* const people = json == "-" ? stderr : stdout;
  std::fprintf(
      people, "%llu ticks, %llu overruns, mode %s, fault %s\n", static_cast<unsigned long long>(health.ticks),
      static_cast<unsigned long long>(health.overruns), name_of(cycle.mode()), name_of(cycle.latched()));
  print_histogram(people, "wake-up latency", runner.times().latency);
  print_histogram(people, "execution of a tick", runner.times().execution);
  return write_result(json, result_text(runner.times(), cycle, grant));
}

bool write_result(const std::string& json, const std::string& text) {
  std::error_code failed;
  if (json == "-") {
    if (std::fputs(text.c_str(), stdout) == EOF || std::fflush(stdout) != 0)
      failed = {errno, std::generic_category()};
  } else if (!json.empty()) {
    failed = write_output(json, text);
  }
  if (failed) std::fprintf(stderr, "vernierd: %s: %s\n", json.c_str(), failed.message().c_str());
  return !failed;
}

}  // namespace vernier
