// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "tools/workbench/files/project.h"

namespace vernier::workbench {

/// A command that the page requested, ready to run in the folder of the project.
struct PlannedCommand {
  std::string name;                    // name of the command: "fit", "import table"
  std::vector<std::string> arguments;  // arguments as a user types them in the project folder, without --json
  std::vector<std::string> outputs;    // files and folders that the command writes
  bool on_board = false;               // true: the command communicates with a board and is never repeated
  bool for_history = false;            // true: the command changes the project
};

/// The commands and options of the program that the page is permitted to use.
class CommandTable {
 public:
  /// `described`: every command of the program with its options, in the form of `vernier completion json`.
  /// Throws std::logic_error if `described` does not contain a permitted command or option (commands.cpp).
  explicit CommandTable(const nlohmann::ordered_json& described);

  /// Converts a request of the page, {"command": "fit", "machine": "a.xml", ...}, to a command line. The keys
  /// of the request are the names of options. Only permitted commands and options are accepted. Names of
  /// files must be permitted names in the project. A text argument must not look like an option. Throws
  /// InputError with the option and the wrong word if the request is not valid.
  PlannedCommand plan(const nlohmann::json& request, const Project& project) const;

  /// Returns the permitted commands and options for the page. The entry "required" has the same meaning as
  /// for `plan`.
  const nlohmann::ordered_json& allowed() const { return allowed_; }

 private:
  nlohmann::ordered_json allowed_ = nlohmann::ordered_json::array();
};

}  // namespace vernier::workbench
