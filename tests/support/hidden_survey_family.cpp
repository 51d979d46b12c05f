// SPDX-License-Identifier: GPL-3.0-or-later
#include "tests/support/hidden_survey_family.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>
#include <pugixml.hpp>
#include <sstream>
#include <stdexcept>

#include "tests/support/likeness_machines.h"
#include "tools/model/chain/chain.h"
#include "tools/model/chain/evaluate.h"
#include "tools/model/machine_reader.h"
#include "tools/model/parameters.h"
#include "tools/text/files.h"
#include "tools/text/numbers.h"

namespace vernier::support {

using namespace vernier::model;
using namespace vernier::text;
namespace {

struct Known {
  const char* name;
  const char* file;  // of tables/machines
  double u_mm, feed;
  std::map<std::string, std::pair<double, double>> range;  // where the file has none or a wider one
  std::vector<std::pair<std::string, std::string>> bends;
};

// A slide that runs out along x bends what carries it about y, and the other way round.
const std::vector<std::pair<std::string, std::string>> kSlides = {{"X", "rY"}, {"Y", "rX"}};

const std::vector<Known>& known() {
  static const std::vector<Known> all = {
      {"bridge", "moving_bridge.xml", 0.001, 6000, {}, kSlides},
      {"column", "column_moving_table.xml", 0.001, 6000, {}, kSlides},
      {"gantry",
       "gantry.xml",
       0.005,
       20000,
       {{"X", {0, 3000}}, {"Y", {0, 6000}}, {"Z", {-1000, 0}}},
       kSlides},
      {"horizontal-arm",
       "moving_horizontal_arm.xml",
       0.004,
       12000,
       {{"X", {0, 4000}}, {"Y", {0, 1600}}, {"Z", {-1500, 0}}},
       kSlides},
      {"five-axis", "five_axis_bhead_ctable.xml", 0.002, 6000, {{"C", {-170, 170}}}, {{"B", ""}}},
      {"fibre",
       "fibre_placement.xml",
       0.05,
       30000,
       {{"Xm", {2750, 20000}},
        {"Ym", {-2700, 3900}},
        {"Zm", {-975, 3625}},
        {"Cpm", {-90, 90}},
        {"Am", {-45, 90}},
        {"Bm", {-45, 45}},
        {"Cm", {10, 350}}},
       {{"Zm", "rX"}, {"Am", ""}}},
      {"robot",
       "ur10e.xml",
       0.02,
       30000,
       {{"J1", {-150, 150}},
        {"J2", {-140, -40}},
        {"J3", {-120, 120}},
        {"J4", {-170, 60}},
        {"J5", {-150, 150}},
        {"J6", {-170, 170}}},
       {}},
      {"ball-bar", "", 0.0005, 4000, {}, {}},
      {"single-axis", "", 0.0005, 6000, {}, {}}};
  return all;
}

const char* const kSingleAxis = R"XML(<machine name="single-axis">
  <variables>
    <static>
      <TPZ value="-150" unit="mm" Hide="true"/>
      <x0 value="0" nominal="0" unit="mm"/>
      <BaseShift X="0" Y="0" Z="0" rX="0" rY="0" rZ="0" Hide="true"/>
    </static>
    <machineaxes><X rotary="false" min="0" max="1000"/></machineaxes>
    <comptables>
      <table axis="X" fit="X"><station loc="0"/><station loc="1000"/></table>
    </comptables>
  </variables>
  <transforms branch="tool">
    <sixdof n="1" X="X+x0+lXx" Y="lXy" Z="lXz" rX="rXx" rY="rXy" rZ="rXz"/>
    <sixdof n="2" Z="TPZ"/>
  </transforms>
</machine>
)XML";

// The circle's centre is a static here, so that surveys hide what the machine does and not how it was set up.
const char* const kBallBarCircle = R"XML(<machine name="xy-circle">
  <variables>
    <static>
      <x0 value="0" nominal="0" unit="mm" note="centre of the circle in the bar's frame"/>
      <y0 value="0" nominal="0" unit="mm"/>
      <k value="0" nominal="0" note="common scale error of both axes: radius error / radius"/>
      <BaseShift X="0" Y="0" Z="0" rX="0" rY="0" rZ="0" Hide="true"/>
    </static>
    <machineaxes>
      <X rotary="false" min="-150" max="150" maxcorrection="0.5" maxslew="20"/>
      <Y rotary="false" min="-150" max="150" maxcorrection="0.5" maxslew="20"/>
    </machineaxes>
  </variables>
  <transforms branch="tool">
    <sixdof n="1" X="X*(1+k)+x0" Y="Y*(1+k)+y0"/>
  </transforms>
</machine>
)XML";

