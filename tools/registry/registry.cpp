// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/registry/registry.h"

#include <fmt/format.h>

#include <cstdio>
#include <nlohmann/json.hpp>

#include "tools/registry/cells.h"
#include "tools/registry/machine_name.h"
#include "tools/text/error.h"
#include "tools/text/numbers.h"

namespace vernier::registry {
namespace {

// Raised with every change of the tables; an older program leaves a newer registry alone.
constexpr std::int64_t kSchema = 3;

// Time is microseconds since 1970. `spool` is the register of gateways' stores: `stored` is the last of its
// numbers that is in `sample`, and moves in the transaction that puts it there.
constexpr const char* kTables[] = {
    "CREATE TABLE IF NOT EXISTS fleet_schema (version BIGINT NOT NULL)",
    "CREATE TABLE IF NOT EXISTS machine (name TEXT PRIMARY KEY, url TEXT NOT NULL, note TEXT NOT NULL, "
    "check_days DOUBLE PRECISION NOT NULL, added_us BIGINT NOT NULL)",
    "CREATE TABLE IF NOT EXISTS calibration (machine TEXT NOT NULL REFERENCES machine(name), at_us BIGINT "
    "NOT "
    "NULL, model TEXT NOT NULL, model_hash TEXT NOT NULL, image TEXT NOT NULL, data TEXT NOT NULL, data_hash "
    "TEXT NOT NULL, signed_by TEXT NOT NULL, checked_against TEXT NOT NULL, checked_hash TEXT NOT NULL, "
    "PRIMARY KEY (machine, at_us))",
    "CREATE TABLE IF NOT EXISTS check_result (machine TEXT NOT NULL REFERENCES machine(name), at_us BIGINT "
    "NOT NULL, label TEXT NOT NULL, verdict TEXT NOT NULL, explanation TEXT NOT NULL, evidence DOUBLE "
    "PRECISION NOT NULL, alarm DOUBLE PRECISION NOT NULL, PRIMARY KEY (machine, at_us, label))",
    "CREATE TABLE IF NOT EXISTS reading (machine TEXT NOT NULL REFERENCES machine(name), quantity TEXT NOT "
    "NULL, at_us BIGINT NOT NULL, unit TEXT NOT NULL, value DOUBLE PRECISION NOT NULL, std DOUBLE PRECISION "
    "NOT NULL, PRIMARY KEY (machine, quantity, at_us))",
    "CREATE TABLE IF NOT EXISTS spool (id TEXT PRIMARY KEY, gateway TEXT NOT NULL, stored BIGINT NOT NULL)",
    "CREATE TABLE IF NOT EXISTS shape (id TEXT PRIMARY KEY, names TEXT NOT NULL)",
    "CREATE TABLE IF NOT EXISTS sample (spool TEXT NOT NULL, number BIGINT NOT NULL, machine TEXT NOT NULL, "
    "at_us BIGINT NOT NULL, historical BIGINT NOT NULL, shape TEXT NOT NULL, sample_values TEXT NOT NULL, "
    "PRIMARY KEY (spool, number))",
    "CREATE INDEX IF NOT EXISTS sample_by_machine ON sample (machine, at_us)",
    "CREATE TABLE IF NOT EXISTS loss (spool TEXT NOT NULL, after_number BIGINT NOT NULL, before_number "
    "BIGINT "
    "NOT NULL, PRIMARY KEY (spool, after_number))",
    "CREATE TABLE IF NOT EXISTS live (machine TEXT PRIMARY KEY, gateway TEXT NOT NULL, online BIGINT NOT "
    "NULL, at_us BIGINT NOT NULL, samples BIGINT NOT NULL, mode TEXT NOT NULL, fault TEXT NOT NULL, image "
    "TEXT NOT NULL, shape TEXT NOT NULL, sample_values TEXT NOT NULL)",
    "CREATE TABLE IF NOT EXISTS fault_event (machine TEXT NOT NULL, at_us BIGINT NOT NULL, fault TEXT NOT "
    "NULL, PRIMARY KEY (machine, at_us, fault))",
    "CREATE TABLE IF NOT EXISTS rollout (name TEXT NOT NULL, machine TEXT NOT NULL, stage BIGINT NOT NULL, "
    "place BIGINT NOT NULL, image TEXT NOT NULL, state TEXT NOT NULL, said TEXT NOT NULL, at_us BIGINT NOT "
    "NULL, PRIMARY KEY (name, machine))",
};

// Version 2, on top of version 1: identity of a machine's board, one caller per machine, time of receipt of a
// sample.
constexpr const char* kSecondVersion[] = {
    "ALTER TABLE machine ADD COLUMN board TEXT NOT NULL DEFAULT ''",
    "ALTER TABLE machine ADD COLUMN board_key TEXT NOT NULL DEFAULT ''",
    "ALTER TABLE live ADD COLUMN received_us BIGINT NOT NULL DEFAULT 0",
    "ALTER TABLE live ADD COLUMN spool TEXT NOT NULL DEFAULT ''",
    "ALTER TABLE live ADD COLUMN historical BIGINT NOT NULL DEFAULT 0",
    "ALTER TABLE rollout ADD COLUMN issued BIGINT NOT NULL DEFAULT 0",
    ("CREATE TABLE machine_lock (machine TEXT PRIMARY KEY, holder TEXT NOT NULL, purpose TEXT NOT NULL, "
     "until_us BIGINT NOT NULL)"),
};

// Version 3: answers of batches, and machines whose samples arrive though nobody has entered them. The table
// `job` of older versions is kept and no longer read.
constexpr const char* kThirdVersion[] = {
    "CREATE TABLE answer (batch TEXT NOT NULL, machine TEXT NOT NULL REFERENCES machine(name), name TEXT NOT "
    "NULL, at_us BIGINT NOT NULL, status BIGINT NOT NULL, result TEXT NOT NULL, PRIMARY KEY (batch, "
    "machine))",
    "CREATE TABLE not_entered (machine TEXT PRIMARY KEY, gateway TEXT NOT NULL, samples BIGINT NOT NULL, "
    "at_us BIGINT NOT NULL)",
};

// Tables with a column `machine`, for a change of the name.
constexpr const char* kOfMachines[] = {"calibration", "check_result", "reading", "sample",      "live",
                                       "fault_event", "rollout",      "answer",  "machine_lock"};

// Two programs that find no tables make them one after the other.
constexpr std::int64_t kSchemaLock = 0x7665726e;

constexpr double kClockAhead_s = 2, kClockBehind_s = 10;

}  // namespace

Registry::Registry(std::unique_ptr<Database> database) : database_(std::move(database)) { make_tables(); }

void Registry::make_tables() {
  // If the tables exist no data are written: readers of a file that others fill do not block them.
  const bool server = database_->skip_locked()[0] != '\0';
  const char* const found = server ? "SELECT 1 FROM pg_tables WHERE tablename = 'rollout' AND schemaname = "
                                     "ANY (current_schemas(false))"
                                   : "SELECT 1 FROM sqlite_master WHERE name = 'rollout'";
  if (database_->run(found).empty()) {
    refuse_foreign(*database_, "fleet_schema");
    Transaction transaction(*database_);
    if (server) database_->run(fmt::format("SELECT pg_advisory_xact_lock({})", kSchemaLock));
    for (const char* table : kTables) database_->run(table);
    if (database_->run("SELECT version FROM fleet_schema").empty())
      database_->run("INSERT INTO fleet_schema VALUES ($1)", {cell(std::int64_t{1})});
    transaction.commit();
  }
  const std::int64_t version = whole(database_->run("SELECT version FROM fleet_schema").at(0)[0]);
  if (version > kSchema)
    throw text::InputError({}, database_->name(), "a newer version of vernier wrote this registry");
  if (version < kSchema) upgrade(version);
}

// Two programs that find an older registry change it one after the other.
void Registry::upgrade(std::int64_t version) {
  Transaction transaction(*database_);
  if (database_->skip_locked()[0] != '\0')
    database_->run(fmt::format("SELECT pg_advisory_xact_lock({})", kSchemaLock));
  version = whole(database_->run("SELECT version FROM fleet_schema").at(0)[0]);
  if (version < 2)
    for (const char* statement : kSecondVersion) database_->run(statement);
  if (version < 3)
    for (const char* statement : kThirdVersion) database_->run(statement);
  database_->run("UPDATE fleet_schema SET version = $1", {cell(kSchema)});
  transaction.commit();
}

void Registry::put(const FleetMachine& machine) {
  require_machine_name(machine.name);
  database_->run(
      "INSERT INTO machine (name, url, note, check_days, added_us, board, board_key) VALUES ($1, $2, $3, $4, "
      "$5, $6, $7) ON CONFLICT (name) DO UPDATE SET url = excluded.url, note = excluded.note, check_days = "
      "excluded.check_days, board = excluded.board, board_key = excluded.board_key",
      {machine.name, machine.url, machine.note, cell(machine.check_days), cell(machine.added_us),
       machine.board, machine.board_key});
}

bool Registry::trust_board_key(const std::string& machine, const std::string& key) {
  database_->run(
      "UPDATE machine SET board_key = $1 WHERE name = $2 AND board_key = '' AND NOT EXISTS (SELECT 1 FROM "
      "machine other WHERE other.board_key = $1)",
      {key, machine});
  return database_->written() == 1;
}

std::vector<FleetMachine> Registry::machines() {
  std::vector<FleetMachine> machines;
  for (const Row& row :
       database_->run("SELECT name, url, note, check_days, added_us, board, board_key FROM machine ORDER BY "
                      "name"))
    machines.push_back({words(row[0]), words(row[1]), words(row[2]), real(row[3]), whole(row[4]),
                        words(row[5]), words(row[6])});
  return machines;
}

FleetMachine Registry::machine(const std::string& name) {
  for (FleetMachine& machine : machines())
    if (machine.name == name) return std::move(machine);
  throw text::InputError({}, name, fmt::format("no machine has this name in {}", database_->name()));
}

void Registry::give_name(const std::string& from, const std::string& to) {
  require_machine_name(to);
  FleetMachine machine = this->machine(from);
  Transaction transaction(*database_);
  database_->run(
      "INSERT INTO machine (name, url, note, check_days, added_us, board, board_key) VALUES ($1, $2, $3, $4, "
      "$5, $6, $7) ON CONFLICT DO NOTHING",
      {to, machine.url, machine.note, cell(machine.check_days), cell(machine.added_us), machine.board,
       machine.board_key});
  if (database_->written() == 0)
    throw text::InputError({}, to, "the registry already has a machine of this name");
  for (const char* table : kOfMachines)
    database_->run(fmt::format("UPDATE {} SET machine = $1 WHERE machine = $2", table), {to, from});
  database_->run("DELETE FROM machine WHERE name = $1", {from});
  transaction.commit();
}

std::vector<NotEntered> Registry::not_entered() {
  std::vector<NotEntered> all;
  for (const Row& row :
       database_->run("SELECT machine, gateway, samples, at_us FROM not_entered ORDER BY machine"))
    all.push_back({words(row[0]), words(row[1]), whole(row[2]), whole(row[3])});
  return all;
}

void Registry::put(const RecordedCalibration& c) {
  database_->run("INSERT INTO calibration VALUES ($1, $2, $3, $4, $5, $6, $7, $8, $9, $10)",
                 {c.machine, cell(c.at_us), c.model, c.model_hash, c.image, c.data, c.data_hash, c.signed_by,
                  c.checked_against, c.checked_hash});
}

std::vector<RecordedCalibration> Registry::calibrations(const std::string& machine) {
  std::vector<RecordedCalibration> all;
  for (const Row& row : database_->run(
           "SELECT machine, at_us, model, model_hash, image, data, data_hash, signed_by, checked_against, "
           "checked_hash FROM calibration WHERE machine = $1 OR $1 = '' ORDER BY at_us DESC, machine",
           {machine}))
    all.push_back({words(row[0]), words(row[2]), words(row[3]), words(row[4]), words(row[5]), words(row[6]),
                   words(row[7]), words(row[8]), words(row[9]), whole(row[1])});
  return all;
}

bool Registry::put(const FleetCheck& check, const std::vector<FleetReading>& readings) {
  Transaction transaction(*database_);
  database_->run("INSERT INTO check_result VALUES ($1, $2, $3, $4, $5, $6, $7) ON CONFLICT DO NOTHING",
                 {check.machine, cell(check.at_us), check.label, check.verdict, check.explanation,
                  cell(check.evidence), cell(check.alarm)});
  if (database_->written() == 0) return false;
  for (const FleetReading& one : readings)
    database_->run("INSERT INTO reading VALUES ($1, $2, $3, $4, $5, $6) ON CONFLICT DO NOTHING",
                   {one.machine, one.quantity, cell(one.at_us), one.unit, cell(one.value), cell(one.std)});
  transaction.commit();
  return true;
}

std::vector<FleetCheck> Registry::checks(const std::string& machine) {
  std::vector<FleetCheck> checks;
  for (const Row& row :
       database_->run("SELECT machine, label, verdict, explanation, evidence, alarm, at_us FROM check_result "
                      "WHERE machine = $1 OR $1 = '' ORDER BY at_us, machine",
                      {machine}))
    checks.push_back({words(row[0]), words(row[1]), words(row[2]), words(row[3]), real(row[4]), real(row[5]),
                      whole(row[6])});
  return checks;
}

std::vector<FleetReading> Registry::readings(std::int64_t since_us) {
  std::vector<FleetReading> readings;
  for (const Row& row : database_->run(
           "SELECT machine, quantity, unit, at_us, value, std FROM reading WHERE at_us >= $1 ORDER "
           "BY quantity, machine, at_us",
           {cell(since_us)}))
    readings.push_back(
        {words(row[0]), words(row[1]), words(row[2]), whole(row[3]), real(row[4]), real(row[5])});
  return readings;
}

std::vector<LiveState> Registry::live() {
  std::vector<LiveState> live;
  for (const Row& row : database_->run(
           "SELECT live.machine, gateway, mode, fault, image, online, at_us, samples, names, sample_values, "
           "received_us, historical FROM live JOIN shape ON shape.id = live.shape ORDER BY live.machine")) {
    LiveState one{words(row[0]),  words(row[1]),      words(row[2]),
                  words(row[3]),  words(row[4]),      whole(row[5]) != 0,
                  whole(row[6]),  whole(row[7]),      {},
                  whole(row[10]), whole(row[11]) != 0};
    const auto names = nlohmann::json::parse(words(row[8])), values = nlohmann::json::parse(words(row[9]));
    for (std::size_t i = 0; i < names.size() && i < values.size(); ++i)
      one.values.emplace_back(names[i].get<std::string>(), values[i].dump());
    live.push_back(std::move(one));
  }
  return live;
}

LiveAge live_age(const LiveState& live, std::int64_t now_us, double stale_s) {
  LiveAge age;
  age.age_s = static_cast<double>(now_us - live.received_us) * 1e-6;
  const bool known = live.received_us != 0;  // not in a registry of the version before
  if (known && !live.historical) {
    age.clock_s = static_cast<double>(live.at_us - live.received_us) * 1e-6;
    age.clock_off = age.clock_s > kClockAhead_s || age.clock_s < -kClockBehind_s;
  }
  const bool fresh = known && !live.historical && age.age_s <= stale_s;
  age.state = !live.online ? LiveAge::State::kAway : fresh ? LiveAge::State::kOnline : LiveAge::State::kStale;
  return age;
}

const char* name_of(LiveAge::State state) {
  switch (state) {
    case LiveAge::State::kOnline:
      return "online";
    case LiveAge::State::kStale:
      return "stale";
    case LiveAge::State::kAway:
      return "away";
  }
  return "unknown";
}

std::int64_t Registry::forget_samples(std::int64_t before_us) {
  // In pieces: writers never wait long.
  constexpr std::int64_t kPiece = 10'000;
  std::int64_t all = 0, last = kPiece;
  while (last == kPiece) {
    database_->run(
        "DELETE FROM sample WHERE (spool, number) IN (SELECT spool, number FROM sample WHERE at_us < $1 "
        "LIMIT $2)",
        {cell(before_us), cell(kPiece)});
    all += last = database_->written();
  }
  return all;
}

}  // namespace vernier::registry
