// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/fleet/sample_writer.h"

#include <fmt/format.h>

#include <algorithm>
#include <nlohmann/json.hpp>

#include "tools/registry/cells.h"
#include "tools/registry/digest.h"
#include "tools/text/wall_time.h"

namespace vernier::fleet {
namespace {

using Json = nlohmann::ordered_json;

// Whoever may publish may send any name: their number is bounded.
constexpr std::size_t kMostNotEntered = 100;

registry::Cell number_cell(std::uint64_t value) { return registry::cell(static_cast<std::int64_t>(value)); }

// The three by which stores are kept, which are no values of the machine.
bool is_bookkeeping(const Metric& metric) {
  return metric.name == kSpoolMetric || metric.name == kNumberMetric || metric.name == kAfterMetric;
}

std::string dumped(const Json& json) { return json.dump(-1, ' ', false, Json::error_handler_t::replace); }

std::string values_text(const SparkplugPayload& payload) {
  Json values = Json::array();
  for (const Metric& metric : payload.metrics)
    if (!is_bookkeeping(metric))
      std::visit([&](const auto& value) { values.push_back(value); }, metric.value);
  return dumped(values);
}

double number_of(const SparkplugPayload& payload, const char* name) {
  const Metric* const metric = payload.find(name);
  const auto* const value = metric == nullptr ? nullptr : std::get_if<double>(&metric->value);
  return value == nullptr ? 0 : *value;
}

}  // namespace

/// Data of one transaction, and the state that is valid after its commit.
struct SampleWriter::Batch {
  struct Newest {
    std::int64_t at_us = 0, samples = 0;
    bool historical = false;
    std::string spool, gateway, mode, fault, image, shape, values;
  };
  std::map<std::string, std::uint64_t> before, after;  // by spool: its cursor
  std::map<std::string, std::string> names_of_shape;
  std::vector<registry::Row> samples, losses, faults, checks;
  std::set<std::string> entered;  // machines of the registry
  struct NotEntered {
    std::string gateway;
    std::int64_t samples = 0;
  };
  std::map<std::string, NotEntered> not_entered;
  std::map<std::string, std::string> last_fault;
  std::map<std::string, std::uint64_t> last_check;
  std::map<std::string, Newest> newest;
};

SampleWriter::Cursor& SampleWriter::cursor(const std::string& spool, const std::string& gateway) {
  const auto found = cursors_.find(spool);
  if (found != cursors_.end()) return found->second;
  registry::Database& database = registry_.database();
  database.run("INSERT INTO spool VALUES ($1, $2, 0) ON CONFLICT DO NOTHING", {spool, gateway});
  const auto rows = database.run("SELECT stored FROM spool WHERE id = $1", {spool});
  return cursors_[spool] = {static_cast<std::uint64_t>(registry::whole(rows.at(0)[0])), gateway};
}

std::string SampleWriter::shape(const SparkplugPayload& payload, Batch& batch) {
  Json names = Json::array();
  for (const Metric& metric : payload.metrics)
    if (!is_bookkeeping(metric)) names.push_back(metric.name);
  const std::string text = dumped(names), id = registry::digest_of(text).substr(0, 32);
  if (!shapes_.contains(id)) batch.names_of_shape[id] = text;
  return id;
}

bool SampleWriter::take(const DeviceData& one, Batch& batch) {
  const auto spool = text_of(one.payload.find(kSpoolMetric));
  const auto number = count_of(one.payload.find(kNumberMetric)),
             after = count_of(one.payload.find(kAfterMetric));
  if (!spool || !number || !after || *after >= *number) return true;  // of another make of node
  constexpr std::uint64_t kLatestMs = 253'402'300'800'000;            // the year 10000
  if (*number > std::uint64_t{INT64_MAX} || one.payload.find(kNumberMetric)->time_ms > kLatestMs) return true;
  const Cursor& kept = cursor(*spool, one.gateway);
  const auto [at, fresh] = batch.after.try_emplace(*spool, kept.stored);
  if (fresh) batch.before[*spool] = kept.stored;
  std::uint64_t& stored = at->second;
  if (*number <= stored) return true;
  if (*after > stored) return false;
  if (stored + 1 < *number) batch.losses.push_back({*spool, number_cell(stored), number_cell(*number)});
  stored = *number;
  if (!batch.entered.contains(one.machine)) {
    auto& counted = batch.not_entered[one.machine];
    counted.gateway = one.gateway;
    ++counted.samples;
    return true;
  }
  const std::int64_t at_us = static_cast<std::int64_t>(one.payload.find(kNumberMetric)->time_ms) * 1000;
  const bool historical = one.payload.find(kNumberMetric)->historical;
  const std::string shape_id = shape(one.payload, batch), values = values_text(one.payload);
  batch.samples.push_back({*spool, number_cell(*number), one.machine, registry::cell(at_us),
                           registry::cell(std::int64_t{historical ? 1 : 0}), shape_id, values});
  Batch::Newest& newest = batch.newest[one.machine];
  ++newest.samples;
  const std::string fault = text_of(one.payload.find("Board/Fault")).value_or("");
  const auto last =
      batch.last_fault.contains(one.machine) ? batch.last_fault[one.machine] : faults_[one.machine];
  if (fault != last && !fault.empty() && fault != "none")
    batch.faults.push_back({one.machine, registry::cell(at_us), fault});
  batch.last_fault[one.machine] = fault;
  if (const auto checked = count_of(one.payload.find("Check/Time"));
      checked && *checked != (batch.last_check.contains(one.machine) ? batch.last_check[one.machine]
                                                                     : checks_[one.machine])) {
    batch.last_check[one.machine] = *checked;
    batch.checks.push_back({one.machine, number_cell(*checked), "by " + one.gateway,
                            text_of(one.payload.find("Check/Verdict")).value_or(""),
                            text_of(one.payload.find("Check/Explanation")).value_or(""),
                            registry::cell(number_of(one.payload, "Check/Evidence")),
                            registry::cell(number_of(one.payload, "Check/Alarm"))});
  }
  // The order of receipt decides, not the clock of a gateway. The records of a store arrive in the order of
  // their numbers. A record that waited in one store does not replace a newer sample that another store has
  // just taken.
  const bool same_store = newest.spool.empty() || newest.spool == *spool;
  if (!same_store && historical && (!newest.historical || at_us < newest.at_us)) return true;
  newest.at_us = at_us, newest.gateway = one.gateway, newest.fault = fault, newest.shape = shape_id;
  newest.spool = *spool, newest.historical = historical;
  newest.values = values;
  newest.mode = text_of(one.payload.find("Board/Mode")).value_or("");
  newest.image = text_of(one.payload.find("Image/Fingerprint")).value_or("");
  return true;
}

std::map<std::string, Receipt> SampleWriter::write(const std::vector<DeviceData>& data) {
  std::map<std::string, Receipt> receipts;
  Batch batch;
  if (!data.empty())
    for (const registry::Row& row : registry_.database().run("SELECT name FROM machine"))
      batch.entered.insert(registry::words(row[0]));
  for (const DeviceData& one : data) {
    const auto spool = text_of(one.payload.find(kSpoolMetric));
    if (!spool) continue;
    Receipt& receipt = receipts[one.gateway];
    receipt.spool = *spool;
    if (!take(one, batch)) receipt.resend = true;
  }
  try {
    write(batch);
  } catch (...) {
    cursors_.clear();  // the database reports what is stored
    throw;
  }
  for (auto& [gateway, receipt] : receipts) receipt.stored = cursor(receipt.spool, gateway).stored;
  return receipts;
}

void SampleWriter::write(Batch& batch) {
  if (batch.samples.empty() && batch.not_entered.empty()) return;
  registry::Database& database = registry_.database();
  registry::Transaction transaction(database);
  for (const auto& [spool, stored] : batch.after) {
    if (stored == batch.before[spool]) continue;
    database.run("UPDATE spool SET stored = $1 WHERE id = $2 AND stored = $3",
                 {number_cell(stored), spool, number_cell(batch.before[spool])});
    if (database.written() != 1)
      throw registry::DatabaseError(fmt::format("another writer has stored records of {}", spool));
  }
  for (const auto& [id, names] : batch.names_of_shape)
    database.run("INSERT INTO shape VALUES ($1, $2) ON CONFLICT DO NOTHING", {id, names});
  registry::insert_rows(database, "INSERT INTO sample", batch.samples, "");
  registry::insert_rows(database, "INSERT INTO loss", batch.losses, "");
  registry::insert_rows(database, "INSERT INTO fault_event", batch.faults, "ON CONFLICT DO NOTHING");
  registry::insert_rows(database, "INSERT INTO check_result", batch.checks, "ON CONFLICT DO NOTHING");
  write_live(batch);
  count_not_entered(batch);
  transaction.commit();
  written_ += batch.samples.size();
  for (const auto& [spool, stored] : batch.after) cursors_[spool].stored = stored;
  for (const auto& [id, names] : batch.names_of_shape) shapes_.insert(id);
  for (const auto& [machine, counted] : batch.not_entered)
    if (reported_.size() < kMostNotEntered && reported_.insert(machine).second) to_report_.insert(machine);
  for (const auto& [machine, fault] : batch.last_fault) faults_[machine] = fault;
  for (const auto& [machine, time] : batch.last_check) checks_[machine] = time;
}

void SampleWriter::count_not_entered(const Batch& batch) {
  if (batch.not_entered.empty()) return;
  registry::Database& database = registry_.database();
  std::set<std::string> counted;
  for (const registry::Row& row : database.run("SELECT machine FROM not_entered"))
    counted.insert(registry::words(row[0]));
  for (const auto& [machine, one] : batch.not_entered) {
    const bool has_row = counted.contains(machine) || counted.size() < kMostNotEntered;
    if (has_row) counted.insert(machine);
    database.run(
        "INSERT INTO not_entered (machine, gateway, samples, at_us) VALUES ($1, $2, $3, $4) ON CONFLICT "
        "(machine) DO UPDATE SET samples = not_entered.samples + excluded.samples, gateway = "
        "excluded.gateway, at_us = excluded.at_us",
        {has_row ? machine : "", one.gateway, registry::cell(one.samples), registry::cell(text::now_us())});
  }
}

std::vector<std::string> SampleWriter::take_not_entered() {
  std::vector<std::string> machines(to_report_.begin(), to_report_.end());
  to_report_.clear();
  return machines;
}

void SampleWriter::write_live(const Batch& batch) {
  std::vector<registry::Row> rows;
  const registry::Cell now = registry::cell(registry_.database().now_us());
  for (const auto& [machine, one] : batch.newest)
    rows.push_back({machine, one.gateway, registry::cell(std::int64_t{1}), registry::cell(one.at_us),
                    registry::cell(one.samples), one.mode, one.fault, one.image, one.shape, one.values, now,
                    one.spool, registry::cell(std::int64_t{one.historical ? 1 : 0})});
  // As in take(): a record that waited in another store than the one last heard counts, and no more.
  const auto newer = [](const std::string& column) {
    return column +
           " = CASE WHEN excluded.spool = live.spool OR live.spool = '' OR excluded.historical = 0 OR "
           "(live.historical = 1 AND excluded.at_us >= live.at_us) THEN excluded." +
           column + " ELSE live." + column + " END";
  };
  std::string tail =
      "ON CONFLICT (machine) DO UPDATE SET samples = live.samples + excluded.samples, online = 1";
  for (const char* column : {"gateway", "mode", "fault", "image", "shape", "sample_values", "at_us",
                             "received_us", "spool", "historical"})
    tail += ", " + newer(column);
  registry::insert_rows(
      registry_.database(),
      "INSERT INTO live (machine, gateway, online, at_us, samples, mode, fault, image, shape, "
      "sample_values, received_us, spool, historical)",
      rows, tail);
}

void SampleWriter::online(const std::string& gateway, const std::string& machine, bool online) {
  registry_.database().run(
      "UPDATE live SET online = $1 WHERE (gateway = $2 OR $2 = '') AND (machine = $3 OR $3 = '')",
      {registry::cell(std::int64_t{online ? 1 : 0}), gateway, machine});
}

}  // namespace vernier::fleet
