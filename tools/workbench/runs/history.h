// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <mutex>
#include <nlohmann/json.hpp>
#include <string>

#include "tools/workbench/runs/commands.h"

namespace vernier::workbench {

/// The steps of a project, in order. The file `.vernier/history.json` contains the steps. The shell script
/// `history.sh` contains the steps that are not undone, and repeats them. Commands to a board are comments in
/// the script.
class CommandHistory {
 public:
  /// Reads the history of an earlier session. Throws InputError if the history cannot be read.
  explicit CommandHistory(const Project& project);

  /// Adds an entry. result: JSON of the command; the entry stores rms_um and check_rms_um of this JSON.
  void add(const std::string& typed, const PlannedCommand& command, const nlohmann::ordered_json& result);
  /// undo: undoes the last entry (its files stay, and the script omits the entry). redo: restores the first
  /// undone entry. Throws InputError if no such entry exists.
  void undo();
  void redo();
  /// [{"command", "name", "at", "undone", "outputs", "rms_um", "check_rms_um"}].
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
