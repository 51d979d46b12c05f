// SPDX-License-Identifier: GPL-3.0-or-later
// What all exports share: arguments, the sheet "safe to run?", the result.
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
  std::string machine, file, output, json, axis, at, reversal;
  std::vector<std::string> accept;
  int type = 1;
  double tolerance_um = 0.1;
  bool leave_out = false, component = false;
};

/// Error of the interpolation between the lines of the table of one axis.
struct AxisLines {
  std::string axis;
  std::size_t lines = 0, probed = 0;
  double worst_um = 0;
};

/// Throws LimitNotMet if the safety sheet ("safe to run?") fails, because the written files correct a machine
/// in the same way as a correction image.
/// not_of_board: the format does not use maxcorrection, which is a limit of the board.
void require_safe(const model::Machine& machine, const ExchangeArguments& arguments,
                  bool not_of_board = false);

/// Returns the fixed state: the middle of the ranges, overridden by the values of the user.
model::States state_of(const model::Machine& machine, const ExchangeArguments& arguments);

/// Prints and writes the result of an export (exported) or of an import of tables. extra: more keys.
void finish(const model::Machine& machine, const ExchangeArguments& arguments, const char* format,
            const std::vector<exchange::LeftOut>& left_out, const Json& files,
            const std::vector<AxisLines>& axes = {}, bool exported = true, const Json& extra = {});

/// Writes the files into the folder of the output and returns their paths.
Json write_folder(const ExchangeArguments& arguments, const std::vector<exchange::ConfigurationFile>& files);

/// Returns {"x": ..., "y": ..., "z": ...}.
Json three_json(const std::array<double, 3>& values);

/// Returns an entry for each of X, Y and Z along which an error remains with the files.
std::vector<exchange::LeftOut> remaining(const std::array<double, 3>& after_um);

/// Prints the rms of the tool point's error at so many positions, without and with the files.
void print_rms(const ExchangeArguments& arguments, std::size_t positions, double before_um, double after_um);

/// Adds the subcommand of a format with the options of every export.
CLI::App* add_export(CLI::App* parent, const char* kind, const char* what, const char* output,
                     const std::shared_ptr<ExchangeArguments>& arguments);

/// Adds the subcommands of the firmwares of printers and small machines.
void add_printer_exports(CLI::App* parent);

/// Adds the subcommands of the controllers of machine tools.
void add_controller_exports(CLI::App* parent);

/// Adds the subcommand `urdf`.
void add_robot_exports(CLI::App* parent);

}  // namespace vernier::commands::exchange_cli