void load(pugi::xml_document& xml, const std::string& text) {
  const auto result = xml.load_buffer(text.data(), text.size(), pugi::parse_default);
  if (!result) throw std::runtime_error(std::string("machine file: ") + result.description());
}

std::string save(const pugi::xml_document& xml) {
  std::ostringstream out;
  xml.save(out, "  ", pugi::format_indent | pugi::format_no_declaration);
  return out.str();
}

pugi::xml_node variables(const pugi::xml_document& xml) { return xml.document_element().child("variables"); }

void set(pugi::xml_node node, const char* attribute, const std::string& value) {
  if (!node.attribute(attribute)) node.append_attribute(attribute);
  node.attribute(attribute).set_value(value.c_str());
}

/// The first transform whose degree of freedom moves with the axis, one to one.
void place_axis(const Machine& machine, std::size_t axis, AxisPlace& place) {
  States states = make_states(2, machine.axes.size(), std::vector<double>(machine.inputs.size(), 0.0));
  states.axis[axis] << 0, 1;
  for (const bool workpiece : {true, false}) {
    const auto& branch = workpiece ? machine.workpiece : machine.tool;
    for (std::size_t k = 0; k < branch.size(); ++k)
      for (std::size_t d = 0; d < branch[k].dof_count(); ++d) {
        const Column value = model::evaluate(machine, *branch[k].dof[d], states);
        if (std::abs(std::abs(value[1] - value[0]) - 1) > 1e-6) continue;
        place.workpiece = workpiece;
        place.order = k;
        place.n = branch[k].n;
        place.dof = branch[k].dof_name(d);
        place.sense = value[1] > value[0] ? 1 : -1;
        return;
      }
  }
  throw std::runtime_error("no transform moves with axis " + place.name);
}

void set_ranges(const Known& entry, std::string& text) {
  pugi::xml_document xml;
  load(xml, text);
  if (pugi::xml_node branch = xml.document_element().child("TransForms")) branch.set_name("transforms");
  for (pugi::xml_node axis : variables(xml).child("machineaxes").children()) {
    const auto found = entry.range.find(axis.name());
    if (found == entry.range.end()) continue;
    set(axis, "min", number_text(found->second.first));
    set(axis, "max", number_text(found->second.second));
    axis.remove_attribute("rollover");
  }
  // Bending that the published machine has as free statics is hidden, not known.
  for (const char* name : {"Zflex", "Aflex", "Bflex"})
    if (pugi::xml_node node = variables(xml).child("static").child(name)) set(node, "Hide", "true");
  text = save(xml);
}

void set_stations(pugi::xml_node table, double low, double high, std::size_t count) {
  while (table.remove_child("station")) {
  }
  for (std::size_t i = 0; i < count; ++i)
    table.append_child("station").append_attribute("loc").set_value(
        number_text(low + (high - low) * static_cast<double>(i) / static_cast<double>(count - 1)).c_str());
}

