// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/registry/sqlite_database.h"

#include <sqlite3.h>

#include <unordered_map>

#include "tools/text/numbers.h"
#include "tools/text/wall_time.h"

namespace vernier::registry {
namespace {

constexpr int kBusyMs = 20'000;  // how long a writer waits
constexpr std::size_t kStatementsKept = 64;

class SqliteDatabase : public Database {
 public:
  explicit SqliteDatabase(const std::string& file) : file_(file) {
    if (sqlite3_open(file.c_str(), &handle_) != SQLITE_OK) {
      const std::string why = handle_ == nullptr ? "no memory" : sqlite3_errmsg(handle_);
      sqlite3_close(handle_);
      throw DatabaseError("cannot be opened: " + why);
    }
    try {
      sqlite3_busy_timeout(handle_, kBusyMs);
      run("PRAGMA journal_mode=WAL");
      run("PRAGMA synchronous=FULL");
    } catch (...) {
      close();
      throw;
    }
  }
  ~SqliteDatabase() override { close(); }
  SqliteDatabase(const SqliteDatabase&) = delete;
  SqliteDatabase& operator=(const SqliteDatabase&) = delete;

  std::vector<Row> run(const std::string& sql, const std::vector<Cell>& values) override {
    sqlite3_stmt* const statement = prepared(sql);
    for (std::size_t i = 0; i < values.size(); ++i) bind(statement, i, values[i]);
    std::vector<Row> rows;
    int code = SQLITE_ROW;
    while ((code = sqlite3_step(statement)) == SQLITE_ROW) rows.push_back(row_of(statement));
    const std::string why = code == SQLITE_DONE ? "" : sqlite3_errmsg(handle_);
    sqlite3_reset(statement);
    sqlite3_clear_bindings(statement);
    if (code != SQLITE_DONE) throw DatabaseError(file_ + ": " + why);
    return rows;
  }
  std::vector<Row> run(const std::string& sql) { return run(sql, {}); }
  std::int64_t written() const override { return sqlite3_changes(handle_); }
  const char* begin() const override { return "BEGIN IMMEDIATE"; }
  const char* skip_locked() const override { return ""; }
  std::int64_t now_us() override { return text::now_us(); }
  std::string name() const override { return std::string("SQLite ") + sqlite3_libversion() + ", " + file_; }

 private:
  sqlite3_stmt* prepared(const std::string& sql) {
    if (const auto found = statements_.find(sql); found != statements_.end()) return found->second;
    if (statements_.size() >= kStatementsKept) forget();
    sqlite3_stmt* statement = nullptr;
    if (sqlite3_prepare_v2(handle_, sql.c_str(), static_cast<int>(sql.size()), &statement, nullptr) !=
        SQLITE_OK)
      throw DatabaseError(file_ + ": " + sqlite3_errmsg(handle_));
    return statements_[sql] = statement;
  }
  void bind(sqlite3_stmt* statement, std::size_t at, const Cell& value) {
    // "$2" is a name to SQLite, numbered in the order in which names first appear in the text.
    const int index = sqlite3_bind_parameter_index(statement, ("$" + std::to_string(at + 1)).c_str());
    const int code = !value ? sqlite3_bind_null(statement, index)
                            : sqlite3_bind_text64(statement, index, value->data(), value->size(),
                                                  SQLITE_TRANSIENT, SQLITE_UTF8);
    if (code != SQLITE_OK) throw DatabaseError(file_ + ": " + sqlite3_errmsg(handle_));
  }
  static Row row_of(sqlite3_stmt* statement) {
    Row row;
    for (int i = 0; i < sqlite3_column_count(statement); ++i) {
      // As a text the library would give 15 digits.
      if (sqlite3_column_type(statement, i) == SQLITE_FLOAT) {
        row.emplace_back(text::number_text(sqlite3_column_double(statement, i)));
        continue;
      }
      const auto* const word = reinterpret_cast<const char*>(sqlite3_column_text(statement, i));
      const auto bytes = static_cast<std::size_t>(sqlite3_column_bytes(statement, i));
      row.push_back(word == nullptr ? Cell() : Cell(std::string(word, bytes)));
    }
    return row;
  }
  void forget() {
    for (const auto& [sql, statement] : statements_) sqlite3_finalize(statement);
    statements_.clear();
  }
  void close() {
    forget();
    sqlite3_close(handle_);
  }

  std::string file_;
  sqlite3* handle_ = nullptr;
  std::unordered_map<std::string, sqlite3_stmt*> statements_;
};

}  // namespace

std::unique_ptr<Database> open_sqlite(const std::string& file) {
  return std::make_unique<SqliteDatabase>(file);
}

}  // namespace vernier::registry
