// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <cstdint>

namespace vernier::workbench {

/// Returns s since an arbitrary moment, never decreasing: for durations.
double steady_s();
/// Returns s since 1970: for dates.
std::int64_t unix_s();

}  // namespace vernier::workbench
