// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <mutex>
#include <nlohmann/json.hpp>
#include <string>

#include "tools/workbench/runs/commands.h"

namespace vernier::workbench {

/// History of a project: the commands that were executed, in their order. The history is stored in the file
/// `.vernier/history.json`. The shell script `history.sh` repeats the commands that were not undone. In this
/// script, commands to a board are comments.
class CommandHistory {
 public:
  /// Reads the history that an earlier session stored. Throws InputError if the file of the history cannot be
  /// read.
  explicit CommandHistory(const Project& project);

  /// Adds a command to the history. `result`: JSON result of the command. The history stores its values
  /// rms_um and check_rms_um.
  void add(const std::string& typed, const PlannedCommand& command, const nlohmann::ordered_json& result);
  /// undo() marks the last command as undone. The files of the command stay, and the script omits the
  /// command. redo() restores the first undone command. Throws InputError if there is no command to undo or
  /// to redo.
  void undo();
  void redo();
  /// Returns the history as JSON: [{"command", "name", "at", "undone", "outputs", "rms_um", "check_rms_um"}].
  nlohmann::ordered_json entries() const;
  std::string script() const;

 private:
  void save() const;
  std::string script_unguarded() const;

  const Project& project_;
  mutable std::mutex guard_;
  nlohmann::ordered_json entries_ = nlohmann::ordered_json::array();
};

}  // namespace vernier::workbench
