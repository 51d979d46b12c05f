// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/registry/open_database.h"

#include "tools/registry/postgres_database.h"
#include "tools/registry/sqlite_database.h"
#include "tools/text/error.h"

namespace vernier::registry {

bool is_server(const std::string& place) {
  return place.starts_with("postgresql://") || place.starts_with("postgres://");
}

std::unique_ptr<Database> open_database(const std::string& place) {
  try {
    if (is_server(place)) return open_postgres(place);
    return open_sqlite(place);
  } catch (const DatabaseError& error) {
    throw text::InputError({}, place, error.what());
  }
}

}  // namespace vernier::registry
