// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <cstdint>
#include <string>

#include "tools/registry/database.h"

namespace vernier::registry {

/// Functions that convert values to the cells of a database row, and cells to values. A NULL cell gives an
/// empty text or the number 0. If a cell does not contain a number, the functions for numbers throw
/// DatabaseError.
Cell cell(std::int64_t value);
Cell cell(double value);
std::string words(const Cell& cell);
std::int64_t whole(const Cell& cell);
double real(const Cell& cell);

}  // namespace vernier::registry
