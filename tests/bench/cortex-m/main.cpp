// The tick on an emulated Cortex-M4 or M7: instructions per tick by SysTick, and the hash that the host must
// print too. Bare metal on the MPS2 AN386 and AN500 boards (Arm DAI 0386): code and data in the 4 MB SRAM at
// 0, semihosting for the text.
#include <cstdint>

#include "tables/checksum.h"
#include "tests/bench/poses.h"

extern "C" const std::uint8_t bench_image[];
extern "C" const std::uint8_t bench_image_end[];

namespace {

#ifndef BENCH_TICKS
#define BENCH_TICKS 200
#endif
constexpr int kTicks = BENCH_TICKS;

// Armv7-M ARM B3.3: SysTick control, reload and current value.
volatile std::uint32_t& at(std::uint32_t address) {
  return *reinterpret_cast<volatile std::uint32_t*>(address);
}
std::uint32_t systick() { return at(0xe000e018); }
void start_systick() {
  at(0xe000e014) = 0xffffff;
  at(0xe000e018) = 0;
  at(0xe000e010) = 5;
}

// Semihosting (Arm IHI 0042): r0 the operation, r1 its argument.
std::uint32_t semihost(std::uint32_t operation, const void* argument) {
  register std::uint32_t r0 asm("r0") = operation;
  register const void* r1 asm("r1") = argument;
  asm volatile("bkpt 0xab" : "+r"(r0) : "r"(r1) : "memory");
  return r0;
}
void print(const char* text) { semihost(4, text); }
void print_hex(std::uint32_t value) {
  char text[9] = {};
  for (int i = 7; i >= 0; --i, value >>= 4) text[i] = "0123456789abcdef"[value & 15u];
  print(text);
}
[[noreturn]] void leave(std::uint32_t status) {
  const std::uint32_t block[2] = {0x20026, status};
  semihost(0x20, block);
  for (;;) {
  }
}

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
