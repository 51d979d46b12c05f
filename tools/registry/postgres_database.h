// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <memory>
#include <string>

#include "tools/registry/database.h"

namespace vernier::registry {

/// Opens a registry on a PostgreSQL server. `address`: address in the form `postgresql://…` of libpq. Throws
/// DatabaseError if the server is not available.
std::unique_ptr<Database> open_postgres(const std::string& address);

}  // namespace vernier::registry
