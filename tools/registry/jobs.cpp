// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/registry/jobs.h"

#include <chrono>
#include <memory>
#include <thread>

#include "tools/registry/cells.h"
#include "tools/registry/open_database.h"
#include "tools/registry/shell_command.h"
#include "tools/text/error.h"
#include "tools/text/wall_time.h"

namespace vernier::registry {
namespace {

using namespace std::chrono_literals;

constexpr const char* kJobColumns =
    "batch, machine, command, state, worker, said, attempt, lease_us, ended_us, status";
constexpr auto kLookAgain = 300ms;
constexpr auto kRegistryAway = 1s;

Job job_of(const Row& row) {
  return {words(row[0]), words(row[1]), words(row[2]), words(row[3]), words(row[4]),
          words(row[5]), whole(row[6]), whole(row[7]), whole(row[8]), whole(row[9])};
}

std::int64_t until_us(double lease_s) { return text::now_us() + static_cast<std::int64_t>(lease_s * 1e6); }

/// A registry that is opened again whenever it has been away.
class PatientQueue {
 public:
  PatientQueue(const std::string& place, const std::atomic<bool>& stop) : place_(place), stop_(stop) {
    open();
  }
  /// The answer of `use`; called again after the registry was not available. `nullopt` once `stop` is set.
  template <class Use>
  auto with(Use use) -> std::optional<decltype(use(std::declval<JobQueue&>()))> {
    for (;;) {
      try {
        if (!registry_) open();
        JobQueue queue(*registry_);
        return use(queue);
      } catch (const DatabaseError&) {
        registry_.reset();
      } catch (const text::InputError&) {
        registry_.reset();
        if (!is_server(place_)) throw;
      }
      if (stop_) return {};
      std::this_thread::sleep_for(kRegistryAway);
    }
  }

