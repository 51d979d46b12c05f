// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <memory>
#include <string>

#include "tools/registry/database.h"

namespace vernier::registry {

/// The registry in a file. Committed data survive the end of the program and, if the medium is reliable, a
/// power failure. Throws DatabaseError.
std::unique_ptr<Database> open_sqlite(const std::string& file);

}  // namespace vernier::registry
