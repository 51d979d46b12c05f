// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/workbench/runs/now.h"

#include <chrono>

namespace vernier::workbench {

double steady_s() {
  return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count();
}

std::int64_t unix_s() {
  return std::chrono::duration_cast<std::chrono::seconds>(std::chrono::system_clock::now().time_since_epoch())
      .count();
}

}  // namespace vernier::workbench
