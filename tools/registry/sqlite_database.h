// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <memory>
#include <string>

#include "tools/registry/database.h"

namespace vernier::registry {

/// The registry in a file. What is committed survives the program and, as far as the medium keeps its word,
/// the power. Throws DatabaseError.
std::unique_ptr<Database> open_sqlite(const std::string& file);

}  // namespace vernier::registry
