// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/workbench/runs/commands.h"

#include <fmt/format.h>

#include <algorithm>

#include "tools/text/error.h"
#include "tools/text/words.h"

namespace vernier::workbench {
namespace {

enum class FieldKind : std::uint8_t { kIn, kInList, kOut, kText, kTextList, kNumber, kFlag, kRegistry };

/// A field of a request and its position in the command: after `option`, or as a separate word.
struct Field {
  const char* key;
  FieldKind kind;
  const char* option = "";
  bool required = false;
  const char* words = "";  // the only ones that are taken, a blank between two; empty: any
};

struct Allowed {
  const char* name;
  bool on_board, for_history;
  std::vector<Field> fields;
};

/// All that the page can do; the order of the fields is that of the words.
const std::vector<Allowed>& allowed() {
  using K = FieldKind;
  const Field machine{"machine", K::kIn, "", true}, rows{"measurements", K::kInList, "", true},
      output{"output", K::kOut, "-o", true}, report{"output", K::kOut, "-o"},
      url{"to", K::kText, "--to", true},
      // Corrections of a board in rows that name its image: from the project's compiled images.
      images{"images", K::kFlag, "--images=."}, header{"header", K::kTextList, "--header"};
  static const std::vector<Allowed> kAll = {
      {"new",
       false,
       true,
       {{"type", K::kText, "", true},
        {"axes", K::kTextList, "--axis"},
        {"tool_side", K::kText, "--tool-side"},
        {"work_side", K::kText, "--work-side"},
        {"name", K::kText, "--name"},
        {"reading", K::kText, "--reading"},
        output,
        {"measurements", K::kOut, "--measurements"}}},
      {"import",
       false,
       true,
       {{"kind", K::kText, "", true},
        {"files", K::kInList, "", true},
        {"repair_time_base", K::kFlag, "--repair-time-base"},
        {"map", K::kIn, "--map"},
        {"separator", K::kText, "--separator"},
        {"decimal", K::kText, "--decimal"},
        {"skip", K::kNumber, "--skip"},
        {"header", K::kFlag, "--header"},
        {"sheet", K::kText, "--sheet"},
        {"unit", K::kText, "--unit"},
        {"columns", K::kTextList, "--column"},
        {"deviations", K::kTextList, "--deviation"},
        {"leave", K::kTextList, "--leave"},
        {"set", K::kTextList, "--set"},
        {"check_every", K::kNumber, "--check-every"},
        {"radius", K::kNumber, "--radius"},
        {"plane", K::kText, "--plane"},
        {"length", K::kNumber, "--length"},
        {"feed", K::kNumber, "--feed"},
        output,
        {"save_profile", K::kOut, "--save-profile"}}},
      {"fit", false, true, {machine, rows, images, {"loss", K::kText, "--loss"}, output}},
      {"compare", false, false, {machine, rows, {"datum", K::kFlag, "--datum"}, images, header, report}},
      {"diagnose",
       false,
       false,
       {machine,
        rows,
        images,
        {"most", K::kNumber, "--most"},
        {"machine_out", K::kOut, "--machine-out"},
        header,
        report}},
      {"evaluate",
       false,
       false,
       {{"standard", K::kText, "", true},
        rows,
        {"axis", K::kText, "--axis", true},
        {"tolerances", K::kTextList, "--tolerance"},
        {"uncertainties", K::kTextList, "--uncertainty"},
        header,
        report}},
      {"add", false, true, {{"effect", K::kText, "", true}, machine, output}},
      {"set", false, true, {machine, {"values", K::kTextList, "", true}, output}},
      {"exclude",
       false,
       true,
       {{"measurement", K::kIn, "", true},
        {"lines", K::kText, "--lines", true},
        {"reason", K::kText, "--reason"},
        {"restore", K::kFlag, "--restore"},
        output}},
      {"effects", false, false, {}},
      {"plan",
       false,
       false,
       {machine,
        rows,
        {"separate", K::kTextList, "--separate", true},
        {"points", K::kNumber, "--points"},
        {"confidence", K::kNumber, "--confidence"},
        {"gcode", K::kOut, "--gcode"},
        report}},
      {"improve", false, true, {machine, rows, images, {"yes", K::kFlag, "--yes", true}, output}},
      {"compile", false, true, {machine, {"budget", K::kText, "--budget"}, output}},
      {"replay",
       false,
       false,
       {{"measurements", K::kInList, "", true}, {"image", K::kIn, "--image", true}, report}},
      {"keys", false, false, {output}},
      {"image-diff",
       false,
       false,
       {{"image", K::kIn, "", true},
        {"with", K::kIn, "--with"},
        {"to", K::kText, "--to"},
        {"key", K::kIn, "--key"}}},
      {"upload",
       true,
       true,
       {{"image", K::kIn},
        {"confirm", K::kFlag, "--confirm"},
        {"revert", K::kFlag, "--revert"},
        {"force", K::kFlag, "--force"},
        url,
        {"key", K::kIn, "--key"}}},
      {"board", true, false, {{"what", K::kText, "", true}, url, {"key", K::kIn, "--key"}}},
      {"status", true, false, {url}},
      // Only what reads: a fleet is not changed from a page.
      {"fleet",
       false,
       false,
       {{"what", K::kText, "", true, "status due alike jobs list"},
        {"registry", K::kRegistry, "--registry", true}}},
  };
  return kAll;
}

[[noreturn]] void refuse(const Field& field, const std::string& what) {
  throw text::InputError(fmt::format("\"{}\": {}", field.key, what));
}

std::string text_of(const Field& field, const nlohmann::json& value) {
  constexpr std::size_t kMost = 4000;
  if (!value.is_string()) refuse(field, "must be a text");
  const auto text = value.get<std::string>();
  if (text.empty() || text.front() == '-' || text.size() > kMost)
    refuse(field, "must not be empty, very long or start with -");
  if (std::any_of(text.begin(), text.end(), [](char c) { return static_cast<unsigned char>(c) < 0x20; }))
    refuse(field, "must be one line of text");
  return text;
}

std::string word_of(const Field& field, const nlohmann::json& value, const Project& project) {
  switch (field.kind) {
    case FieldKind::kIn:
    case FieldKind::kInList: {
      const std::string name = text_of(field, value);
      project.existing(name);
      return name;
    }
    case FieldKind::kOut: {
      const std::string name = text_of(field, value);
      project.writable(name);
      return name;
    }
    case FieldKind::kRegistry: {
      // A server, or a file of the project.
      const std::string place = text_of(field, value);
      if (!place.starts_with("postgresql://") && !place.starts_with("postgres://")) project.existing(place);
      return place;
    }
    case FieldKind::kNumber:
      if (!value.is_number()) refuse(field, "must be a number");
      return fmt::format("{}", value.get<double>());
    default: {
      std::string text = text_of(field, value);
      const std::vector<std::string> words = text::words_in(field.words, " ");
      if (!words.empty() && std::find(words.begin(), words.end(), text) == words.end())
        refuse(field, "is not one of " + std::string(field.words));
      return text;
    }
  }
}

void add_field(const Field& field, const nlohmann::json& value, const Project& project,
               PlannedCommand& command) {
  constexpr std::size_t kMostWords = 200;
  if (field.kind == FieldKind::kFlag) {
    if (!value.is_boolean()) refuse(field, "must be true or false");
    if (value.get<bool>()) command.arguments.emplace_back(field.option);
    return;
  }
  const bool list = field.kind == FieldKind::kInList || field.kind == FieldKind::kTextList;
  if (list && (!value.is_array() || value.empty() || value.size() > kMostWords))
    refuse(field, "must be a list with at least one entry");
  for (const nlohmann::json& one : list ? value : nlohmann::json::array({value})) {
    if (*field.option != '\0') command.arguments.emplace_back(field.option);
    command.arguments.push_back(word_of(field, one, project));
    if (field.kind == FieldKind::kOut) command.outputs.push_back(command.arguments.back());
  }
}

}  // namespace

PlannedCommand plan_command(const nlohmann::json& request, const Project& project) {
  if (!request.is_object() || !request.contains("command") || !request["command"].is_string())
    throw text::InputError("a request for a command names it: {\"command\": ...}");
  const auto name = request["command"].get<std::string>();
  const auto found =
      std::find_if(allowed().begin(), allowed().end(), [&](const Allowed& one) { return one.name == name; });
  if (found == allowed().end()) throw text::InputError("\"" + name + "\": the workbench has no such command");
  PlannedCommand command{name, {name}, {}, found->on_board, found->for_history};
  std::size_t known = 1;
  for (const Field& field : found->fields) {
    const auto value = request.find(field.key);
    if (value == request.end() || value->is_null()) {
      if (field.required) refuse(field, "is missing in a request for " + name);
      known += value != request.end() ? 1 : 0;
      continue;
    }
    ++known;
    add_field(field, *value, project, command);
  }
  if (known != request.size()) throw text::InputError("a field that " + name + " does not have");
  return command;
}

}  // namespace vernier::workbench
