// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "tools/workbench/files/project.h"

namespace vernier::workbench {

/// A command that the page requested, ready to run in the project's folder.
struct PlannedCommand {
  std::string name;                    // "fit"
  std::vector<std::string> arguments;  // as typed in the project's folder, without --json
  std::vector<std::string> outputs;    // files and folders that it writes
  bool on_board = false;               // communicates with a board: never replayed
  bool for_history = false;            // changes the project
};

/// Converts a request of the page, {"command": "fit", "machine": "a.xml", ...}, into the command
/// of the terminal. Only the commands and fields of the table in commands.cpp are accepted. Files
/// are checked against the project. Texts may not look like options. Throws InputError naming
/// field and word. tool.
PlannedCommand plan_command(const nlohmann::json& request, const Project& project);

}  // namespace vernier::workbench
