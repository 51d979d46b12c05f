// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/fleet/spool.h"

#include <fcntl.h>
#include <sodium.h>
#include <sys/file.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <filesystem>
#include <nlohmann/json.hpp>

#include "tools/registry/cells.h"
#include "tools/registry/digest.h"
#include "tools/registry/open_database.h"
#include "tools/text/error.h"
#include "tools/text/files.h"

namespace vernier::fleet {
namespace {

// Payloads are bytes; cells are text.
std::string hex_of(const std::string& bytes) {
  std::string text(2 * bytes.size() + 1, '\0');
  sodium_bin2hex(text.data(), text.size(), reinterpret_cast<const unsigned char*>(bytes.data()),
                 bytes.size());
  text.pop_back();
  return text;
}

std::optional<std::string> bytes_of(const std::string& hex) {
  std::string bytes(hex.size() / 2, '\0');
  std::size_t size = 0;
  if (sodium_hex2bin(reinterpret_cast<unsigned char*>(bytes.data()), bytes.size(), hex.data(), hex.size(),
                     nullptr, &size, nullptr) != 0 ||
      2 * size != hex.size())
    return std::nullopt;
  return bytes;
}

std::uint64_t count(const registry::Cell& cell) { return static_cast<std::uint64_t>(registry::whole(cell)); }
std::optional<SpoolRecord> record_of(const registry::Row& row) {
  const auto payload = bytes_of(registry::words(row[3]));
  try {
    if (payload) return SpoolRecord{count(row[0]), registry::words(row[1]), count(row[2]), *payload};
  } catch (const registry::DatabaseError&) {
    // A cell that must be a number is not one.
  }
  return std::nullopt;
}

registry::Cell counted(std::uint64_t value) { return registry::cell(static_cast<std::int64_t>(value)); }

}  // namespace

Spool::Lock::Lock(const std::string& file) : fd_(::open(file.c_str(), O_CREAT | O_RDWR | O_CLOEXEC, 0644)) {
  if (fd_ < 0) throw text::InputError({}, file, std::strerror(errno));
  if (::flock(fd_, LOCK_EX | LOCK_NB) == 0) return;
  ::close(fd_);
  throw text::InputError({}, file, "another process uses this store; each gateway needs its own store");
}

Spool::Lock::~Lock() { ::close(fd_); }

Spool::Spool(const std::string& file, const std::string& owner, std::uint64_t most)
    : lock_(file + ".lock"),
      database_(registry::open_database(file)),
      aside_(file + ".damaged"),
      most_(most) {
  registry::refuse_foreign(*database_, "about");
  {
    registry::Transaction transaction(*database_);
    database_->run(
        "CREATE TABLE IF NOT EXISTS about (id TEXT NOT NULL, last BIGINT NOT NULL, stored BIGINT NOT NULL, "
        "gone BIGINT NOT NULL, dropped BIGINT NOT NULL, birth BIGINT NOT NULL, owner TEXT NOT NULL)");
    database_->run(
        "CREATE TABLE IF NOT EXISTS record (number INTEGER PRIMARY KEY, machine TEXT NOT NULL, time_ms "
        "BIGINT "
        "NOT NULL, payload TEXT NOT NULL)");
    if (database_->run("SELECT id FROM about").empty())
      database_->run("INSERT INTO about VALUES ($1, 0, 0, 0, 0, 0, $2)", {registry::fresh_id(), owner});
    transaction.commit();
  }
  const registry::Row row = database_->run("SELECT id, last, stored, gone, dropped, owner FROM about").at(0);
  id_ = registry::words(row[0]);
  last_ = count(row[1]), stored_ = count(row[2]), gone_ = count(row[3]), dropped_ = count(row[4]);
  if (registry::words(row[5]) == owner) return;
  begin_anew();
  database_->run("UPDATE about SET owner = $1", {owner});
}

void Spool::take(std::vector<SpoolRecord>& records) {
  const std::uint64_t stored = stored_;
  std::uint64_t last = last_, gone = std::max(gone_, stored), dropped = dropped_;
  for (SpoolRecord& record : records) record.number = ++last;
  if (last - gone > most_) {
    dropped += last - gone - most_;
    gone = last - most_;
  }
  registry::Transaction transaction(*database_);
  for (const SpoolRecord& record : records)
    database_->run("INSERT INTO record VALUES ($1, $2, $3, $4)",
                   {counted(record.number), record.machine, counted(record.time_ms), hex_of(record.payload)});
  database_->run("DELETE FROM record WHERE number <= $1", {counted(gone)});
  database_->run("UPDATE about SET last = $1, stored = $2, gone = $3, dropped = $4",
                 {counted(last), counted(stored), counted(gone), counted(dropped)});
  transaction.commit();
  last_ = last, gone_ = gone, dropped_ = dropped;
}

std::vector<SpoolRecord> Spool::after(std::uint64_t number, std::size_t most) {
  std::vector<SpoolRecord> records;
  for (bool damaged = true; damaged && records.empty();) {
    std::vector<std::uint64_t> away;
    for (const registry::Row& row : database_->run("SELECT number, machine, time_ms, payload FROM record "
                                                   "WHERE number > $1 ORDER BY number LIMIT $2",
                                                   {counted(number), counted(most)}))
      if (auto record = record_of(row))
        records.push_back(std::move(*record));
      else
        away.push_back(count(row[0]));
    set_aside(away);
    damaged = !away.empty();
  }
  return records;
}

void Spool::set_aside(const std::vector<std::uint64_t>& numbers) {
  if (numbers.empty()) return;
  std::string lines = std::filesystem::exists(aside_) ? text::read_file(aside_) : "";
  registry::Transaction transaction(*database_);
  for (const std::uint64_t number : numbers) {
    for (const registry::Row& row : database_->run(
             "SELECT machine, time_ms, payload FROM record WHERE number = $1", {counted(number)})) {
      const nlohmann::json line = {{"number", number},
                                   {"machine", registry::words(row[0])},
                                   {"time_ms", registry::words(row[1])},
                                   {"payload", registry::words(row[2])}};
      lines += line.dump(-1, ' ', true, nlohmann::json::error_handler_t::replace) + "\n";
    }
    database_->run("DELETE FROM record WHERE number = $1", {counted(number)});
  }
  // Before the records leave the store: after a power failure a record may be in both, never in none.
  text::write_file(aside_, lines);
  transaction.commit();
  count_aside_ += numbers.size();
}

void Spool::stored(std::uint64_t number) { stored_ = std::max(stored_, std::min(number, last_)); }

void Spool::begin_anew() {
  const std::string id = registry::fresh_id();
  const std::uint64_t last = last_ - gone_;
  registry::Transaction transaction(*database_);
  // By way of negative numbers, so that no two rows meet.
  database_->run("UPDATE record SET number = -(number - $1)", {counted(gone_)});
  database_->run("UPDATE record SET number = -number");
  database_->run("UPDATE about SET id = $1, last = $2, stored = 0, gone = 0", {id, counted(last)});
  transaction.commit();
  id_ = id, last_ = last, stored_ = gone_ = 0;
}

std::uint64_t Spool::next_birth() {
  registry::Transaction transaction(*database_);
  const std::uint64_t birth = count(database_->run("SELECT birth FROM about").at(0)[0]);
  database_->run("UPDATE about SET birth = $1", {counted((birth + 1) % 256)});
  transaction.commit();
  return birth;
}

}  // namespace vernier::fleet
