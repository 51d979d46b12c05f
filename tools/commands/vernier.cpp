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
constexpr vernier::commands::RegisterCommand kCommands[] = {
    vernier::commands::new_cli::register_new,
    vernier::commands::import_cli::register_import,
    vernier::commands::lint_cli::register_lint,
    vernier::commands::features_cli::register_features,
    vernier::commands::fit_cli::register_fit,
    vernier::commands::compare_cli::register_compare,
    vernier::commands::evaluate_cli::register_evaluate,
    vernier::commands::diagnose_cli::register_diagnose,
    vernier::commands::effects_cli::register_add,
    vernier::commands::effects_cli::register_effects,
    vernier::commands::plan_cli::register_plan,
    vernier::commands::ballbar_path_cli::register_ballbar_path,
    vernier::commands::improve_cli::register_improve,
    vernier::commands::derive_cli::register_derive,
    vernier::commands::compile_cli::register_compile,
    vernier::commands::simulate_cli::register_simulate,
    vernier::commands::replay_cli::register_replay,
    vernier::commands::keys_cli::register_keys,
    vernier::commands::upload_cli::register_upload,
    vernier::commands::board_cli::register_board,
    vernier::commands::watch_cli::register_status,
    vernier::commands::watch_cli::register_watch,
    vernier::commands::record_cli::register_record,
    vernier::commands::touches_cli::register_touches,
    vernier::commands::probe_cli::register_probe_path,
    vernier::commands::probe_cli::register_probe_cal,
    vernier::commands::probe_cli::register_feature,
    vernier::commands::check_cli::register_check,
    vernier::commands::fleet_cli::register_fleet,
    vernier::commands::correct_cli::register_correct,
    vernier::commands::pose_cli::register_pose,
    vernier::commands::solve_cli::register_solve,
    vernier::commands::exchange_cli::register_export,
    vernier::commands::exchange_cli::register_import_tables,
    vernier::commands::map_cli::register_map,
    vernier::commands::part_cli::register_part,
    vernier::commands::edit_cli::register_set,
    vernier::commands::edit_cli::register_exclude,
    vernier::commands::workbench_cli::register_image_diff,
    vernier::commands::workbench_cli::register_workbench,
    vernier::commands::completion_cli::register_completion,
    vernier::commands::manual_cli::register_manual,
};

/// Before a command works: is there a place for the result that it writes last?
void require_places(const CLI::App& app) {
  for (const CLI::App* command : app.get_subcommands()) {
    const CLI::Option* json = command->get_option_no_throw("--json");
    if (json != nullptr && json->count() > 0 && json->as<std::string>() != "-")
      vernier::text::require_place(json->as<std::string>());
    require_places(*command);
  }
}

/// Added last: `vernier help` stands in the list as a command, though it is read as --help before.
void add_help_command(CLI::App& app) {
  app.add_subcommand("help", "This list, or what a command does: vernier help fit");
  const auto formatter = std::make_shared<vernier::commands::HelpText>();
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
  vernier::commands::take_plain_numbers(app);
  app.require_subcommand(1);
  if (arguments.empty()) {
    std::fputs(app.help().c_str(), stdout);
    return kDone;
  }
  vernier::commands::require_known_commands(app, arguments);
  app.parse_complete_callback([&] {
    vernier::commands::require_files_in_their_places(app, arguments);
    require_places(app);
    vernier::commands::warn_of_machine(app);
  });
  try {
    // CLI11 takes the words from the back.
    app.parse(std::vector<std::string>(arguments.rbegin(), arguments.rend()));
  } catch (const CLI::CallForHelp& call) {
    return app.exit(call);
  } catch (const CLI::CallForVersion& call) {
    return app.exit(call);
  } catch (const CLI::ParseError& error) {
    const std::string meant = vernier::commands::option_meant(app, error);
    if (!meant.empty()) throw vernier::text::InputError(meant);
    app.exit(error);
    return kBadInput;
  }
  return kDone;
}

}  // namespace

int main(int argc, char** argv) {
  const std::vector<std::string> arguments = vernier::commands::without_help_command(
      std::vector<std::string>(argv + std::min(argc, 1), argv + argc));
  try {
    return run(arguments);
  } catch (const vernier::text::InputError& error) {
    std::fprintf(stderr, "vernier: %s\n", error.what());
    const std::string hint = vernier::commands::import_hint(error.what(), arguments);
    if (!hint.empty()) std::fprintf(stderr, "vernier: %s\n", hint.c_str());
    return kBadInput;
  } catch (const vernier::text::LimitNotMet& error) {
    std::fprintf(stderr, "vernier: %s\n", error.what());
    return kAnswerIsNo;
  } catch (const std::exception& error) {
    std::fprintf(stderr, "vernier: internal error: %s\n", error.what());
    return kOurBug;
  }
}
