// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <cstdint>

namespace vernier::workbench {

/// Returns the time in s since an arbitrary moment, for durations. The time never decreases.
double steady_s();
/// Returns the time in s since 1970, for dates.
std::int64_t unix_s();

}  // namespace vernier::workbench
