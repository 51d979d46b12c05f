// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <memory>
#include <string>

#include "tools/registry/database.h"

namespace vernier::registry {

/// Opens a database. If `place` has the form `postgresql://…`, it is the address of a server. Any other
/// `place` is the path of a file, which is created if it does not exist. Throws InputError if the server or
/// the file is not available, or is not a database.
std::unique_ptr<Database> open_database(const std::string& place);

/// True if `place` is the address of a database server, which may be unavailable for some time.
bool is_server(const std::string& place);

}  // namespace vernier::registry
