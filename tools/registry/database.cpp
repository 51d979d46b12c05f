// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/registry/database.h"

#include <fmt/format.h>

#include <algorithm>

#include "tools/text/error.h"

namespace vernier::registry {

Transaction::~Transaction() {
  if (done_) return;
  try {
    database_.run("ROLLBACK");
  } catch (const DatabaseError&) {
    // A connection that is gone has taken its transaction with it.
  }
}

void refuse_foreign(Database& database, const std::string& ours) {
  const bool server = database.skip_locked()[0] != '\0';
  // A server may have other tables as well; a file belongs to one program.
  const std::string tables =
      server ? "SELECT tablename FROM pg_tables WHERE schemaname = ANY (current_schemas(false)) AND "
               "tablename IN ('machine', 'calibration', 'sample', 'live', 'job', 'rollout')"
             : "SELECT name FROM sqlite_master WHERE type = 'table'";
  const std::string own =
      server ? "SELECT 1 FROM pg_tables WHERE schemaname = ANY (current_schemas(false)) AND tablename = $1"
             : "SELECT 1 FROM sqlite_master WHERE name = $1";
  const std::vector<Row> found = database.run(tables);
  if (found.empty() || !database.run(own, {ours}).empty()) return;
  throw text::InputError(
      {}, database.name(),
      fmt::format("the database belongs to another program (it has the table {}): nothing is written",
                  found[0][0].value_or("")));
}

void insert_rows(Database& database, const std::string& head, const std::vector<Row>& rows,
                 const std::string& tail) {
  constexpr std::size_t kRowsAStatement = 64;
  for (std::size_t at = 0; at < rows.size(); at += kRowsAStatement) {
    const std::size_t end = std::min(at + kRowsAStatement, rows.size());
    std::string sql = head + " VALUES ";
    std::vector<Cell> values;
    for (std::size_t row = at; row < end; ++row) {
      sql += row == at ? "(" : ",(";
      for (std::size_t column = 0; column < rows[row].size(); ++column) {
        values.push_back(rows[row][column]);
        sql += (column == 0 ? "$" : ",$") + std::to_string(values.size());
      }
      sql += ")";
    }
    database.run(sql + " " + tail, values);
  }
}

}  // namespace vernier::registry
