// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <mutex>
#include <nlohmann/json.hpp>
#include <string>

#include "tools/workbench/commands.h"

namespace vernier::workbench {

/// What was done in a project, in order: kept in `.vernier/history.json` and, without what was undone, as the
/// shell script `history.sh` that does it again. Commands to a board stand in the script as comments. tool.
class CommandHistory {
 public:
  /// Reads what an earlier session left. Throws InputError where that cannot be read.
  explicit CommandHistory(const Project& project);

  /// result: of the command; its rms_um and check_rms_um are kept.
  void add(const std::string& typed, const PlannedCommand& command, const nlohmann::ordered_json& result);
  /// The last entry that stands is undone (its files stay, the script leaves it out), or the first undone one
  /// after it stands again. Throws InputError where there is none.
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
