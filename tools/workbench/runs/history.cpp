// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/workbench/runs/history.h"

#include <fmt/format.h>

#include <chrono>

#include "tools/text/error.h"
#include "tools/text/files.h"
#include "tools/text/words.h"
#include "tools/workbench/runs/now.h"

namespace vernier::workbench {
namespace {

namespace fs = std::filesystem;
constexpr const char* kScript = "history.sh";

fs::path folder(const Project& project) {
  const fs::path path = project.root() / ".vernier";
  refuse_special(path, ".vernier");
  return path;
}

fs::path list_of_entries(const Project& project) {
  const fs::path path = folder(project) / "history.json";
  refuse_special(path, ".vernier/history.json");
  return path;
}

nlohmann::ordered_json number_of(const nlohmann::ordered_json& result, const char* key) {
  if (!result.is_object() || !result.contains(key) || !result[key].is_number()) return nullptr;
  return result[key];
}

bool is_entry(const nlohmann::ordered_json& entry) {
  return entry.is_object() && entry.contains("command") && entry["command"].is_string() &&
         entry.contains("undone") && entry["undone"].is_boolean() && entry.contains("on_board") &&
         entry["on_board"].is_boolean();
}

}  // namespace

CommandHistory::CommandHistory(const Project& project) : project_(project) {
  const fs::path path = list_of_entries(project);
  if (std::error_code failed; !fs::exists(path, failed)) return;
  const std::string text = text::read_file(path.string());
  if (text::nests_deeper_than(text, text::kMostJsonDepth))
    throw text::InputError(fmt::format("{}: the JSON of this file nests too deeply", path.string()));
  const auto read = nlohmann::ordered_json::parse(text, nullptr, false);
  if (!read.is_array())
    throw text::InputError(fmt::format("{}: the file does not contain a list of commands", path.string()));
  for (const auto& entry : read)
    if (!is_entry(entry))
      throw text::InputError(
          fmt::format("{}: the list of commands contains a value that is not a command", path.string()));
  entries_ = read;
}

void CommandHistory::save() const {
  text::make_folder(folder(project_).string());
  text::write_file(list_of_entries(project_).string(), entries_.dump(1) + "\n");
  project_.save(kScript, script_unguarded());
}

void CommandHistory::add(const std::string& typed, const PlannedCommand& command,
                         const nlohmann::ordered_json& result) {
  const std::scoped_lock lock(guard_);
  // A new step replaces the undone steps.
  while (!entries_.empty() && entries_.back()["undone"].get<bool>()) entries_.erase(entries_.size() - 1);
  entries_.push_back({{"command", typed},
                      {"name", command.name},
                      {"at", unix_s()},
                      {"undone", false},
                      {"on_board", command.on_board},
                      {"outputs", command.outputs},
                      {"rms_um", number_of(result, "rms_um")},
                      {"check_rms_um", number_of(result, "check_rms_um")}});
  save();
}

void CommandHistory::undo() {
  const std::scoped_lock lock(guard_);
  for (auto entry = entries_.rbegin(); entry != entries_.rend(); ++entry) {
    if ((*entry)["undone"].get<bool>()) continue;
    (*entry)["undone"] = true;
    save();
    return;
  }
  throw text::InputError("there is no command to undo");
}

void CommandHistory::redo() {
  const std::scoped_lock lock(guard_);
  for (auto& entry : entries_) {
    if (!entry["undone"].get<bool>()) continue;
    entry["undone"] = false;
    save();
    return;
  }
  throw text::InputError("there is no undone command to do again");
}

nlohmann::ordered_json CommandHistory::entries() const {
  const std::scoped_lock lock(guard_);
  return entries_;
}

std::string CommandHistory::script() const {
  const std::scoped_lock lock(guard_);
  return script_unguarded();
}

std::string CommandHistory::script_unguarded() const {
  std::string text = "#!/bin/sh\n# What was done in this folder; run it there to do it again.\nset -e\n";
  for (const auto& entry : entries_) {
    if (entry["undone"].get<bool>()) continue;
    text += (entry["on_board"].get<bool>() ? "# " : "") + entry["command"].get<std::string>() + "\n";
  }
  return text;
}

}  // namespace vernier::workbench
