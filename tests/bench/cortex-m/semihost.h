// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <cstdint>

namespace vernier::bench {

// Armv7-M ARM B3.3: SysTick control, reload and current value.
inline volatile std::uint32_t& at(std::uint32_t address) {
  return *reinterpret_cast<volatile std::uint32_t*>(address);
}
inline std::uint32_t systick() { return at(0xe000e018); }
inline void start_systick() {
  at(0xe000e014) = 0xffffff;
  at(0xe000e018) = 0;
  at(0xe000e010) = 5;
}

// Semihosting (Arm IHI 0042): r0 the operation, r1 its argument.
inline std::uint32_t semihost(std::uint32_t operation, const void* argument) {
  register std::uint32_t r0 asm("r0") = operation;
  register const void* r1 asm("r1") = argument;
  asm volatile("bkpt 0xab" : "+r"(r0) : "r"(r1) : "memory");
  return r0;
}
inline void print(const char* text) { semihost(4, text); }
inline void print_hex(std::uint32_t value) {
  char text[9] = {};
  for (int i = 7; i >= 0; --i, value >>= 4) text[i] = "0123456789abcdef"[value & 15u];
  print(text);
}
[[noreturn]] inline void leave(std::uint32_t status) {
  const std::uint32_t block[2] = {0x20026, status};
  semihost(0x20, block);
  for (;;) {
  }
}

}  // namespace vernier::bench