void shape_tables(pugi::xml_node tables, const Geometry& geometry, const ModelOptions& options, Draw& draw) {
  std::vector<pugi::xml_node> gone;
  for (pugi::xml_node table : tables.children("table")) {
    const std::string name = table.attribute("axis").value();
    const AxisPlace* axis = geometry.axis(name);
    if (options.kind != ModelKind::kTables || axis == nullptr) {
      gone.push_back(table);
      continue;
    }
    set_stations(table, axis->low, axis->high,
                 geometry.family == Family::kSingleAxis ? 9 + draw.index(6) : 4 + draw.index(3));
    std::string columns = table.attribute("fit").value();
    if (name == options.axis_without) {
      std::istringstream words(columns);
      columns.clear();
      for (std::string word; words >> word;)
        if (word != options.column_without) columns += (columns.empty() ? "" : " ") + word;
    }
    if (columns.empty())
      table.remove_attribute("fit");
    else
      set(table, "fit", columns);
  }
  for (const pugi::xml_node& table : gone) tables.remove_child(table);
}

void shape_shifts(pugi::xml_node statics, const ModelOptions& options) {
  const bool held = options.hold_shift || statics.child("BaseShift").attribute("Hide").as_bool();
  while (statics.remove_child("BaseShift")) {
  }
  const auto add = [&](const std::string& run) {
    pugi::xml_node shift = statics.append_child("BaseShift");
    if (!run.empty()) set(shift, "run", run);
    for (const char* name : kSixDofNames) set(shift, name, "0");
    if (held) set(shift, "Hide", "true");
  };
  if (!options.shift_per_run || held) return add("");
  for (const std::string& run : options.runs) add(run);
}

}  // namespace

const char* family_name(Family family) {
  const auto at = static_cast<std::size_t>(family);
  return at < kFamilyCount ? known()[at].name : likeness_machines().at(at - kFamilyCount).name;
}

Family family_named(const std::string& name) {
  for (std::size_t i = 0; i < kFamilyCount + kLikenessCount; ++i)
    if (name == family_name(static_cast<Family>(i))) return static_cast<Family>(i);
  throw std::invalid_argument("no machine family '" + name + "'");
}

bool Geometry::all_linear() const {
  return std::none_of(axes.begin(), axes.end(), [](const AxisPlace& a) { return a.rotary; });
}

const AxisPlace* Geometry::axis(const std::string& name) const {
  const auto found =
      std::find_if(axes.begin(), axes.end(), [&](const AxisPlace& a) { return a.name == name; });
  return found == axes.end() ? nullptr : &*found;
}

namespace {

/// What is known of a machine before its file is read.
Geometry bare_geometry(Family family, std::uint64_t seed) {
  Geometry g;
  g.family = family;
  const auto at = static_cast<std::size_t>(family);
  if (at >= kFamilyCount) {
    const LikenessMachine& entry = likeness_machines().at(at - kFamilyCount);
    Draw draw(seed);
    g.text = entry.file(draw);
    g.u_mm = entry.u_mm;
    g.feed = entry.feed;
    return g;
  }
  const Known& entry = known()[at];
  g.u_mm = entry.u_mm;
  g.feed = entry.feed;
  g.bends = entry.bends;
  g.text = family == Family::kSingleAxis ? kSingleAxis
           : family == Family::kBallBar
               ? kBallBarCircle
               : read_file(std::string(VERNIER_SOURCE_DIR "/tables/machines/") + entry.file);
  set_ranges(entry, g.text);
  return g;
}

}  // namespace

std::vector<std::string> effects_in_likeness(Family family) {
  const auto at = static_cast<std::size_t>(family);
  if (at < kFamilyCount) return {};
  return likeness_machines().at(at - kFamilyCount).effects;
}

Geometry geometry_of(Family family, std::uint64_t seed) {
  Geometry g = bare_geometry(family, seed);
  const Machine machine = nominal_machine(parse_machine(g.text, "family.xml"));
  for (std::size_t i = 0; i < machine.axes.size(); ++i) {
    const Axis& axis = machine.axes[i];
    AxisPlace place{axis.name, axis.rotary, *axis.min, *axis.max, false, 0, 0, "", 1};
    place_axis(machine, i, place);
    g.axes.push_back(place);
  }
  for (const Input& input : machine.inputs)
    if (input.hidden_axis) g.held.emplace_back(input.name, 10);
  for (const bool workpiece : {true, false}) {
    const auto& branch = workpiece ? machine.workpiece : machine.tool;
    for (std::size_t k = 0; k < branch.size(); ++k) {
      TransformPlace place{workpiece, k, branch[k].n, {}};
      for (std::size_t d = 0; d < branch[k].dof_count(); ++d) place.dofs.emplace_back(branch[k].dof_name(d));
      g.transforms.push_back(place);
    }
  }
  return g;
}

