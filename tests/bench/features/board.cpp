// SPDX-License-Identifier: GPL-3.0-or-later
// Cost of the accelerometer path on an emulated Cortex-M4, by SysTick, and the hash that the host must print
// too.
#include "tests/bench/cortex-m/semihost.h"
#include "tests/bench/features/workload.h"

using namespace vernier::bench;

namespace {

VibrationLoad load;

template <class Step>
void measure(const char* name, Step step) {
  constexpr std::uint32_t kTimes = 100;
  std::uint32_t worst = 0, total = 0;
  for (std::uint32_t i = 0; i < kTimes; ++i) {
    const std::uint32_t before = systick();
    step();
    const std::uint32_t spent = (before - systick()) & 0xffffff;
    total += spent;
    worst = spent > worst ? spent : worst;
  }
  print(name);
  print(" ");
  print_hex(total / kTimes);
  print(" ");
  print_hex(worst);
  print("\n");
}

}  // namespace

int main() {
  start_systick();
  for (const std::uint32_t samples : kLoadWindows) {
    if (!load.start(samples)) leave(1);
    load.state = 1;
    for (std::uint32_t i = 0; i < samples; ++i) load.push();
    print("window ");
    print_hex(samples);
    print("\n");
    measure("push", [] { load.push(); });
    measure("evaluate", [] { load.evaluate(); });
    measure("displacement", [] { load.integrate(); });
  }
  print("hash ");
  print_hex(static_cast<std::uint32_t>(load.hash >> 32));
  print_hex(static_cast<std::uint32_t>(load.hash));
  print("\n");
  leave(0);
}
