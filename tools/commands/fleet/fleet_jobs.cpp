// SPDX-License-Identifier: GPL-3.0-or-later
#include <fmt/format.h>
#include <unistd.h>

#include <mutex>
#include <thread>

#include "tools/commands/command.h"
#include "tools/commands/fleet/fleet_kinds.h"
#include "tools/registry/jobs.h"
#include "tools/text/error.h"

namespace vernier::commands::fleet_cli {
namespace {

struct EnqueueArguments {
  std::string registry, batch, command;
  std::vector<std::string> machines;
};

void run_enqueue(const EnqueueArguments& arguments) {
  registry::Registry registry = open_registry(arguments.registry);
  std::vector<std::string> machines = arguments.machines;
  for (const std::string& machine : machines) registry.machine(machine);
  if (machines.empty())
    for (const registry::FleetMachine& machine : registry.machines()) machines.push_back(machine.name);
  if (machines.empty()) throw text::InputError("no machine in " + registry.database().name());
  registry::JobQueue queue(registry);
  const std::int64_t added = queue.add(arguments.batch, arguments.command, machines);
  fmt::print("{} jobs added, {} machines had theirs in this batch\n", added,
             static_cast<std::int64_t>(machines.size()) - added);
}

struct WorkArguments {
  registry::WorkOptions options;
  std::string json;
  int workers = 1;
};

std::string worker_name(int number) {
  char host[256] = "host";
  ::gethostname(host, sizeof(host) - 1);
  return fmt::format("{}-{}-{}", host, ::getpid(), number);
}

void run_work(const WorkArguments& arguments) {
  { open_registry(arguments.options.registry); }
  std::mutex mutex;
  std::int64_t done = 0;
  std::exception_ptr failed;
  Progress progress("jobs");
  until_told([&](const std::atomic<bool>& stop) {
    std::vector<std::thread> threads;
    for (int i = 0; i < arguments.workers; ++i)
      threads.emplace_back([&, i] {
        registry::WorkOptions options = arguments.options;
        options.worker = worker_name(i);
        try {
          const std::int64_t mine =
              registry::work(options, stop, [&](const registry::Job& job, const registry::JobCounts& all) {
                const std::lock_guard lock(mutex);
                const std::int64_t ended = all.done + all.failed;
                progress.update(
                    static_cast<double>(ended) / static_cast<double>(ended + all.waiting + all.taken),
                    job.machine);
              });
          const std::lock_guard lock(mutex);
          done += mine;
        } catch (...) {
          const std::lock_guard lock(mutex);
          failed = std::current_exception();
        }
      });
    for (std::thread& thread : threads) thread.join();
  });
  if (failed) std::rethrow_exception(failed);
  registry::Registry registry = open_registry(arguments.options.registry);
  const registry::JobCounts all = registry::JobQueue(registry).counts(arguments.options.batch);
  fmt::print(human_stream(arguments.json),
             "{} done here; the batch: {} done, {} failed, {} waiting, {} taken\n", done, all.done,
             all.failed, all.waiting, all.taken);
  write_json(arguments.json, {{"done_here", done},
                              {"done", all.done},
                              {"failed", all.failed},
                              {"waiting", all.waiting},
                              {"taken", all.taken}});
  if (all.failed > 0)
    throw text::LimitNotMet(
        fmt::format("{} jobs failed: vernier fleet jobs {}", all.failed, arguments.options.batch));
}

struct JobsArguments {
  std::string registry, batch, json;
  bool again = false;
};

void run_jobs(const JobsArguments& arguments) {
  registry::Registry registry = open_registry(arguments.registry);
  registry::JobQueue queue(registry);
  std::FILE* const out = human_stream(arguments.json);
  if (arguments.again) {
    if (arguments.batch.empty()) throw text::InputError("--again: of which batch?");
    fmt::print(out, "{} jobs wait again\n", queue.again(arguments.batch));
  }
  nlohmann::ordered_json json = nlohmann::ordered_json::array();
  for (const std::string& batch : arguments.batch.empty() ? queue.batches() : std::vector{arguments.batch}) {
    const registry::JobCounts all = queue.counts(batch);
    fmt::print(out, "{}: {} done, {} failed, {} waiting, {} taken\n", batch, all.done, all.failed,
               all.waiting, all.taken);
    json.push_back({{"batch", batch},
                    {"done", all.done},
                    {"failed", all.failed},
                    {"waiting", all.waiting},
                    {"taken", all.taken}});
    if (arguments.batch.empty()) continue;
    json.back()["jobs"] = nlohmann::ordered_json::array();
    for (const registry::Job& job : queue.jobs(batch)) {
      json.back()["jobs"].push_back({{"machine", job.machine},
                                     {"state", job.state},
                                     {"attempt", job.attempt},
                                     {"worker", job.worker},
                                     {"status", job.status},
                                     {"said", job.said},
                                     {"command", job.command}});
      fmt::print(out, "  {:<20} {:<8} {}\n", job.machine, job.state, job.said);
    }
  }
  write_json(arguments.json, {{"batches", json}});
}

}  // namespace

void add_jobs(CLI::App& fleet) {
  const auto enqueue = std::make_shared<EnqueueArguments>();
  CLI::App* command = fleet.add_subcommand("enqueue", "Enter a command for each machine, no machine twice");
  command->add_option("BATCH", enqueue->batch, "name of this work, e.g. night-2026-11-23")->required();
  command
      ->add_option("COMMAND", enqueue->command, "shell command; {machine} is replaced by the machine's name")
      ->required();
  add_registry(*command, enqueue->registry);
  command->add_option("--machine", enqueue->machines, "only these; default: all of the registry");
  command->footer("A machine that has a job in the batch keeps it. Exit status 0 done, 1 bad input.");
  command->callback([enqueue] { run_enqueue(*enqueue); });

  const auto work = std::make_shared<WorkArguments>();
  command = fleet.add_subcommand("work",
                                 "take jobs of a batch and run them, here and on as many computers as like");
  command->add_option("BATCH", work->options.batch, "as `enqueue` named it")->required();
  add_registry(*command, work->options.registry);
  command->add_option("-w,--workers", work->workers, "number of jobs that run in parallel")
      ->check(CLI::Range(1, 256))
      ->capture_default_str();
  command
      ->add_option("--lease", work->options.lease_s,
                   "time in s after which the job of a stopped worker is free again")
      ->check(CLI::Range(1.0, 86400.0))
      ->capture_default_str();
  command->add_option("--attempts", work->options.most_attempts, "of a job whose workers end without a word")
      ->check(CLI::Range(1, 1000))
      ->capture_default_str();
  command->add_option("--json", work->json, "result for programs; - for standard output");
  command->footer(
      "Ends when no job of the batch is open; may be killed and started again on any computer. The answer of "
      "a job "
      "is\n"
      "written once. Exit status 0 all done, 1 bad input, 2 some jobs failed.");
  command->callback([work] { run_work(*work); });

  const auto jobs = std::make_shared<JobsArguments>();
  command = fleet.add_subcommand("jobs", "how far the batches are, or one of them job by job");
  command->add_option("BATCH", jobs->batch, "only this batch, with its jobs");
  add_registry(*command, jobs->registry);
  command->add_flag("--again", jobs->again, "jobs that failed wait again");
  command->add_option("--json", jobs->json, "result for programs; - for standard output");
  command->callback([jobs] { run_jobs(*jobs); });
}

}  // namespace vernier::commands::fleet_cli
