// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <cstdint>
#include <string>

#include "tools/registry/database.h"

namespace vernier::registry {

/// Values as cells of a row, and back. A cell that is NULL reads as nothing: "", 0. Throw DatabaseError for
/// what is no number.
Cell cell(std::int64_t value);
Cell cell(double value);
std::string words(const Cell& cell);
std::int64_t whole(const Cell& cell);
double real(const Cell& cell);

}  // namespace vernier::registry
