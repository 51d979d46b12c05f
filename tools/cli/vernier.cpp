#include <CLI/CLI.hpp>
#include <cstdio>
#include <exception>

#include "tools/cli/command.h"
#include "tools/model/error.h"

namespace {

constexpr int kDone = 0, kBadInput = 1, kAnswerIsNo = 2, kOurBug = 70;

/// In the order of the journey; `vernier` alone prints them so.
constexpr vernier::RegisterCommand kCommands[] = {
    vernier::register_import,    vernier::register_features,   vernier::register_fit,
    vernier::register_compare,   vernier::register_diagnose,   vernier::register_add,
    vernier::register_effects,   vernier::register_plan,       vernier::register_improve,
    vernier::register_derive,    vernier::register_compile,    vernier::register_simulate,
    vernier::register_replay,    vernier::register_keys,       vernier::register_upload,
    vernier::register_board,     vernier::register_status,     vernier::register_watch,
    vernier::register_record,    vernier::register_touches,    vernier::register_probe_path,
    vernier::register_probe_cal, vernier::register_feature,    vernier::register_pose,
    vernier::register_solve,     vernier::register_export,     vernier::register_import_tables,
    vernier::register_map,       vernier::register_part,       vernier::register_set,
    vernier::register_exclude,   vernier::register_image_diff, vernier::register_workbench,
};

int run(int argc, char** argv) {
  CLI::App app{
      "Vernier makes real machines accurate: from measurements to a model of the errors to a running "
      "correction."};
  app.set_version_flag("--version", "vernier " VERNIER_VERSION " (" VERNIER_COMMIT ")");
  app.footer(
      "Exit status: 0 done, 1 bad input or usage (nothing written), 2 the answer is no, 70 internal error.\n"
      "`vernier COMMAND --help` documents each command.");
  for (const auto command : kCommands) command(app);
  if (argc <= 1) {
    std::fputs(app.help().c_str(), stdout);
    return kDone;
  }
  app.require_subcommand(1);
  try {
    app.parse(argc, argv);
  } catch (const CLI::CallForHelp& call) {
    return app.exit(call);
  } catch (const CLI::CallForVersion& call) {
    return app.exit(call);
  } catch (const CLI::ParseError& error) {
    app.exit(error);
    return kBadInput;
  }
  return kDone;
}

}  // namespace

int main(int argc, char** argv) {
  try {
    return run(argc, argv);
  } catch (const vernier::InputError& error) {
    std::fprintf(stderr, "vernier: %s\n", error.what());
    return kBadInput;
  } catch (const vernier::LimitNotMet& error) {
    std::fprintf(stderr, "vernier: %s\n", error.what());
    return kAnswerIsNo;
  } catch (const std::exception& error) {
    std::fprintf(stderr, "vernier: internal error: %s\n", error.what());
    return kOurBug;
  }
}
