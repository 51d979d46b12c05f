// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/registry/postgres_database.h"

#include <libpq-fe.h>

#include <charconv>
#include <string_view>

#include "tools/registry/cells.h"
#include "tools/text/words.h"

namespace vernier::registry {
namespace {

class PostgresDatabase : public Database {
 public:
  explicit PostgresDatabase(const std::string& address)
      : connection_(PQconnectdb(address.c_str()), PQfinish) {
    if (PQstatus(connection_.get()) != CONNECTION_OK) fail();
    // Notices ("relation exists, skipping") are not reported.
    PQsetNoticeProcessor(
        connection_.get(), [](void*, const char*) {}, nullptr);
  }

  std::vector<Row> run(const std::string& sql, const std::vector<Cell>& values) override {
    std::vector<const char*> texts;
    for (const Cell& value : values) texts.push_back(value ? value->c_str() : nullptr);
    const std::unique_ptr<PGresult, decltype(&PQclear)> result(
        PQexecParams(connection_.get(), sql.c_str(), static_cast<int>(texts.size()), nullptr, texts.data(),
                     nullptr, nullptr, 0),
        PQclear);
    const ExecStatusType status = PQresultStatus(result.get());
    if (status != PGRES_COMMAND_OK && status != PGRES_TUPLES_OK) fail();
    const std::string_view count = PQcmdTuples(result.get());
    written_ = 0;
    std::from_chars(count.data(), count.data() + count.size(), written_);
    std::vector<Row> rows(static_cast<std::size_t>(PQntuples(result.get())));
    for (std::size_t i = 0; i < rows.size(); ++i)
      for (int column = 0; column < PQnfields(result.get()); ++column)
        rows[i].push_back(cell_of(result.get(), static_cast<int>(i), column));
    return rows;
  }
  std::int64_t written() const override { return written_; }
  const char* begin() const override { return "BEGIN"; }
  const char* skip_locked() const override { return " FOR UPDATE SKIP LOCKED"; }
  std::int64_t now_us() override {
    const auto rows = run("SELECT CAST(EXTRACT(EPOCH FROM clock_timestamp()) * 1000000 AS BIGINT)", {});
    return whole(rows.at(0).at(0));
  }
  std::string name() const override {
    return "PostgreSQL " + std::string(PQparameterStatus(connection_.get(), "server_version")) + ", " +
           PQdb(connection_.get());
  }

 private:
  [[noreturn]] void fail() const {
    throw DatabaseError("PostgreSQL: " + text::trimmed(PQerrorMessage(connection_.get())));
  }
  static Cell cell_of(const PGresult* result, int row, int column) {
    if (PQgetisnull(result, row, column) != 0) return {};
    return std::string(PQgetvalue(result, row, column),
                       static_cast<std::size_t>(PQgetlength(result, row, column)));
  }

  std::unique_ptr<PGconn, decltype(&PQfinish)> connection_;
  std::int64_t written_ = 0;
};

}  // namespace

std::unique_ptr<Database> open_postgres(const std::string& address) {
  return std::make_unique<PostgresDatabase>(address);
}

}  // namespace vernier::registry
