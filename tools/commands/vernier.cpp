// SPDX-License-Identifier: GPL-3.0-or-later
#include <CLI/CLI.hpp>
#include <algorithm>
#include <cstdio>
#include <exception>
#include <memory>
#include <sstream>
#include <string>
#include <vector>

#include "tools/commands/command.h"
#include "tools/commands/help_text.h"
#include "tools/commands/manners.h"
#include "tools/provenance/provenance.h"
#include "tools/text/error.h"
#include "tools/text/words.h"

namespace {

constexpr const char* kProgram = "vernier " VERNIER_VERSION " (" VERNIER_COMMIT ")";
constexpr int kDone = 0, kBadInput = 1, kAnswerIsNo = 2, kOurBug = 70;

/// Commands of one topic, in the order of the workflow.
struct Topic {
  const char* name;
  std::vector<vernier::commands::RegisterCommand> commands;
};

/// In the order of the workflow; `vernier` alone prints them so.
const std::vector<Topic>& topics() {
  using namespace vernier::commands;
  static const std::vector<Topic> kTopics = {
      {"Measure",
       {new_cli::register_new, plan_cli::register_plan, ballbar_path_cli::register_ballbar_path,
        import_cli::register_import, lint_cli::register_lint, features_cli::register_features,
        edit_cli::register_exclude}},
      {"Model",
       {fit_cli::register_fit, compare_cli::register_compare, diagnose_cli::register_diagnose,
        effects_cli::register_add, improve_cli::register_improve, effects_cli::register_effects,
        edit_cli::register_set, map_cli::register_map, pose_cli::register_pose, solve_cli::register_solve,
        derive_cli::register_derive}},
      {"Judge", {check_cli::register_check, evaluate_cli::register_evaluate, part_cli::register_part}},
      {"Run on a board",
       {compile_cli::register_compile, simulate_cli::register_simulate, replay_cli::register_replay,
        workbench_cli::register_image_diff, keys_cli::register_keys, upload_cli::register_upload,
        board_cli::register_board, watch_cli::register_status, watch_cli::register_watch,
        record_cli::register_record}},
      {"Touch probe",
       {probe_cli::register_probe_path, touches_cli::register_touches, probe_cli::register_probe_cal,
        probe_cli::register_feature}},
      {"Other controllers",
       {exchange_cli::register_export, exchange_cli::register_import_tables, correct_cli::register_correct}},
      {"Many machines", {fleet_cli::register_fleet}},
      {"This program",
       {workbench_cli::register_workbench, again_cli::register_again, completion_cli::register_completion,
        manual_cli::register_manual}},
  };
  return kTopics;
}

/// Adds all commands, each in the group of its topic.
void add_commands(CLI::App& app) {
  for (const Topic& topic : topics())
    for (const auto command : topic.commands) {
      const auto before = app.get_subcommands([](const CLI::App*) { return true; }).size();
      command(app);
      const auto all = app.get_subcommands([](const CLI::App*) { return true; });
      for (std::size_t i = before; i < all.size(); ++i) all[i]->group(topic.name);
    }
}

/// Before a command works: is there a place for the result that it writes last?
void require_places(const CLI::App& app) {
  for (const CLI::App* command : app.get_subcommands()) {
    const CLI::Option* json = command->get_option_no_throw("--json");
    if (json != nullptr && json->count() > 0 && json->as<std::string>() != "-")
      vernier::text::require_place(json->as<std::string>());
    require_places(*command);
  }
}

/// `vernier help` is in the list as a command, though it is read as --help before. Added last.
void add_help_command(CLI::App& app) {
  app.add_subcommand("help", "Print this list, or the help of a command: vernier help fit")
      ->group(topics().back().name);
  const auto formatter = std::make_shared<vernier::commands::HelpText>();
  app.formatter(formatter);
  for (CLI::App* command : app.get_subcommands([](const CLI::App*) { return true; })) {
    command->formatter(formatter);
    for (CLI::App* kind : command->get_subcommands([](const CLI::App*) { return true; }))
      kind->formatter(formatter);
  }
}

/// What `vernier` prints without a command: the way of the first hour.
constexpr const char* kFirstHour =
    "Vernier makes machine tools, measuring machines and robots more accurate.\n\n"
    "The first hour:\n"
    "  vernier new gantry --axis X:0:600 --axis Y:0:400 --axis Z:0:300 -o machine.xml\n"
    "                                                  create a machine file (a robot: --urdf)\n"
    "  vernier import table laser.xlsx -o survey.csv   read the file of an instrument\n"
    "  vernier fit machine.xml survey.csv -o fitted.xml\n"
    "                                                  estimate the errors of the machine\n"
    "  vernier diagnose machine.xml survey.csv -o report.html\n"
    "                                                  find which physical effect is missing\n"
    "  vernier evaluate iso230-2 survey.csv --axis X   evaluate a positioning test\n\n"
    "All steps in a browser: vernier workbench\n"
    "All commands:          vernier --help\n"
    "One command:           vernier fit --help\n";

int run(const std::vector<std::string>& arguments) {
  if (arguments.empty()) {
    std::fputs(kFirstHour, stdout);
    return kDone;
  }
  CLI::App app{
      "Vernier makes machine tools, measuring machines and robots more accurate. Vernier fits a model of the "
      "machine's errors to measurements, and corrects the axes with this model.",
      "vernier"};
  app.set_version_flag("-V,--version", kProgram);
  app.footer(
      "Exit status: 0 done, 1 bad input or usage (nothing written), 2 negative result (for example, a "
      "tolerance is not met), 70 internal error.\n"
      "`vernier COMMAND --help` documents each command.");
  add_commands(app);
  add_help_command(app);
  vernier::commands::take_plain_numbers(app);
  app.require_subcommand(1);
  vernier::commands::require_known_commands(app, arguments);
  vernier::commands::require_known_dashes(app, arguments);
  app.parse_complete_callback([&] {
    vernier::provenance::record_provenance(arguments, kProgram);
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
    std::ostringstream out, said;
    app.exit(error, out, said);
    std::fputs(out.str().c_str(), stdout);
    std::fputs(vernier::text::shown_message(vernier::commands::plain_range(said.str())).c_str(), stderr);
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
    std::fprintf(stderr, "vernier: %s\n", vernier::text::shown_message(error.what()).c_str());
    const std::string hint = vernier::commands::import_hint(error.what(), arguments);
    if (!hint.empty()) std::fprintf(stderr, "vernier: %s\n", vernier::text::shown_message(hint).c_str());
    return kBadInput;
  } catch (const vernier::text::LimitNotMet& error) {
    std::fprintf(stderr, "vernier: %s\n", vernier::text::shown_message(error.what()).c_str());
    return kAnswerIsNo;
  } catch (const std::exception& error) {
    std::fprintf(stderr, "vernier: internal error: %s\n", vernier::text::shown_message(error.what()).c_str());
    return kOurBug;
  }
}
