// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/workbench/runs/commands.h"

#include <fmt/format.h>

#include <algorithm>
#include <stdexcept>

#include "tools/text/error.h"
#include "tools/text/words.h"

namespace vernier::workbench {
namespace {

using Json = nlohmann::ordered_json;

struct Allowed {
  const char* name;
  bool on_board, for_history;
  const char* options;
};

/// All that the page can do: options by their names, in the order of the command that is shown. !: the page
/// must give it though the command does not, because without it the command would ask, use a file outside of
/// the project, or keep no result.
constexpr Allowed kAllowed[] = {
    {"new", false, true,
     "type axis stations tool-side work-side centre tool name urdf tip reading errors artefact reflector "
     "output measurements"},
    {"import table", false, true,
     "file separator decimal skip table sheet unit sign column deviation leave set fill one-motion "
     "directions point nominal nominal-column tolerance "
     "check-every machine output! save-profile"},
    {"import ballbar", false, true, "files repair-time-base output"},
    {"import ballbar-trace", false, true, "files radius plane length feed output"},
    {"import tracker", false, true,
     "file map separator decimal skip comment header column set directions check-every machine nominal "
     "nominal-column tolerance output"},
    {"import probe", false, true,
     "file map separator decimal skip comment header column set directions check-every radius output"},
    {"import laser", false, true, "file output"},
    {"import printer", false, true, "file profile on offset twist series u output"},
    {"fit", false, true, "machine meas images loss free hold output!"},
    {"compare", false, false, "machine meas! datum images header language output"},
    {"diagnose", false, false, "machine meas images most machine-out header language output"},
    {"evaluate iso230-2", false, false, "meas axis tolerance uncertainty header language output"},
    {"map", false, false, "machine grid correction inputs over lines header language output!"},
    {"add", false, true, "effect machine output"},
    {"set", false, true, "machine values artefact stations reflector measured-travel output"},
    {"exclude", false, true, "meas lines! reason restore output!"},
    {"effects", false, false, ""},
    {"plan", false, false, "machine meas! separate! points confidence gcode output"},
    {"improve", false, true, "machine meas images yes! output"},
    {"compile", false, true, "machine budget accept output"},
    {"export siemens", false, true, "machine leave-out at accept step tolerance reference numbers output"},
    {"export heidenhain", false, true, "machine leave-out at accept step tolerance reference output"},
    {"export fanuc", false, true, "machine leave-out at accept step tolerance reference numbers unit output"},
    {"export linuxcnc", false, true, "machine leave-out at accept component tolerance type output"},
    {"export klipper", false, true,
     "machine leave-out at accept steps tolerance profile bed touches zero output"},
    {"export rrf", false, true, "machine leave-out at accept steps tolerance bed touches zero output"},
    {"export marlin", false, true, "machine leave-out at accept steps tolerance bed touches zero output"},
    {"export grbl", false, true, "machine leave-out at accept steps tolerance output"},
    {"export urdf", false, true, "machine original tip leave-out at accept output"},
    {"export axis-csv", false, true, "machine leave-out at accept output"},
    {"export isg-csv", false, true, "machine leave-out at accept output"},
    {"correct", false, true, "machine path at zero place tool deviation back chords rotary output"},
    {"replay", false, false, "meas image output"},
    {"keys", false, false, "output!"},
    {"image-diff", false, false, "dir with to key"},
    {"upload", true, true, "dir confirm revert force to key"},
    {"board", true, false, "what to key"},
    {"status", true, false, "to"},
    // Only what reads: a fleet is not changed from a page.
    {"fleet list", false, false, "registry!"},
    {"fleet status", false, false, "registry!"},
    {"fleet due", false, false, "registry!"},
    {"fleet alike", false, false, "registry!"},
    {"fleet answers", false, false, "registry!"},
};

/// The entry of a list with this "name"; throws std::logic_error without one.
const Json& named(const Json& list, const std::string& name, const std::string& where) {
  const auto found =
      std::find_if(list.begin(), list.end(), [&](const Json& one) { return one.at("name") == name; });
  if (found == list.end()) throw std::logic_error("the workbench allows \"" + name + "\": not in " + where);
  return *found;
}

[[noreturn]] void refuse(const Json& option, const std::string& what) {
  throw text::InputError(fmt::format("\"{}\": {}", option.at("name").get<std::string>(), what));
}

std::string text_of(const Json& option, const nlohmann::json& value) {
  constexpr std::size_t kMost = 4000;
  if (!value.is_string()) refuse(option, "must be a text");
  const auto text = value.get<std::string>();
  if (text.empty()) refuse(option, "is empty: give a value");
  if (text.front() == '-') refuse(option, "must not begin with -");
  if (text.size() > kMost) refuse(option, fmt::format("must have at most {} bytes", kMost));
  if (std::any_of(text.begin(), text.end(), [](char c) { return static_cast<unsigned char>(c) < 0x20; }))
    refuse(option, "must be one line of text");
  return text;
}

/// A file or folder is one of the project; only a registry may be a server.
void confine(const std::string& kind, const std::string& name, const Project& project) {
  if (kind.starts_with("writes"))
    project.writable(name);
  else if (kind == "reads-folder" && name == ".")
    return;  // the project itself
  else if (kind != "reads-or-server" ||
           (!name.starts_with("postgresql://") && !name.starts_with("postgres://")))
    project.existing(name);
}

std::string word_of(const Json& option, const nlohmann::json& value, const Project& project) {
  const auto kind = option.at("kind").get<std::string>();
  if (kind == "number" || kind == "count") {
    if (!value.is_number()) refuse(option, "must be a number");
    return fmt::format("{}", value.get<double>());
  }
  std::string text = text_of(option, value);
  if (kind != "text") confine(kind, text, project);
  if (const auto words = option.find("words"); words != option.end())
    if (std::find(words->begin(), words->end(), text) == words->end())
      refuse(option, "is not one of " + words->dump());
  return text;
}

void add_option(const Json& option, const nlohmann::json& value, const Project& project,
                PlannedCommand& command) {
  constexpr std::size_t kMostWords = 200;
  const auto typed = option.at("typed").get<std::string>(), kind = option.at("kind").get<std::string>();
  if (kind == "flag") {
    if (!value.is_boolean()) refuse(option, "must be true or false");
    if (value.get<bool>()) command.arguments.push_back(typed);
    return;
  }
  const bool list = option.at("list").get<bool>();
  if (list && (!value.is_array() || value.empty() || value.size() > kMostWords))
    refuse(option, "must be a list with at least one entry");
  for (const nlohmann::json& one : list ? value : nlohmann::json::array({value})) {
    if (!typed.empty()) command.arguments.push_back(typed);
    command.arguments.push_back(word_of(option, one, project));
    if (kind.starts_with("writes")) command.outputs.push_back(command.arguments.back());
  }
}

}  // namespace

CommandTable::CommandTable(const nlohmann::ordered_json& described) {
  for (const Allowed& one : kAllowed) {
    Json command = named(described, one.name, "the program");
    Json options = Json::array();
    for (std::string name : text::words_in(one.options, " ")) {
      const bool demanded = name.ends_with('!');
      if (demanded) name.pop_back();
      options.push_back(named(command.at("options"), name, one.name));
      if (demanded) options.back()["required"] = true;
    }
    command["options"] = std::move(options);
    allowed_.push_back(std::move(command));
  }
}

PlannedCommand CommandTable::plan(const nlohmann::json& request, const Project& project) const {
  if (!request.is_object() || !request.contains("command") || !request["command"].is_string())
    throw text::InputError("a request for a command names it: {\"command\": ...}");
  const auto name = request["command"].get<std::string>();
  const auto found = std::find_if(std::begin(kAllowed), std::end(kAllowed),
                                  [&](const Allowed& one) { return one.name == name; });
  if (found == std::end(kAllowed))
    throw text::InputError(fmt::format("\"{}\": the workbench has no command of this name", name));
  PlannedCommand command{name, text::words_in(name, " "), {}, found->on_board, found->for_history};
  std::size_t known = 1;
  for (const Json& option : named(allowed_, name, "the table").at("options")) {
    const auto value = request.find(option.at("name").get<std::string>());
    known += value != request.end() ? 1 : 0;
    if (value != request.end() && !value->is_null())
      add_option(option, *value, project, command);
    else if (option.at("required").get<bool>())
      refuse(option, fmt::format("the option is missing in a request for the command {}", name));
  }
  if (known != request.size())
    throw text::InputError(fmt::format("the page must not give this option to {}", name));
  return command;
}

}  // namespace vernier::workbench
