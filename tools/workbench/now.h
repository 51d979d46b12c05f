// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <cstdint>

namespace vernier::workbench {

/// s since some moment, never back: for durations. tool.
double steady_s();
/// s since 1970: for dates. tool.
std::int64_t unix_s();

}  // namespace vernier::workbench
