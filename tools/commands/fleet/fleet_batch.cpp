// SPDX-License-Identifier: GPL-3.0-or-later
#include <fmt/format.h>
#include <sys/stat.h>

#include <algorithm>
#include <filesystem>
#include <map>

#include "tools/commands/command.h"
#include "tools/commands/fleet/fleet_kinds.h"
#include "tools/registry/batch.h"
#include "tools/registry/machine_name.h"
#include "tools/text/error.h"
#include "tools/text/process.h"
#include "tools/text/wall_time.h"
#include "tools/text/words.h"

namespace vernier::commands::fleet_cli {
namespace {

using Json = nlohmann::ordered_json;

constexpr std::size_t kMostOutput = 1u << 28;  // bytes of one command's output
// Tasks of one array: Slurm's default MaxArraySize is 1001, and the highest index is one below.
constexpr std::size_t kMostTasks = 1000;

struct BatchArguments {
  std::string registry, name, folder, scheduler = "parallel";
  std::vector<std::string> machines, command;
};

std::string this_program() { return std::filesystem::read_symlink("/proc/self/exe").string(); }

std::string quoted(const std::string& word) { return text::shell_text("", {word}).substr(1); }

/// The command for `words`, and for its kind (`import table`). Throws InputError for an unknown one.
const CLI::App& command_for(const CLI::App& vernier, const std::vector<std::string>& words) {
  const CLI::App* command = nullptr;
  for (const std::string& word : words) {
    const CLI::App* const above = command == nullptr ? &vernier : command;
    const auto all = above->get_subcommands([](const CLI::App*) { return true; });
    const auto found =
        std::find_if(all.begin(), all.end(), [&](const CLI::App* one) { return one->get_name() == word; });
    if (found == all.end()) break;
    command = *found;
  }
  if (command == nullptr)
    throw text::InputError({}, words.empty() ? "" : words.front(),
                           "the command for each machine is missing here, e.g. diagnose models/{machine}.xml "
                           "data/{machine}.csv");
  return *command;
}

/// The user's words without `vernier`; one word with blanks is taken apart at them.
std::vector<std::string> words_of(std::vector<std::string> words) {
  if (!words.empty() && words.front() == "--") words.erase(words.begin());
  if (words.size() == 1) words = text::words_in(words.front(), " \t\n");
  if (!words.empty() && words.front() == "vernier") words.erase(words.begin());
  return words;
}

std::vector<std::string> command_of(const CLI::App& vernier, const BatchArguments& arguments) {
  std::vector<std::string> words = words_of(arguments.command);
  const CLI::App& command = command_for(vernier, words);
  if (words.front() == "fleet" || words.front() == "workbench")
    throw text::InputError({}, words.front(), "this command cannot run for each machine of a batch");
  for (const std::string& word : words)
    if (word == "--json" || word.starts_with("--json="))
      throw text::InputError({}, word,
                             "remove this option: the batch stores the result of each machine by itself");
  if (std::none_of(words.begin(), words.end(),
                   [](const std::string& word) { return word.find("{machine}") != std::string::npos; }))
    throw text::InputError(
        "the command does not contain {machine}, so it would be the same for each machine");
  if (command.get_option_no_throw("--json") != nullptr) words.insert(words.end(), {"--json", "-"});
  return words;
}

void write_script(const std::string& file, const std::string& script) {
  text::write_file(file, script);
  ::chmod(file.c_str(), S_IRWXU | S_IRGRP | S_IXGRP | S_IROTH | S_IXOTH);
}

std::string parallel_script(const registry::Batch& batch) {
  return fmt::format(
      "#!/bin/sh\n"
      "# {} machines with GNU parallel. Options of parallel may follow (-j 8). Called again after an end of\n"
      "# any kind, it goes on, and repeats what failed.\n"
      "vernier=${{VERNIER:-}}\n"
      "[ -n \"$vernier\" ] || vernier={}\n"
      "cd \"$(dirname \"$0\")\" || exit 1\n"
      "parallel --version 2>/dev/null | grep -q GNU || {{ echo \"install GNU parallel (parallel)\" >&2; exit "
      "1; }}\n"
      "exec parallel --joblog joblog --resume-failed \"$@\" --quote \"$vernier\" fleet task . {{}} :::: "
      "machines\n",
      batch.machines.size(), quoted(this_program()));
}

std::string slurm_script(const registry::Batch& batch, const std::string& folder) {
  const std::string place = std::filesystem::absolute(folder).lexically_normal().string();
  if (place.find_first_of("\"\\%\n") != std::string::npos)
    throw text::InputError({}, place,
                           "the path of the folder of a Slurm batch must not contain a double quote, a "
                           "backslash, a percent sign or a line end");
  const std::size_t machines = batch.machines.size(), tasks = std::min(machines, kMostTasks);
  return fmt::format(
      "#!/bin/sh\n"
      "#SBATCH --job-name=vernier-{0}\n"
      "#SBATCH --array=1-{1}\n"
      "#SBATCH --output=\"{2}/logs/%a.log\"\n"
      "# {3} machines with Slurm: sbatch FILE. Called again it repeats what has no answer. All nodes need "
      "this\n"
      "# folder and the folders of the command.\n"
      "vernier=${{VERNIER:-}}\n"
      "[ -n \"$vernier\" ] || vernier={4}\n"
      "cd {5} || exit 1\n"
      "status=0\n"
      "line=$SLURM_ARRAY_TASK_ID\n"
      "while [ \"$line\" -le {3} ]; do\n"
      "  \"$vernier\" fleet task . \"$(sed -n \"${{line}}p\" machines)\" || status=$?\n"
      "  line=$((line + {1}))\n"
      "done\n"
      "exit \"$status\"\n",
      batch.name, tasks, place, machines, quoted(this_program()), quoted(place));
}

void run_batch(const CLI::App& vernier, const BatchArguments& arguments) {
  if (!registry::is_machine_name(arguments.name))
    throw text::InputError({}, arguments.name,
                           "the name of a batch may contain only letters, digits, . _ and -");
  registry::Registry registry = open_registry(arguments.registry);
  registry::Batch batch{"", arguments.name, std::filesystem::current_path().string(),
                        command_of(vernier, arguments), arguments.machines};
  for (const std::string& machine : batch.machines) registry.machine(machine);
  if (batch.machines.empty())
    for (const registry::FleetMachine& machine : registry.machines()) batch.machines.push_back(machine.name);
  if (batch.machines.empty())
    throw text::InputError("the registry has no machine: " + registry.database().name());
  const std::string folder = arguments.folder.empty() ? arguments.name : arguments.folder;
  const bool slurm = arguments.scheduler == "slurm";
  const std::string script = slurm ? slurm_script(batch, folder) : parallel_script(batch);
  batch = registry::write_batch(folder, batch);
  if (slurm) text::make_folder(folder + "/logs");
  const std::string file = folder + (slurm ? "/slurm.sh" : "/parallel.sh");
  write_script(file, script);
  fmt::print(
      "The script runs the command for {} machines. Start the script: {}{}\nThen record the results: vernier "
      "fleet collect {}\n",
      batch.machines.size(),
      slurm                 ? "sbatch "
      : file.front() == '/' ? ""
                            : "./",
      quoted(file), quoted(folder));
}

struct TaskArguments {
  std::string folder, machine;
};

/// Runs the command of a machine and writes its answer. Throws LimitNotMet after a failure.
void run_task(const TaskArguments& arguments) {
  const registry::Batch batch = registry::read_batch(arguments.folder);
  const std::vector<std::string> words = registry::command_of(batch, arguments.machine);
  if (registry::has_answer(arguments.folder, batch, arguments.machine)) return;
  text::RunningProcess running;
  const text::ProcessResult ended = text::run_process(
      this_program(), words, batch.directory, kMostOutput,
      [](std::string_view line) { fmt::print(stderr, "{}\n", line); }, running);
  registry::BatchAnswer answer{arguments.machine, ended.exit, nullptr};
  std::string message = text::last_line(ended.err);
  const bool has_json = words.size() > 1 && words[words.size() - 2] == "--json";
  if (has_json && (ended.exit == 0 || ended.exit == 2)) {
    if (!text::nests_deeper_than(ended.out, text::kMostJsonDepth))
      answer.result = Json::parse(ended.out, nullptr, false);
    // A command may answer no before it has a result.
    if (answer.result.is_discarded() || (answer.result.is_null() && ended.exit == 0)) answer.result = nullptr;
    if (answer.result.is_null() && ended.exit == 0)
      answer.status = 70,
      message = "the command of this machine ended without an error, but its output is not JSON";
  }
  registry::write_answer(arguments.folder, batch, answer, message);
  if (answer.status != 0 && answer.status != 2)
    throw text::LimitNotMet(fmt::format("{}: exit status {}: {}", arguments.machine, answer.status, message));
}

struct CollectArguments {
  std::string registry, folder, json;
};

void run_collect(const CollectArguments& arguments) {
  const registry::Batch batch = registry::read_batch(arguments.folder);
  registry::Registry registry = open_registry(arguments.registry);
  const registry::Collected collected = registry::collect(registry, arguments.folder, batch);
  std::FILE* const out = human_stream(arguments.json);
  fmt::print(out, "{}: {} answers booked now, {} before, {} not booked of {} machines\n", batch.name,
             collected.booked, collected.before, collected.not_booked.size(), batch.machines.size());
  Json left = Json::array();
  for (const registry::NotBooked& one : collected.not_booked) {
    fmt::print(out, "  {:<20} {:<10} {}\n", one.machine, one.state, one.why);
    left.push_back({{"machine", one.machine}, {"state", one.state}, {"why", one.why}});
  }
  write_json(arguments.json, {{"batch", batch.id},
                              {"name", batch.name},
                              {"machines", batch.machines.size()},
                              {"booked", collected.booked},
                              {"booked_before", collected.before},
                              {"not_booked", left}});
  if (!collected.not_booked.empty())
    throw text::LimitNotMet(fmt::format("{} answers are not booked", collected.not_booked.size()));
}

void run_answers(const CollectArguments& arguments) {
  registry::Registry registry = open_registry(arguments.registry);
  std::FILE* const out = human_stream(arguments.json);
  Json all = Json::array();
  for (const registry::BookedAnswer& one : registry::booked_answers(registry, arguments.folder)) {
    const Json result = Json::parse(one.result);
    const bool has_verdict =
        result.is_object() && result.contains("verdict") && result["verdict"].is_string();
    fmt::print(out, "{:<16} {:<20} {:>2}  {}\n", one.name, one.machine, one.status,
               has_verdict ? result["verdict"].get<std::string>() : "");
    all.push_back({{"name", one.name},
                   {"batch", one.batch},
                   {"machine", one.machine},
                   {"status", one.status},
                   {"at", text::utc_text(one.at_us)},
                   {"result", result}});
  }
  write_json(arguments.json, {{"answers", all}});
}

}  // namespace

void add_batch(CLI::App& fleet) {
  const auto batch = std::make_shared<BatchArguments>();
  CLI::App* command =
      fleet.add_subcommand("batch", "write a command for each machine, for GNU parallel or Slurm");
  command->add_option("NAME", batch->name, "name of the batch, e.g. night-2026-11-23")->required();
  add_registry(*command, batch->registry);
  command->add_option("-o,--output", batch->folder, "new directory of the batch; default: NAME")
      ->type_name(kWritesFolder);
  command->add_option("--scheduler", batch->scheduler, "program that runs the commands: parallel or slurm")
      ->check(CLI::IsMember({"parallel", "slurm"}))
      ->capture_default_str();
  command
      ->add_option("--machine", batch->machines,
                   "names of the machines of the batch; default: all machines of the registry")
      ->allow_extra_args(false);
  command->prefix_command();
  command->footer(
      "After NAME and the options, write the vernier command for each machine, with {machine} in place of "
      "its name:\n"
      "  vernier fleet batch night --scheduler slurm diagnose models/{machine}.xml data/{machine}.csv\n"
      "The command for each machine runs in the present directory. The result of the command (--json) is the "
      "answer of the machine.\n"
      "Exit status 0 done, 1 bad input.");
  CLI::App* const vernier = fleet.get_parent();
  command->callback([batch, command, vernier] {
    batch->command = command->remaining();
    run_batch(*vernier, *batch);
  });

  const auto task = std::make_shared<TaskArguments>();
  command =
      fleet.add_subcommand("task", "run the command of one machine of a batch (the scheduler calls it)");
  command->add_option("DIR", task->folder, "directory that `fleet batch` wrote")
      ->type_name(kReadsFolder)
      ->required();
  command->add_option("MACHINE", task->machine, "machine of the batch")->required();
  command->footer(
      "If the machine already has an answer, the command does not run again. Exit status 0 the answer is "
      "written, 1 bad input, 2 the command failed.");
  command->callback([task] { run_task(*task); });

  const auto collect = std::make_shared<CollectArguments>();
  command = fleet.add_subcommand("collect",
                                 "record the result of a batch command for each machine in the registry; a "
                                 "repeated call records no result twice");
  command->add_option("DIR", collect->folder, "directory that `fleet batch` wrote")
      ->type_name(kReadsFolder)
      ->required();
  add_registry(*command, collect->registry);
  command->add_option("--json", collect->json,
                      "file for the result as JSON, for programs; - for standard output");
  command->footer(
      "The command may be called several times, also while the batch runs. Exit status 0 the answers of all\n"
      "machines are booked, 1 bad input, 2 some answers are not booked (the command lists these answers).");
  command->callback([collect] { run_collect(*collect); });

  const auto answers = std::make_shared<CollectArguments>();
  command = fleet.add_subcommand("answers", "list the booked answers of batches");
  command->add_option("NAME", answers->folder, "list only the answers of batches with this name");
  add_registry(*command, answers->registry);
  command->add_option("--json", answers->json,
                      "file for the result as JSON, for programs; - for standard output");
  command->callback([answers] { run_answers(*answers); });
}

}  // namespace vernier::commands::fleet_cli
