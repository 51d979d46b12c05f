// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <atomic>
#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "tools/registry/registry.h"

namespace vernier::registry {

/// A job: one command for one machine of a batch.
struct Job {
  std::string batch, machine, command;
  std::string state;  // "waiting", "taken", "done", "failed"
  std::string worker, said;
  std::int64_t attempt = 0, lease_us = 0, ended_us = 0, status = 0;
};

/// Number of jobs of a batch in each state.
struct JobCounts {
  std::int64_t waiting = 0, taken = 0, done = 0, failed = 0;
};

/// The queue in the registry. A job is taken under a lease, which its worker renews while it runs. A job
/// whose lease has expired is free again. The answer of a job is written once, by the attempt that holds the
/// lease. An attempt that has lost the lease gets an error and writes no answer. tool.
class JobQueue {
 public:
  explicit JobQueue(Registry& registry) : registry_(registry) {}

  /// Adds a job for each machine without a job in the batch; returns the number of new jobs. {machine} in the
  /// command is replaced by the name, as one word of a shell.
  std::int64_t add(const std::string& batch, const std::string& command,
                   const std::vector<std::string>& machines);
  /// Takes the next free job for this worker for lease_s; `nullopt` if no job is free.
  std::optional<Job> take(const std::string& batch, const std::string& worker, double lease_s,
                          std::int64_t most_attempts);
  /// Renews the lease of a job; false: the job no longer belongs to this attempt.
  bool renew(const Job& job, double lease_s);
  /// Records the end of a job (status 0: done); false: the job no longer belongs to this attempt, and no
  /// entry was written.
  bool finish(const Job& job, std::int64_t status, const std::string& said);
  /// True if the batch has a job that is neither done nor failed.
  bool is_open(const std::string& batch);
  /// Jobs that failed wait again; how many.
  std::int64_t again(const std::string& batch);
  JobCounts counts(const std::string& batch);
  std::vector<Job> jobs(const std::string& batch);
  std::vector<std::string> batches();

 private:
  Registry& registry_;
};

/// Options of a worker.
struct WorkOptions {
  std::string registry, batch, worker;
  double lease_s = 60;
  std::int64_t most_attempts = 3;  // a command that takes its worker with it is not tried for ever
};

/// Takes jobs and runs their commands with the shell, one after another, until no job of the batch is open or
/// `stop` is set. At `stop` a running command is ended and its job returned. `ended` is called for every job.
/// Returns the number of finished jobs. The registry may be unavailable for a while. tool.
std::int64_t work(const WorkOptions& options, const std::atomic<bool>& stop,
                  const std::function<void(const Job&, const JobCounts&)>& ended);

}  // namespace vernier::registry