 private:
  void open() { registry_ = std::make_unique<Registry>(open_database(place_)); }
  std::string place_;
  const std::atomic<bool>& stop_;
  std::unique_ptr<Registry> registry_;
};

}  // namespace

std::int64_t JobQueue::add(const std::string& batch, const std::string& command,
                           const std::vector<std::string>& machines) {
  std::vector<Row> rows;
  for (const std::string& machine : machines)
    rows.push_back({batch, machine, command_for(command, machine), "waiting", "0", "", "0", "0", "0", ""});
  Database& database = registry_.database();
  Transaction transaction(database);
  const auto count = [&] {
    return whole(database.run("SELECT COUNT(*) FROM job WHERE batch = $1", {batch}).at(0)[0]);
  };
  const std::int64_t before = count();
  insert_rows(
      database,
      "INSERT INTO job (batch, machine, command, state, attempt, worker, lease_us, ended_us, status, said)",
      rows, "ON CONFLICT DO NOTHING");
  const std::int64_t added = count() - before;
  transaction.commit();
  return added;
}

std::optional<Job> JobQueue::take(const std::string& batch, const std::string& worker, double lease_s,
                                  std::int64_t most_attempts) {
  Database& database = registry_.database();
  Transaction transaction(database);
  database.run(
      "UPDATE job SET state = 'failed', said = 'its workers ended without a word', status = -1, ended_us = "
      "$1 "
      "WHERE batch = $2 AND state = 'taken' AND lease_us < $1 AND attempt >= $3",
      {cell(text::now_us()), batch, cell(most_attempts)});
  const auto rows = database.run(std::string("SELECT ") + kJobColumns +
                                     " FROM job WHERE batch = $1 AND (state = 'waiting' OR (state = 'taken' "
                                     "AND lease_us < $2)) ORDER BY "
                                     "machine LIMIT 1" +
                                     database.skip_locked(),
                                 {batch, cell(text::now_us())});
  std::optional<Job> job;
  if (!rows.empty()) {
    job = job_of(rows[0]);
    job->state = "taken", job->worker = worker, job->lease_us = until_us(lease_s);
    ++job->attempt;
    database.run(
        "UPDATE job SET state = 'taken', worker = $1, lease_us = $2, attempt = $3 WHERE batch = $4 AND "
        "machine = "
        "$5",
        {worker, cell(job->lease_us), cell(job->attempt), batch, job->machine});
  }
  transaction.commit();
  return job;
}

bool JobQueue::renew(const Job& job, double lease_s) {
  Database& database = registry_.database();
  database.run(
      "UPDATE job SET lease_us = $1 WHERE batch = $2 AND machine = $3 AND attempt = $4 AND state = 'taken'",
      {cell(until_us(lease_s)), job.batch, job.machine, cell(job.attempt)});
  return database.written() == 1;
}

bool JobQueue::finish(const Job& job, std::int64_t status, const std::string& said) {
  Database& database = registry_.database();
  database.run(
      "UPDATE job SET state = $1, status = $2, said = $3, ended_us = $4 WHERE batch = $5 AND machine = $6 "
      "AND "
      "attempt = $7 AND state = 'taken'",
      {status == 0 ? "done" : "failed", cell(status), said, cell(text::now_us()), job.batch, job.machine,
       cell(job.attempt)});
  return database.written() == 1;
}

bool JobQueue::is_open(const std::string& batch) {
  const JobCounts all = counts(batch);
  return all.waiting + all.taken > 0;
}

std::int64_t JobQueue::again(const std::string& batch) {
  Database& database = registry_.database();
  database.run("UPDATE job SET state = 'waiting', attempt = 0 WHERE batch = $1 AND state = 'failed'",
               {batch});
  return database.written();
}

JobCounts JobQueue::counts(const std::string& batch) {
  JobCounts counts;
  for (const Row& row :
       registry_.database().run("SELECT state, COUNT(*) FROM job WHERE batch = $1 GROUP BY state", {batch})) {
    const std::string state = words(row[0]);
    (state == "waiting" ? counts.waiting
     : state == "taken" ? counts.taken
     : state == "done"  ? counts.done
                        : counts.failed) = whole(row[1]);
  }
  return counts;
}

std::vector<Job> JobQueue::jobs(const std::string& batch) {
  std::vector<Job> jobs;
  for (const Row& row : registry_.database().run(
           std::string("SELECT ") + kJobColumns + " FROM job WHERE batch = $1 ORDER BY machine", {batch}))
    jobs.push_back(job_of(row));
  return jobs;
}

std::vector<std::string> JobQueue::batches() {
  std::vector<std::string> batches;
  for (const Row& row : registry_.database().run("SELECT DISTINCT batch FROM job ORDER BY batch"))
    batches.push_back(words(row[0]));
  return batches;
}

std::int64_t work(const WorkOptions& options, const std::atomic<bool>& stop,
                  const std::function<void(const Job&, const JobCounts&)>& ended) {
  PatientQueue patient(options.registry, stop);
  std::int64_t done = 0;
  while (!stop) {
    const auto taken = patient.with([&](JobQueue& queue) {
      return queue.take(options.batch, options.worker, options.lease_s, options.most_attempts);
    });
    if (!taken) break;
    if (!*taken) {
      if (!patient.with([&](JobQueue& queue) { return queue.is_open(options.batch); }).value_or(false)) break;
      std::this_thread::sleep_for(kLookAgain);
      continue;
    }
    Job job = **taken;
    ShellCommand command(job.command);
    bool mine = true;
    auto renewed = std::chrono::steady_clock::now();
    while (!command.wait(100ms) && !stop && mine) {
      if (std::chrono::steady_clock::now() - renewed < std::chrono::duration<double>(options.lease_s / 3))
        continue;
      mine = patient.with([&](JobQueue& queue) { return queue.renew(job, options.lease_s); }).value_or(false);
      renewed = std::chrono::steady_clock::now();
    }
    if (!command.ended()) {
      command.end();
      // Returned immediately, without waiting for the lease.
      if (mine) patient.with([&](JobQueue& queue) { return queue.renew(job, -1); });
      continue;
    }
    const auto counts = patient.with([&](JobQueue& queue) {
      if (queue.finish(job, command.status(), command.last_line())) {
        job.state = command.status() == 0 ? "done" : "failed";
        ++done;
      }
      return queue.counts(options.batch);
    });
    job.status = command.status(), job.said = command.last_line();
    if (counts) ended(job, *counts);
  }
  return done;
}

}  // namespace vernier::registry