std::string model_text(const Geometry& geometry, const ModelOptions& options, Draw& draw) {
  pugi::xml_document xml;
  load(xml, geometry.text);
  pugi::xml_node statics = variables(xml).child("static");
  shape_shifts(statics, options);
  if (options.kind == ModelKind::kBare)
    for (pugi::xml_node node : statics.children())
      if (std::string(node.name()) != "BaseShift") set(node, "Hide", "true");
  if (pugi::xml_node tables = variables(xml).child("comptables")) {
    shape_tables(tables, geometry, options, draw);
    if (!tables.first_child()) variables(xml).remove_child(tables);
  }
  return save(xml);
}

Machine true_values(const std::string& text, const Geometry& geometry, double size_mm, Draw& draw) {
  Machine machine = parse_machine(text, "model.xml");
  double span = 0;
  for (const AxisPlace& axis : geometry.axes)
    if (!axis.rotary) span = std::max(span, axis.high - axis.low);
  const double angle_rad = size_mm / std::max(span, 1000.0);
  for (Table& table : machine.tables)
    for (std::size_t c = 0; c < 6; ++c) {
      if (!table.free[c]) continue;
      const double size = c < 3 ? size_mm : angle_rad * 180 / std::numbers::pi;
      double value = 0;
      for (Station& station : table.stations) station.value[c] = (value += size * draw.normal() / 2);
    }
  for (Static& item : machine.statics) {
    if (item.hidden) continue;
    const bool length = item.unit == "mm" || (item.unit.empty() && item.name.front() == 'l');
    const double size = item.unit == "rad" ? angle_rad
                        : length           ? size_mm
                                           : angle_rad * 180 / std::numbers::pi;
    item.value += (geometry.family == Family::kBallBar && item.unit.empty() ? 1e-5 : size) * draw.normal();
  }
  for (BaseShift& shift : machine.base_shifts)
    if (!shift.hidden)
      for (std::size_t c = 0; c < 6; ++c) shift.value[c] = (c < 3 ? 1000 * size_mm : 0.2) * draw.normal();
  return machine;
}

std::string with_terms(const std::string& text, const std::vector<Place>& places,
                       const std::vector<TermStatic>& statics, const std::vector<TermInput>& inputs) {
  pugi::xml_document xml;
  load(xml, text);
  for (const TermStatic& item : statics) {
    pugi::xml_node node = variables(xml).child("static").prepend_child(item.name.c_str());
    set(node, "value", number_text(item.value));
    set(node, "nominal", "0");
  }
  if (!inputs.empty()) {
    pugi::xml_node list = variables(xml).child("inputs");
    if (!list) list = variables(xml).insert_child_after("inputs", variables(xml).child("machineaxes"));
    for (const TermInput& input : inputs) {
      pugi::xml_node node = list.append_child(input.name.c_str());
      if (!input.unit.empty()) set(node, "unit", input.unit);
      set(node, "reference", number_text(input.reference));
    }
  }
  for (const Place& place : places)
    for (pugi::xml_node branch : xml.document_element().children("transforms")) {
      if ((std::string(branch.attribute("branch").value()) == "workpiece") != place.workpiece) continue;
      for (pugi::xml_node transform : branch.children())
        if (transform.attribute("n").as_int() == place.n) {
          const std::string old = transform.attribute(place.dof.c_str()).as_string("0");
          set(transform, place.dof.c_str(), (old == "0" ? "" : old + "+") + place.text);
        }
    }
  return save(xml);
}

}  // namespace vernier::support
