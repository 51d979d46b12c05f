// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <cstdint>
#include <string>

#include "tools/registry/database.h"

namespace vernier::registry {

/// Converts values to cells of a row, and back. A NULL cell is read as an empty value: "", 0. Throw
/// DatabaseError if a cell is not a number.
Cell cell(std::int64_t value);
Cell cell(double value);
std::string words(const Cell& cell);
std::int64_t whole(const Cell& cell);
double real(const Cell& cell);

}  // namespace vernier::registry
