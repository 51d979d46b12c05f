// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <CLI/CLI.hpp>
#include <functional>
#include <string>
#include <vector>

#include "tools/model/machine.h"
#include "tools/model/measurement.h"

namespace vernier::commands {

/// Settings of a search.
struct SurveyArguments {
  std::string machine, images;
  std::vector<std::string> measurements, columns;
};

/// MACHINE, MEAS, --images and --column.
void add_survey(CLI::App& command, SurveyArguments& arguments);

/// A survey after reading: columns whose role is stated are inputs of the machine, and each file has its own
/// set-up (model::with_set_ups_of_files; machine.notes says so).
struct Survey {
  std::string text;
  model::Machine machine;
  model::Measurement rows;
};
/// prepare: changes the machine after each reading of the file; may be empty. Throws InputError.
Survey read_survey(const SurveyArguments& arguments,
                   const std::function<model::Machine(model::Machine)>& prepare = {});

}  // namespace vernier::commands
