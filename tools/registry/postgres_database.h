// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <memory>
#include <string>

#include "tools/registry/database.h"

namespace vernier::registry {

/// The registry on a server. address: libpq's `postgresql://…`. Throws DatabaseError.
std::unique_ptr<Database> open_postgres(const std::string& address);

}  // namespace vernier::registry
