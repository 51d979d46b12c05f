// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <string>

namespace vernier::format {

/// True if the heading of a column states that the column counts the rows of its table or the points: Nr, No,
/// Lfd_Nr; column_ (the heading #). Such a column has no unit, and is no condition of a reading.
bool names_row_count(const std::string& name, const std::string& unit);

}  // namespace vernier::format
