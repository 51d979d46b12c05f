// SPDX-License-Identifier: GPL-3.0-or-later
// libFuzzer's door to the one target that is linked with it.
#include "tests/fuzz/target.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  vernier::fuzz::targets().front().take({data, size});
  return 0;
}
