// SPDX-License-Identifier: GPL-3.0-or-later
// The dense form with vectors of 256 bits, in place of that of the library.
#include <cstdio>
#include <cstdlib>

#include "comp/dense.cpp"

static_assert(VERNIER_THREE_TABLES == 1);

namespace {
// Without such a processor no test of this program runs.
const bool supported = [] {
  if (!__builtin_cpu_supports("avx2")) {
    std::printf("Skipped: no vectors of 256 bits on this processor\n");
    std::_Exit(0);
  }
  return true;
}();
}  // namespace
