// SPDX-License-Identifier: GPL-3.0-or-later
// The tick on an emulated Cortex-M4 or M7: instructions per tick by SysTick, and the hash that the host must
// print too. Bare metal on the MPS2 AN386 and AN500 boards (Arm DAI 0386): code and data in the 4 MB SRAM at
// 0, semihosting for the text.
#include <cstdint>

#include "tables/checksum.h"
#include "tests/bench/cortex-m/semihost.h"
#include "tests/bench/poses.h"

extern "C" const std::uint8_t bench_image[];
extern "C" const std::uint8_t bench_image_end[];

namespace {

#ifndef BENCH_TICKS
#define BENCH_TICKS 200
#endif
constexpr int kTicks = BENCH_TICKS;

using namespace vernier::bench;

vernier::ImageWorkspace workspace;
vernier::ImageView view;
alignas(vernier::Compensator) unsigned char memory[sizeof(vernier::Compensator)];

}  // namespace

void* operator new(std::size_t, void* place) noexcept { return place; }

int main() {
  const auto size = static_cast<std::uint32_t>(bench_image_end - bench_image);
  const vernier::ImageFault fault = view.open(bench_image, size, workspace);
  if (fault != vernier::ImageFault::kNone) {
    print(vernier::describe(fault));
    leave(1);
  }
  auto& compensator = *new (memory) vernier::Compensator(view.program());
  vernier::bench::Poses poses(view);
  start_systick();
  std::uint64_t hash = vernier::kFnvSeed;
  std::uint64_t total = 0;
  std::uint32_t worst = 0;
  for (int i = 0; i < kTicks; ++i) {
    const vernier::CycleInput input = poses.next();
    const std::uint32_t before = systick();
    const vernier::CycleOutput output = compensator.step(input);
    const std::uint32_t spent = (before - systick()) & 0xffffff;
    total += spent;
    worst = spent > worst ? spent : worst;
    hash = vernier::bench::mixed(hash, output);
  }
  print("hash ");
  print_hex(static_cast<std::uint32_t>(hash >> 32));
  print_hex(static_cast<std::uint32_t>(hash));
  print(" systick_total ");
  print_hex(static_cast<std::uint32_t>(total >> 32));
  print_hex(static_cast<std::uint32_t>(total));
  print(" systick_worst ");
  print_hex(worst);
  print("\n");
  leave(0);
}
