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
vernier::DenseCell cells[8192];
vernier::DenseFrame frame;

/// Instructions of many ticks, in counts of SysTick, and the hash of their corrections.
struct Spent {
  std::uint64_t hash = vernier::kFnvSeed, total = 0;
  std::uint32_t worst = 0;
};

Spent ticks(vernier::Compensator& compensator) {
  vernier::bench::Poses poses(view);
  Spent all;
  for (int i = 0; i < kTicks; ++i) {
    const vernier::CycleInput input = poses.next();
    const std::uint32_t before = systick();
    const vernier::CycleOutput output = compensator.step(input);
    const std::uint32_t spent = (before - systick()) & 0xffffff;
    all.total += spent;
    all.worst = spent > all.worst ? spent : all.worst;
    all.hash = vernier::bench::mixed(all.hash, output);
  }
  return all;
}

}  // namespace

void* operator new(std::size_t, void* place) noexcept { return place; }

int main() {
  const auto size = static_cast<std::uint32_t>(bench_image_end - bench_image);
  const vernier::ImageFault fault = view.open(bench_image, size, workspace);
  if (fault != vernier::ImageFault::kNone) {
    print(vernier::describe(fault));
    leave(1);
  }
  start_systick();
  const Spent interpreted = ticks(*new (memory) vernier::Compensator(view.program()));
  auto& compensator = *new (memory) vernier::Compensator(view.program());
  if (!compensator.use_dense({cells, 8192, &frame})) {
    print("no memory for the dense form\n");
    leave(1);
  }
  const Spent dense = ticks(compensator);
  if (dense.hash != interpreted.hash) {
    print("the dense and the interpreted form differ\n");
    leave(1);
  }
  print("hash ");
  print_hex(static_cast<std::uint32_t>(dense.hash >> 32));
  print_hex(static_cast<std::uint32_t>(dense.hash));
  print(" systick_total ");
  print_hex(static_cast<std::uint32_t>(dense.total >> 32));
  print_hex(static_cast<std::uint32_t>(dense.total));
  print(" systick_worst ");
  print_hex(dense.worst);
  print(" interpreted_worst ");
  print_hex(interpreted.worst);
  print("\n");
  leave(0);
}
