// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <memory>
#include <string>

#include "tools/registry/database.h"

namespace vernier::registry {

/// Opens a database: `postgresql://…` is a server, anything else a file, made where it is not. Throws
/// InputError where it cannot be reached or is none.
std::unique_ptr<Database> open_database(const std::string& place);

/// Is this the address of a server, which may be away for a while?
bool is_server(const std::string& place);

}  // namespace vernier::registry
