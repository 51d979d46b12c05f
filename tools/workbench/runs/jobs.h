// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <atomic>
#include <map>
#include <memory>
#include <mutex>
#include <nlohmann/json.hpp>
#include <string>
#include <thread>

#include "tools/text/process.h"
#include "tools/workbench/runs/commands.h"
#include "tools/workbench/runs/history.h"

namespace vernier::workbench {

/// Runs commands of the page as processes of this program in the project folder. For each process there is
/// one thread that waits for its end. The result on the page is the same as in a terminal. A bad file affects
/// only the job that reads it. Cancelling a job ends its process immediately.
class Jobs {
 public:
  /// `program`: path of the `vernier` program. The object Jobs keeps references to `project` and `history`.
  Jobs(std::string program, const Project& project, CommandHistory& history);
  ~Jobs();
  Jobs(const Jobs&) = delete;
  Jobs& operator=(const Jobs&) = delete;

  /// Starts a command as a job and returns the number of the job. Throws InputError if too many jobs are
  /// running.
  std::uint64_t start(const PlannedCommand& command);
  /// Returns the state of a job as JSON: {"id", "command" as typed, "state": "running" | "done" | "failed" |
  /// "cancelled", "fraction", "step", "seconds", "exit", "message", "text", "outputs", "result"}. Throws
  /// InputError if no job has this number.
  nlohmann::ordered_json state(std::uint64_t id);
  void cancel(std::uint64_t id);

 private:
  struct Job {
    PlannedCommand command;
    std::string typed, state = "running", step, message, text;
    double fraction = 0, started_s = 0, seconds = 0;
    int exit = -1;
    nlohmann::ordered_json result;
    text::RunningProcess process;
    std::atomic<bool> over{false};
    std::thread thread;
  };
  void run(Job& job);
  void finish(Job& job, int exit, const std::string& out, const std::string& err);
  void take_line(Job& job, std::string_view line);
  void forget_old();
  std::shared_ptr<Job> find(std::uint64_t id);

  std::string program_;
  const Project& project_;
  CommandHistory& history_;
  std::mutex guard_;
  std::map<std::uint64_t, std::shared_ptr<Job>> jobs_;
  std::uint64_t next_ = 1;
};

}  // namespace vernier::workbench
