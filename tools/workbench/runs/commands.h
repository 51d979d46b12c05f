// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "tools/workbench/files/project.h"

namespace vernier::workbench {

/// A command that the page requested, ready to run in the project's folder.
struct PlannedCommand {
  std::string name;                    // "fit", "import table"
  std::vector<std::string> arguments;  // as typed in the project's folder, without --json
  std::vector<std::string> outputs;    // files and folders that it writes
  bool on_board = false;               // communicates with a board: never replayed
  bool for_history = false;            // changes the project
};

/// The commands and options of the program that the page may use.
class CommandTable {
 public:
  /// described: every command of the program with its options, as `vernier completion json` prints them.
  /// Throws std::logic_error if an allowed command or option (commands.cpp) is not in it.
  explicit CommandTable(const nlohmann::ordered_json& described);

  /// Converts a request of the page, {"command": "fit", "machine": "a.xml", ...}, into the command of the
  /// terminal; the keys are the names of options. Only allowed commands and options are accepted. Files are
  /// checked against the project. Texts may not look like options. Throws InputError naming option and word.
  PlannedCommand plan(const nlohmann::json& request, const Project& project) const;

  /// Returns the allowed commands and options for the page; "required" is as for `plan`.
  const nlohmann::ordered_json& allowed() const { return allowed_; }

 private:
  nlohmann::ordered_json allowed_ = nlohmann::ordered_json::array();
};

}  // namespace vernier::workbench
