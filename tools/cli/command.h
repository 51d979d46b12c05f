#pragma once
#include <CLI/CLI.hpp>
#include <nlohmann/json.hpp>
#include <string>

#include "tools/model/files.h"

namespace vernier {

/// Adds one subcommand to `vernier`. Its callback does the job; it throws InputError (exit 1) or LimitNotMet
/// (exit 2) and returns normally otherwise (exit 0). Anything else that escapes is our bug (exit 70). One
/// function a command, listed in the order of the journey in tools/cli/vernier.cpp.
using RegisterCommand = void (*)(CLI::App& vernier);

void register_import(CLI::App& vernier);
void register_features(CLI::App& vernier);
void register_fit(CLI::App& vernier);
void register_compare(CLI::App& vernier);
void register_diagnose(CLI::App& vernier);
void register_add(CLI::App& vernier);
void register_effects(CLI::App& vernier);
void register_plan(CLI::App& vernier);
void register_improve(CLI::App& vernier);
void register_set(CLI::App& vernier);
void register_exclude(CLI::App& vernier);
void register_workbench(CLI::App& vernier);
void register_image_diff(CLI::App& vernier);
void register_derive(CLI::App& vernier);
void register_compile(CLI::App& vernier);
void register_simulate(CLI::App& vernier);
void register_replay(CLI::App& vernier);
void register_part(CLI::App& vernier);
void register_pose(CLI::App& vernier);
void register_solve(CLI::App& vernier);
void register_export(CLI::App& vernier);
void register_import_tables(CLI::App& vernier);
void register_map(CLI::App& vernier);
void register_keys(CLI::App& vernier);
void register_upload(CLI::App& vernier);
void register_board(CLI::App& vernier);
void register_status(CLI::App& vernier);
void register_watch(CLI::App& vernier);
void register_record(CLI::App& vernier);
void register_touches(CLI::App& vernier);
void register_probe_path(CLI::App& vernier);
void register_probe_cal(CLI::App& vernier);
void register_feature(CLI::App& vernier);

/// Writes the result for programs: to a file, or to standard output for "-"; nothing for an empty path.
/// Numbers that are not finite become null.
void write_json(const std::string& path, const nlohmann::ordered_json& result);

/// Where the human-readable lines go: standard output, or standard error where `--json -` has taken standard
/// output.
std::FILE* human_stream(const std::string& json_path);

/// Progress of a job that may take more than two seconds, on standard error if it is a terminal; else one
/// line a step (all of them, and at once, where VERNIER_PROGRESS=lines says that a program reads them).
class Progress {
 public:
  explicit Progress(std::string what);
  ~Progress();
  Progress(const Progress&) = delete;
  Progress& operator=(const Progress&) = delete;
  /// fraction 0..1, and what is being done now.
  void update(double fraction, const std::string& step = {});

 private:
  std::string what_;
  double started_s_ = 0, last_s_ = 0;
  bool shown_ = false;
};

}  // namespace vernier
