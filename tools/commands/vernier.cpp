// SPDX-License-Identifier: GPL-3.0-or-later
#include <CLI/CLI.hpp>
#include <algorithm>
#include <cstdio>
#include <exception>
#include <memory>
#include <string>
#include <vector>

#include "tools/commands/command.h"
#include "tools/commands/help_text.h"
#include "tools/commands/manners.h"
#include "tools/text/error.h"

namespace {

constexpr int kDone = 0, kBadInput = 1, kAnswerIsNo = 2, kOurBug = 70;

/// In the order of the journey; `vernier` alone prints them so.
constexpr vernier::RegisterCommand kCommands[] = {
    vernier::new_cli::register_new,
    vernier::import_cli::register_import,
    vernier::lint_cli::register_lint,
    vernier::features_cli::register_features,
    vernier::fit_cli::register_fit,
    vernier::compare_cli::register_compare,
    vernier::evaluate_cli::register_evaluate,
    vernier::diagnose_cli::register_diagnose,
    vernier::effects_cli::register_add,
    vernier::effects_cli::register_effects,
    vernier::plan_cli::register_plan,
    vernier::ballbar_path_cli::register_ballbar_path,
    vernier::improve_cli::register_improve,
    vernier::derive_cli::register_derive,
    vernier::compile_cli::register_compile,
    vernier::simulate_cli::register_simulate,
    vernier::replay_cli::register_replay,
    vernier::keys_cli::register_keys,
    vernier::upload_cli::register_upload,
    vernier::board_cli::register_board,
    vernier::watch_cli::register_status,
    vernier::watch_cli::register_watch,
    vernier::record_cli::register_record,
    vernier::touches_cli::register_touches,
    vernier::probe_cli::register_probe_path,
    vernier::probe_cli::register_probe_cal,
    vernier::probe_cli::register_feature,
    vernier::check_cli::register_check,
    vernier::correct_cli::register_correct,
    vernier::pose_cli::register_pose,
    vernier::solve_cli::register_solve,
    vernier::exchange_cli::register_export,
    vernier::exchange_cli::register_import_tables,
    vernier::map_cli::register_map,
    vernier::part_cli::register_part,
    vernier::edit_cli::register_set,
    vernier::edit_cli::register_exclude,
    vernier::workbench_cli::register_image_diff,
    vernier::workbench_cli::register_workbench,
    vernier::completion_cli::register_completion,
    vernier::manual_cli::register_manual,
};

/// Before a command works: is there a place for the result that it writes last?
void require_places(const CLI::App& app) {
  for (const CLI::App* command : app.get_subcommands()) {
    const CLI::Option* json = command->get_option_no_throw("--json");
    if (json != nullptr && json->count() > 0 && json->as<std::string>() != "-")
      vernier::require_place(json->as<std::string>());
    require_places(*command);
  }
}

/// Added last: `vernier help` stands in the list as a command, though it is read as --help before.
void add_help_command(CLI::App& app) {
  app.add_subcommand("help", "This list, or what a command does: vernier help fit");
  const auto formatter = std::make_shared<vernier::HelpText>();
  app.formatter(formatter);
  for (CLI::App* command : app.get_subcommands([](const CLI::App*) { return true; })) {
    command->formatter(formatter);
    for (CLI::App* kind : command->get_subcommands([](const CLI::App*) { return true; }))
      kind->formatter(formatter);
  }
}

int run(const std::vector<std::string>& arguments) {
  CLI::App app{
      "Vernier makes real machines accurate: from measurements to a model of the errors to a running "
      "correction.",
      "vernier"};
  app.set_version_flag("-V,--version", "vernier " VERNIER_VERSION " (" VERNIER_COMMIT ")");
  app.footer(
      "Exit status: 0 done, 1 bad input or usage (nothing written), 2 the answer is no, 70 internal error.\n"
      "`vernier COMMAND --help` documents each command.");
  for (const auto command : kCommands) command(app);
  add_help_command(app);
  app.require_subcommand(1);
  if (arguments.empty()) {
    std::fputs(app.help().c_str(), stdout);
    return kDone;
  }
  vernier::require_known_commands(app, arguments);
  app.parse_complete_callback([&] {
    vernier::require_files_in_their_places(app, arguments);
    require_places(app);
    vernier::warn_of_machine(app);
  });
  try {
    // CLI11 takes the words from the back.
    app.parse(std::vector<std::string>(arguments.rbegin(), arguments.rend()));
  } catch (const CLI::CallForHelp& call) {
    return app.exit(call);
  } catch (const CLI::CallForVersion& call) {
    return app.exit(call);
  } catch (const CLI::ParseError& error) {
    const std::string meant = vernier::option_meant(app, error);
    if (!meant.empty()) throw vernier::InputError(meant);
    app.exit(error);
    return kBadInput;
  }
  return kDone;
}

}  // namespace

int main(int argc, char** argv) {
  const std::vector<std::string> arguments =
      vernier::without_help_command(std::vector<std::string>(argv + std::min(argc, 1), argv + argc));
  try {
    return run(arguments);
  } catch (const vernier::InputError& error) {
    std::fprintf(stderr, "vernier: %s\n", error.what());
    const std::string hint = vernier::import_hint(error.what(), arguments);
    if (!hint.empty()) std::fprintf(stderr, "vernier: %s\n", hint.c_str());
    return kBadInput;
  } catch (const vernier::LimitNotMet& error) {
    std::fprintf(stderr, "vernier: %s\n", error.what());
    return kAnswerIsNo;
  } catch (const std::exception& error) {
    std::fprintf(stderr, "vernier: internal error: %s\n", error.what());
    return kOurBug;
  }
}
