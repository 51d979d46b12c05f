// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <CLI/CLI.hpp>
#include <nlohmann/json.hpp>
#include <string>

#include "tools/text/files.h"

namespace vernier::commands {

/// Adds one subcommand to the program `vernier`. The callback of the subcommand executes the command. If a
/// command fails, it throws InputError (exit 1) or LimitNotMet (exit 2). A command that succeeds returns
/// normally (exit 0). Any other exception of a callback is an internal error of Vernier (exit 70). Each
/// command has one function of this type. tools/commands/vernier.cpp lists these functions by topic.
using RegisterCommand = void (*)(CLI::App& vernier);

namespace again_cli {
void register_again(CLI::App& vernier);
}  // namespace again_cli
namespace ballbar_path_cli {
void register_ballbar_path(CLI::App& vernier);
}  // namespace ballbar_path_cli
namespace board_cli {
void register_board(CLI::App& vernier);
}  // namespace board_cli
namespace compare_cli {
void register_compare(CLI::App& vernier);
}  // namespace compare_cli
namespace compile_cli {
void register_compile(CLI::App& vernier);
}  // namespace compile_cli
namespace check_cli {
void register_check(CLI::App& vernier);
}  // namespace check_cli
namespace correct_cli {
void register_correct(CLI::App& vernier);
}  // namespace correct_cli
namespace completion_cli {
void register_completion(CLI::App& vernier);
}  // namespace completion_cli
namespace derive_cli {
void register_derive(CLI::App& vernier);
}  // namespace derive_cli
namespace diagnose_cli {
void register_diagnose(CLI::App& vernier);
}  // namespace diagnose_cli
namespace edit_cli {
void register_exclude(CLI::App& vernier);
void register_set(CLI::App& vernier);
}  // namespace edit_cli
namespace effects_cli {
void register_effects(CLI::App& vernier);
void register_add(CLI::App& vernier);
}  // namespace effects_cli
namespace evaluate_cli {
void register_evaluate(CLI::App& vernier);
}  // namespace evaluate_cli
namespace exchange_cli {
void register_export(CLI::App& vernier);
void register_import_tables(CLI::App& vernier);
}  // namespace exchange_cli
namespace features_cli {
void register_features(CLI::App& vernier);
}  // namespace features_cli
namespace fleet_cli {
void register_fleet(CLI::App& vernier);
}  // namespace fleet_cli
namespace fit_cli {
void register_fit(CLI::App& vernier);
}  // namespace fit_cli
namespace import_cli {
void register_import(CLI::App& vernier);
}  // namespace import_cli
namespace improve_cli {
void register_improve(CLI::App& vernier);
}  // namespace improve_cli
namespace keys_cli {
void register_keys(CLI::App& vernier);
}  // namespace keys_cli
namespace lint_cli {
void register_lint(CLI::App& vernier);
}  // namespace lint_cli
namespace manual_cli {
void register_manual(CLI::App& vernier);
}  // namespace manual_cli
namespace map_cli {
void register_map(CLI::App& vernier);
}  // namespace map_cli
namespace new_cli {
void register_new(CLI::App& vernier);
}  // namespace new_cli
namespace part_cli {
void register_part(CLI::App& vernier);
}  // namespace part_cli
namespace plan_cli {
void register_plan(CLI::App& vernier);
}  // namespace plan_cli
namespace pose_cli {
void register_pose(CLI::App& vernier);
}  // namespace pose_cli
namespace probe_cli {
void register_probe_cal(CLI::App& vernier);
void register_probe_path(CLI::App& vernier);
void register_feature(CLI::App& vernier);
}  // namespace probe_cli
namespace record_cli {
void register_record(CLI::App& vernier);
}  // namespace record_cli
namespace replay_cli {
void register_replay(CLI::App& vernier);
}  // namespace replay_cli
namespace simulate_cli {
void register_simulate(CLI::App& vernier);
}  // namespace simulate_cli
namespace solve_cli {
void register_solve(CLI::App& vernier);
}  // namespace solve_cli
namespace touches_cli {
void register_touches(CLI::App& vernier);
}  // namespace touches_cli
namespace upload_cli {
void register_upload(CLI::App& vernier);
}  // namespace upload_cli
namespace watch_cli {
void register_status(CLI::App& vernier);
void register_watch(CLI::App& vernier);
}  // namespace watch_cli
namespace workbench_cli {
void register_workbench(CLI::App& vernier);
void register_image_diff(CLI::App& vernier);
}  // namespace workbench_cli

/// Writes the result of a command for programs: to a file, or to standard output if the path is "-". If the
/// path is empty, nothing is written. Throws std::logic_error if a number that tools/docs/formats.md defines
/// is not finite.
void write_json(const std::string& path, const nlohmann::ordered_json& result);

/// Values for type_name() of an option that names a file or a folder. The type names of file options
/// determine what the help prints (file or folder), and whether the command reads or writes it. The workbench
/// permits only names inside its folder for such options (description.h).
inline constexpr const char *kReads = "FILE", *kReadsFolder = "FOLDER", *kReadsOrServer = "FILE:or server",
                            *kWrites = "FILE:written", *kWritesFolder = "FOLDER:written";

/// Names the rules of the safety sheet in the help of `--accept` and on the page of the workbench. The
/// validator accepts any word: safety::rules_named refuses a wrong one and lists the rules.
CLI::Validator rule_words();

/// Help text of the option `--residuals`.
inline constexpr const char* kResidualsHelp =
    "every reading as CSV: row, observation, value, prediction, residual, u (mm or deg)";

/// Returns the stream for text for people: standard output, or standard error if `--json -` uses standard
/// output.
std::FILE* human_stream(const std::string& json_path);

/// Prints the progress of a command that takes more than two seconds to standard error. On a terminal one
/// progress line is updated. If the output is not a terminal, each step is printed on its own line. If the
/// environment variable VERNIER_PROGRESS is `lines` (for a program that reads the progress), every step is
/// printed immediately.
class Progress {
 public:
  explicit Progress(std::string what);
  ~Progress();
  Progress(const Progress&) = delete;
  Progress& operator=(const Progress&) = delete;
  /// `fraction`: completed fraction of the work, 0..1; `step`: name of the present operation.
  void update(double fraction, const std::string& step = {});

 private:
  std::string what_;
  double started_s_ = 0, last_s_ = 0;
  bool shown_ = false;
};

}  // namespace vernier::commands
