// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <memory>
#include <string>

#include "tools/registry/database.h"

namespace vernier::registry {

/// Opens a registry in a file (SQLite). Committed data remain after the end of the program and, if the
/// storage medium is reliable, after a power failure. Throws DatabaseError if the file cannot be opened.
std::unique_ptr<Database> open_sqlite(const std::string& file);

}  // namespace vernier::registry
