// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/kinematics/at.h"

#include <algorithm>
#include <optional>
#include <set>

#include "tools/format/columns.h"
#include "tools/model/chain/chain_rows.h"
#include "tools/text/numbers.h"
#include "tools/text/words.h"

namespace vernier::kinematics {
namespace {

/// Returns the column of a state for a name, or nullptr.
/// Names that a state can have. An error of temperature needs an input in the machine file.
std::string names_of(const model::Machine& machine) {
  std::string text = machine.axes.empty() ? "no axes" : "the axes";
  for (const model::Axis& axis : machine.axes)
    text += (&axis == &machine.axes.front() ? " " : ", ") + axis.name;
  text += machine.inputs.empty() ? " and no inputs, so that none of its errors depends on another quantity"
                                 : " and the inputs";
  for (const model::Input& input : machine.inputs)
    text += (&input == &machine.inputs.front() ? " " : ", ") + input.name;
  return text;
}

model::Column* column_of(const model::Machine& machine, model::States& states, const std::string& name) {
  const model::Symbol symbol = model::resolve_name(machine, name);
  switch (symbol.kind) {
    case model::SymbolKind::kAxis:
      return &states.axis[symbol.index];
    case model::SymbolKind::kInput:
      return &states.input[symbol.index];
    case model::SymbolKind::kVelocity:
      return &states.velocity[symbol.index];
    case model::SymbolKind::kAcceleration:
      return &states.acceleration[symbol.index];
    case model::SymbolKind::kDirection:
      return &states.direction[symbol.index];
    case model::SymbolKind::kSince:
      return &states.since[symbol.index];
    case model::SymbolKind::kFeed:
      return &states.feed;
    case model::SymbolKind::kCurvature:
      return &states.curvature;
    case model::SymbolKind::kNormal:
      return &states.normal[symbol.index];
    case model::SymbolKind::kTime:
      return &states.time;
    case model::SymbolKind::kVisit:
      return &states.visit;
    default:
      return nullptr;
  }
}

void set_word(const model::Machine& machine, model::States& states, std::set<std::string>& seen,
              const std::string& word) {
  const auto equals = word.find('=');
  const std::string name = text::trimmed(word.substr(0, equals));
  const std::string value = equals == std::string::npos ? "" : text::trimmed(word.substr(equals + 1));
  if (name.empty() || value.empty())
    throw text::InputError({}, word, "a state has the form NAME=NUMBER,NAME=NUMBER…");
  if (!seen.insert(name).second) throw text::InputError({}, name, "this name occurs twice in one state");
  if (name == format::columns::kRun) {
    states.run_names = {value};
    return;
  }
  model::Column* column = column_of(machine, states, name);
  if (column == nullptr)
    throw text::InputError(
        {machine.file, 0}, name,
        "this machine has no axis, input or motion quantity of this name; it has " + names_of(machine));
  const auto number = text::parse_number(value);
  if (!number) throw text::InputError({}, value, "not a number, for " + name);
  (*column)[0] = *number;
}

}  // namespace

model::States state_at(const model::Machine& machine, const std::string& words) {
  model::States states = model::make_states(1, machine);
  if (text::trimmed(words).empty()) return states;
  std::set<std::string> seen;
  for (const std::string& word : text::parts_of(words, ',')) set_word(machine, states, seen, word);
  return states;
}

model::Machine tooled(const model::Machine& machine, const std::string& tool) {
  if (tool.empty()) return machine;
  for (const model::Tool& one : machine.tools)
    if (one.name == tool) return model::with_tool(machine, one.point);
  const std::vector<double> point = number_list(tool, {3}, "--tool");
  return model::with_tool(machine, {point[0], point[1], point[2]});
}

std::vector<double> number_list(const std::string& text, const std::vector<std::size_t>& counts,
                                const std::string& what) {
  // A list in a field of the workbench has "; " between two values.
  std::string list = text;
  std::replace(list.begin(), list.end(), ';', ',');
  std::vector<double> result;
  for (const std::string& word : text::parts_of(list, ',')) {
    const auto number = text::parse_number(word);
    if (!number) throw text::InputError({}, word, "not a number, in " + what);
    result.push_back(*number);
  }
  if (std::find(counts.begin(), counts.end(), result.size()) == counts.end())
    throw text::InputError({}, text, std::to_string(result.size()) + " numbers do not make " + what);
  return result;
}

Eigen::Isometry3d placement(const std::string& text, const std::string& what) {
  Eigen::Isometry3d place = Eigen::Isometry3d::Identity();
  if (text.empty()) return place;
  std::vector<double> dof = number_list(text, {3, 4, 6}, what);
  if (dof.size() == 4) dof.insert(dof.begin() + 3, 2, 0.0);  // the turn is rZ
  dof.resize(6, 0);
  const model::Frame frame = model::sixdof_frame({dof[0], dof[1], dof[2], dof[3], dof[4], dof[5]});
  place.linear() = frame.rotation;
  place.translation() = frame.origin;
  return place;
}

}  // namespace vernier::kinematics
