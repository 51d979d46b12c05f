// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <cstdint>
#include <optional>
#include <stdexcept>
#include <string>
#include <vector>

namespace vernier::registry {

/// A value in a database row, as text; nullopt: NULL.
using Cell = std::optional<std::string>;
using Row = std::vector<Cell>;

/// The database has failed or is not available. The present transaction was not executed.
class DatabaseError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// A database that contains the registry. All statements use the common syntax of SQLite (3.35 and later) and
/// PostgreSQL.
class Database {
 public:
  virtual ~Database() = default;
  /// Executes one statement with the values for $1, $2, ... and returns its rows. Throws DatabaseError if the
  /// statement fails.
  virtual std::vector<Row> run(const std::string& sql, const std::vector<Cell>& values = {}) = 0;
  /// Returns the number of rows that the last statement wrote.
  virtual std::int64_t written() const = 0;
  /// Returns the statement that begins a transaction with write access.
  virtual const char* begin() const = 0;
  /// Returns the clause with which a SELECT skips rows that another caller has locked; empty if writers wait
  /// for each other.
  virtual const char* skip_locked() const = 0;
  /// Returns the time in microseconds since 1970 by the clock of the database (for a file, of this computer).
  /// All callers therefore use the same clock. Throws DatabaseError if the database is not available.
  virtual std::int64_t now_us() = 0;
  /// Returns a name for people: "PostgreSQL 15.8 at ...".
  virtual std::string name() const = 0;
};

/// A database transaction. The transaction is undone if commit() is not called.
class Transaction {
 public:
  explicit Transaction(Database& database) : database_(database) { database_.run(database_.begin()); }
  ~Transaction();
  Transaction(const Transaction&) = delete;
  Transaction& operator=(const Transaction&) = delete;
  void commit() {
    database_.run("COMMIT");
    done_ = true;
  }

 private:
  Database& database_;
  bool done_ = false;
};

/// Throws InputError if a database has tables but no table with the name `ours`, because the database then
/// belongs to another program.
void refuse_foreign(Database& database, const std::string& ours);

/// Inserts many rows with as few statements as possible: "INSERT INTO … (…)" + rows + tail. All rows must
/// have the same number of cells.
void insert_rows(Database& database, const std::string& head, const std::vector<Row>& rows,
                 const std::string& tail);

}  // namespace vernier::registry
