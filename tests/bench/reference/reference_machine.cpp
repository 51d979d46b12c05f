// SPDX-License-Identifier: GPL-3.0-or-later
#include "tests/bench/reference/reference_machine.h"
#include "tools/model/machine_reader.h"

#include <map>
#include <random>

namespace vernier::bench {

using namespace vernier::compile;
using namespace vernier::model;
using namespace vernier::text;
namespace {

constexpr unsigned kSeed = 20261121;

struct Source {
  const char* file;
  bool seeded;           // errors are set here; else the file has its own
  bool tables;           // those of tables too
  std::size_t stations;  // 0: as in the file
};

const std::map<std::string, Source> kSources = {
    {"three_axis", {"tables/machines/moving_bridge.xml", true, true, 64}},
    {"five_axis", {"tables/machines/five_axis_bhead_ctable.xml", true, true, 0}},
    {"seven_axis_chain", {"tables/machines/fibre_placement.xml", true, false, 0}},
    {"seven_axis", {"tables/machines/fibre_placement.xml", true, true, 0}},
    {"six_r", {"tables/machines/ur10e.xml", true, true, 0}},
    {"three_axis_effects", {"tests/unit/compile/machines/bridge.xml", false, false, 0}},
    {"five_axis_effects", {"tests/unit/compile/machines/five_axis.xml", false, false, 0}},
};

double uniform(std::mt19937_64& random, double size) {
  return (static_cast<double>(random() >> 11) * 0x1p-52 - 1) * size;
}

void seed_statics(Machine& machine, std::mt19937_64& random) {
  for (Static& s : machine.statics) {
    if (s.hidden) continue;
    if (!s.nominal) s.nominal = s.value;
    s.value = *s.nominal + uniform(random, s.unit == "rad" ? 1e-4 : 0.005);  // mm, deg
  }
}

void seed_table(Table& table, std::size_t stations, std::mt19937_64& random) {
  const double first = table.stations.front().loc, last = table.stations.back().loc;
  if (stations > 0) table.stations.resize(stations);
  for (std::size_t i = 0; i < table.stations.size(); ++i) {
    Station& s = table.stations[i];
    if (stations > 0)
      s.loc = first + (last - first) * static_cast<double>(i) / static_cast<double>(stations - 1);
    s.loc_text = std::to_string(s.loc);
    for (std::size_t c = 0; c < 6; ++c)
      s.value[c] = (i == 0 ? 0 : table.stations[i - 1].value[c]) + uniform(random, c < 3 ? 0.004 : 0.0008);
  }
  if (table.periodic) table.stations.back().value = table.stations.front().value;
}

// Ranges that the file leaves open: those of the tables; the selected tool point for an axis that is an
// input.
void declare_ranges(Machine& machine) {
  for (std::size_t i = 0; i < machine.axes.size(); ++i) {
    const Table* const table = machine.table_of(i);
    Axis& axis = machine.axes[i];
    if (!axis.min && table != nullptr) axis.min = table->stations.front().loc;
    if (!axis.max && table != nullptr) axis.max = table->stations.back().loc;
  }
  for (Input& input : machine.inputs)
    if (input.hidden_axis && !input.min) input.min = 1, input.max = 10;
}

// The chain alone: no tables, one tool point in place of the choice among ten.
void fix_tool(Machine& machine) {
  for (const char* const letter : {"X", "Y", "Z"}) {
    const std::size_t dof = static_cast<std::size_t>(letter[0] - 'X');
    machine.tool.back().text[dof] = std::string("TP2") + letter;
    machine.tool.back().dof[dof] = parse_expression_for(machine, machine.tool.back().text[dof]);
  }
}

}  // namespace

Machine reference_machine(const std::string& name) {
  const auto source = kSources.find(name);
  if (source == kSources.end()) throw InputError("no reference machine \"" + name + "\"");
  Machine machine = read_machine(std::string(VERNIER_SOURCE_DIR) + "/" + source->second.file);
  std::mt19937_64 random(kSeed);
  declare_ranges(machine);
  if (!source->second.seeded) return machine;
  seed_statics(machine, random);
  if (name == "seven_axis_chain") fix_tool(machine);
  if (source->second.tables)
    for (Table& table : machine.tables) seed_table(table, source->second.stations, random);
  return machine;
}

ReferenceMachine::ReferenceMachine(const std::string& name)
    : machine(reference_machine(name)), compiled(compile_machine(machine, name, {})) {}

}  // namespace vernier::bench
