// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/workbench/runs/jobs.h"

#include <algorithm>
#include <charconv>
#include <chrono>

#include "tools/text/error.h"
#include "tools/text/process.h"
#include "tools/text/words.h"
#include "tools/workbench/runs/now.h"

namespace vernier::workbench {
namespace {

constexpr std::size_t kMostRunning = 4, kMostKept = 60, kMostOutput = std::size_t{256} << 20;

/// "fit:  42 % iteration 3" as Progress writes it; false for any other line.
bool read_progress(std::string_view line, const std::string& name, double& fraction, std::string& step) {
  if (line.substr(0, name.size()) != name || line.substr(name.size(), 2) != ": ") return false;
  line.remove_prefix(name.size() + 2);
  while (!line.empty() && line.front() == ' ') line.remove_prefix(1);
  double percent = 0;
  const auto end = std::from_chars(line.data(), line.data() + line.size(), percent);
  line.remove_prefix(static_cast<std::size_t>(end.ptr - line.data()));
  if (end.ec != std::errc() || line.substr(0, 2) != " %") return false;
  fraction = std::clamp(percent / 100, 0.0, 1.0);
  step = line.substr(std::min<std::size_t>(3, line.size()));
  return true;
}

}  // namespace

Jobs::Jobs(std::string program, const Project& project, CommandHistory& history)
    : program_(std::move(program)), project_(project), history_(history) {}

Jobs::~Jobs() {
  for (auto& [id, job] : jobs_) job->process.cancel();
  for (auto& [id, job] : jobs_)
    if (job->thread.joinable()) job->thread.join();
}

std::uint64_t Jobs::start(const PlannedCommand& command) {
  const std::scoped_lock lock(guard_);
  forget_old();
  const auto running =
      std::count_if(jobs_.begin(), jobs_.end(), [](const auto& one) { return !one.second->over; });
  if (static_cast<std::size_t>(running) >= kMostRunning)
    throw text::InputError("too many commands are running: wait for one or cancel one");
  auto job = std::make_shared<Job>();
  job->command = command;
  job->typed = text::shell_text("vernier", command.arguments);
  job->started_s = steady_s();
  const std::uint64_t id = next_++;
  jobs_[id] = job;
  job->thread = std::thread([this, raw = job.get()] { run(*raw); });
  return id;
}

void Jobs::forget_old() {
  for (auto at = jobs_.begin(); at != jobs_.end() && jobs_.size() > kMostKept;) {
    if (!at->second->over) {
      ++at;
      continue;
    }
    at->second->thread.join();
    at = jobs_.erase(at);
  }
}

void Jobs::take_line(Job& job, std::string_view line) {
  const std::scoped_lock lock(guard_);
  constexpr std::size_t kMostText = 200'000;
  if (read_progress(line, job.command.name, job.fraction, job.step)) return;
  constexpr std::string_view kError = "vernier: ";
  if (line.substr(0, kError.size()) == kError) job.message = line.substr(kError.size());
  if (job.text.size() < kMostText) job.text += std::string(line) + "\n";
}

void Jobs::run(Job& job) {
  std::vector<std::string> arguments = job.command.arguments;
  arguments.insert(arguments.end(), {"--json", "-"});
  try {
    const text::ProcessResult result = text::run_process(
        program_, arguments, project_.root().string(), kMostOutput,
        [&](std::string_view line) { take_line(job, line); }, job.process);
    finish(job, result.exit, result.out, result.err);
  } catch (const std::exception& error) {
    finish(job, 70, "", error.what());
  }
}

void Jobs::finish(Job& job, int exit, const std::string& out, const std::string& err) {
  nlohmann::ordered_json result;
  if (!text::nests_deeper_than(out, text::kMostJsonDepth))
    result = nlohmann::ordered_json::parse(out, nullptr, false);
  if (result.is_discarded()) result = nullptr;
  const std::scoped_lock lock(guard_);
  job.exit = exit;
  job.result = std::move(result);
  job.seconds = steady_s() - job.started_s;
  job.state = job.process.cancelled ? "cancelled" : exit == 0 ? "done" : "failed";
  if (job.state == "failed" && job.message.empty()) job.message = err.substr(0, 2000);
  if (job.state == "done" && job.command.for_history) {
    try {
      history_.add(job.typed, job.command, job.result);
    } catch (const std::exception& error) {
      job.text += std::string("the command was not written to the history: ") + error.what() + "\n";
    }
  }
  job.over = true;
}

std::shared_ptr<Jobs::Job> Jobs::find(std::uint64_t id) {
  const auto found = jobs_.find(id);
  if (found == jobs_.end()) throw text::InputError("no command with the number " + std::to_string(id));
  return found->second;
}

nlohmann::ordered_json Jobs::state(std::uint64_t id) {
  const std::scoped_lock lock(guard_);
  const Job& job = *find(id);
  return {{"id", id},
          {"command", job.typed},
          {"state", job.state},
          {"fraction", job.fraction},
          {"step", job.step},
          {"seconds", job.over ? job.seconds : steady_s() - job.started_s},
          {"exit", job.exit},
          {"message", job.message},
          {"text", job.text},
          {"outputs", job.command.outputs},
          {"result", job.result}};
}

void Jobs::cancel(std::uint64_t id) {
  const std::scoped_lock lock(guard_);
  Job& job = *find(id);
  if (job.over) return;
  job.process.cancel();
}

}  // namespace vernier::workbench
