// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/kinematics/at.h"

#include <algorithm>
#include <optional>
#include <set>

#include "tools/text/numbers.h"
#include "tools/text/words.h"

namespace vernier {
namespace {

/// The column of a state that a name means, or nullptr.
Column* column_of(const Machine& machine, States& states, const std::string& name) {
  const Symbol symbol = resolve_name(machine, name);
  switch (symbol.kind) {
    case SymbolKind::kAxis:
      return &states.axis[symbol.index];
    case SymbolKind::kInput:
      return &states.input[symbol.index];
    case SymbolKind::kVelocity:
      return &states.velocity[symbol.index];
    case SymbolKind::kAcceleration:
      return &states.acceleration[symbol.index];
    case SymbolKind::kDirection:
      return &states.direction[symbol.index];
    case SymbolKind::kSince:
      return &states.since[symbol.index];
    case SymbolKind::kFeed:
      return &states.feed;
    case SymbolKind::kCurvature:
      return &states.curvature;
    case SymbolKind::kNormal:
      return &states.normal[symbol.index];
    case SymbolKind::kTime:
      return &states.time;
    case SymbolKind::kVisit:
      return &states.visit;
    default:
      return nullptr;
  }
}

void set_word(const Machine& machine, States& states, std::set<std::string>& seen, const std::string& word) {
  const auto equals = word.find('=');
  const std::string name = trimmed(word.substr(0, equals));
  const std::string value = equals == std::string::npos ? "" : trimmed(word.substr(equals + 1));
  if (name.empty() || value.empty()) throw InputError({}, word, "a state is NAME=NUMBER,NAME=NUMBER…");
  if (!seen.insert(name).second) throw InputError({}, name, "stands twice in one state");
  if (name == "run") {
    states.run_names = {value};
    return;
  }
  Column* column = column_of(machine, states, name);
  if (column == nullptr)
    throw InputError({machine.file, 0}, name,
                     "this machine has no axis, input or motion quantity of that name");
  const auto number = parse_number(value);
  if (!number) throw InputError({}, value, "not a number, for " + name);
  (*column)[0] = *number;
}

}  // namespace

States state_at(const Machine& machine, const std::string& words) {
  std::vector<double> references;
  for (const Input& input : machine.inputs) references.push_back(input.reference);
  States states = make_states(1, machine.axes.size(), references);
  if (trimmed(words).empty()) return states;
  std::set<std::string> seen;
  for (const std::string& word : parts_of(words, ',')) set_word(machine, states, seen, word);
  return states;
}

Machine tooled(const Machine& machine, const std::string& tool) {
  if (tool.empty()) return machine;
  for (const Tool& one : machine.tools)
    if (one.name == tool) return with_tool(machine, one.point);
  const std::vector<double> point = number_list(tool, {3}, "--tool");
  return with_tool(machine, {point[0], point[1], point[2]});
}

std::vector<double> number_list(const std::string& text, const std::vector<std::size_t>& counts,
                                const std::string& what) {
  std::vector<double> result;
  for (const std::string& word : parts_of(text, ',')) {
    const auto number = parse_number(word);
    if (!number) throw InputError({}, word, "not a number, in " + what);
    result.push_back(*number);
  }
  if (std::find(counts.begin(), counts.end(), result.size()) == counts.end())
    throw InputError({}, text, std::to_string(result.size()) + " numbers do not make " + what);
  return result;
}

}  // namespace vernier
