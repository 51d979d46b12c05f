// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/registry/machine_lock.h"

#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <chrono>

#include "tools/registry/cells.h"
#include "tools/registry/digest.h"
#include "tools/text/wall_time.h"

namespace vernier::registry {
namespace {

std::int64_t steady_us() {
  return std::chrono::duration_cast<std::chrono::microseconds>(
             std::chrono::steady_clock::now().time_since_epoch())
      .count();
}

std::string new_holder() {
  std::array<char, 256> host{};
  if (::gethostname(host.data(), host.size() - 1) != 0) host[0] = '\0';
  return fmt::format("{} process {} {}", host.data(), ::getpid(), fresh_id().substr(0, 8));
}

}  // namespace

MachineLocks::MachineLocks(Registry& registry, std::vector<std::string> machines, std::string purpose,
                           double lease_s)
    : registry_(registry), machines_(std::move(machines)), holder_(new_holder()), lease_s_(lease_s) {
  // In one order, so that two callers never wait for each other.
  std::sort(machines_.begin(), machines_.end());
  Database& database = registry_.database();
  Transaction transaction(database);
  renewed_us_ = steady_us();
  const std::int64_t now = database.now_us();
  const auto until = now + static_cast<std::int64_t>(lease_s_ * 1e6);
  for (const std::string& machine : machines_) {
    database.run(
        "INSERT INTO machine_lock VALUES ($1, $2, $3, $4) ON CONFLICT (machine) DO UPDATE SET holder = "
        "excluded.holder, purpose = excluded.purpose, until_us = excluded.until_us WHERE "
        "machine_lock.until_us < $5",
        {machine, holder_, purpose, cell(until), cell(now)});
    const Row row =
        database.run("SELECT holder, purpose, until_us FROM machine_lock WHERE machine = $1", {machine})
            .at(0);
    if (words(row[0]) != holder_)
      throw text::LimitNotMet(
          fmt::format("{}: another call works on this machine ({}, {}), so this call changed nothing. If the "
                      "other call was killed, its lock ends at {}",
                      machine, words(row[1]), words(row[0]), text::utc_text(whole(row[2]))));
  }
  transaction.commit();
}

MachineLocks::~MachineLocks() {
  try {
    registry_.database().run("DELETE FROM machine_lock WHERE holder = $1", {holder_});
  } catch (const std::runtime_error&) {
    // The registry is away: the leases end by themselves.
  }
}

void MachineLocks::renew() {
  if (static_cast<double>(steady_us() - renewed_us_) * 1e-6 >= lease_s_ / 3) require();
}

void MachineLocks::require() {
  Database& database = registry_.database();
  Transaction transaction(database);
  const std::int64_t begun = steady_us(), now = database.now_us();
  database.run("UPDATE machine_lock SET until_us = $1 WHERE holder = $2 AND until_us >= $3",
               {cell(now + static_cast<std::int64_t>(lease_s_ * 1e6)), holder_, cell(now)});
  const bool all = database.written() == static_cast<std::int64_t>(machines_.size());
  transaction.commit();
  if (!all)
    throw LockLost(
        "the lock of these machines in the registry ended before this call renewed the lock: another call "
        "may work on these machines now, so this call stopped");
  renewed_us_ = begun;
}

}  // namespace vernier::registry
