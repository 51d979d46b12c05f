// SPDX-License-Identifier: GPL-3.0-or-later
// Functions for all export commands: arguments, safety sheet ("safe to run?"), result.
#pragma once
#include <CLI/CLI.hpp>
#include <array>
#include <memory>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "tools/exchange/configuration_file.h"
#include "tools/exchange/left_out.h"
#include "tools/model/machine.h"
#include "tools/model/states.h"

namespace vernier::commands::exchange_cli {

using Json = nlohmann::ordered_json;

struct ExchangeArguments {
  std::string machine, file, output, json, axis, at, reversal, original, tip;
  std::vector<std::string> accept;
  int type = 1;
  double tolerance_um = 0.1;
  bool leave_out = false, component = false;
};

/// Interpolation error between the lines of the table of one axis.
struct AxisLines {
  std::string axis;
  std::size_t lines = 0, probed = 0;
  double worst_um = 0;
};

/// Throws LimitNotMet if the machine does not meet the safety sheet ("safe to run?"). The sheet applies
/// because the exported files correct a machine in the same way as a correction image. `not_of_board`: true
/// if the format does not use maxcorrection, which is a limit of the board.
void require_safe(const model::Machine& machine, const ExchangeArguments& arguments,
                  bool not_of_board = false);

/// Returns the fixed state for an export: the middle of the ranges, with the values of the user instead where
/// they are given.
model::States state_of(const model::Machine& machine, const ExchangeArguments& arguments);

/// Prints and writes the result of an export (`exported` is true) or of an import of tables. `extra`:
/// additional keys of the JSON result.
void finish(const model::Machine& machine, const ExchangeArguments& arguments, const char* format,
            const std::vector<exchange::LeftOut>& left_out, const Json& files,
            const std::vector<AxisLines>& axes = {}, bool exported = true, const Json& extra = {});

/// Writes the files into the output folder and returns their paths.
Json write_folder(const ExchangeArguments& arguments, const std::vector<exchange::ConfigurationFile>& files);

/// Returns three values as JSON: {"x": ..., "y": ..., "z": ...}.
Json three_json(const std::array<double, 3>& values);

/// Returns one entry for each of X, Y and Z in which an error remains with the exported files.
std::vector<exchange::LeftOut> remaining(const std::array<double, 3>& after_um);

/// Throws InputError if the model has no errors: its tables of zeros would replace the tables of the
/// controller.
void refuse_without_errors(const ExchangeArguments& arguments, double before_um);

/// Prints the rms error of the tool point that the model predicts over a number of positions, and the part of
/// this prediction that remains with the exported files.
void print_rms(const ExchangeArguments& arguments, std::size_t positions, double before_um, double after_um);

/// Adds the subcommand of an export format, with the options of every export. `output_type`: kWrites or
/// kWritesFolder, the kind of the option `--output`; `output`: its help text.
CLI::App* add_export(CLI::App* parent, const char* kind, const char* what, const char* output_type,
                     const char* output, const std::shared_ptr<ExchangeArguments>& arguments);

/// Adds the export subcommands for the firmware of 3D printers and small machines.
void add_printer_exports(CLI::App* parent);

/// Adds the export subcommands for the controllers of machine tools.
void add_controller_exports(CLI::App* parent);

/// Adds the export subcommand `urdf` for robots.
void add_robot_exports(CLI::App* parent);

}  // namespace vernier::commands::exchange_cli
