// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/workbench/terms.h"

#include "tools/workbench/dimensions.h"

namespace vernier::workbench {
namespace {

using Json = nlohmann::ordered_json;

void add(Json& list, const std::string& name, const std::string& unit, const char* what) {
  list.push_back({{"name", name}, {"unit", unit}, {"what", what}});
}

/// The same machine with the unknown coefficient as one more static.
model::Machine with_unknown(const model::Machine& machine) {
  model::Machine wider = machine;
  if (!wider.find_static("k")) {
    model::Static unknown;
    unknown.name = "k";
    wider.statics.push_back(unknown);
  }
  return wider;
}

}  // namespace

Json expression_names(const model::Machine& machine) {
  Json list = Json::array();
  for (const model::Axis& axis : machine.axes) {
    const std::string unit = axis.rotary ? "deg" : "mm";
    add(list, axis.name, unit, "axis position");
    add(list, "v" + axis.name, unit + "/s", "speed of the axis");
    add(list, "a" + axis.name, unit + "/s^2", "acceleration of the axis");
    add(list, "dir" + axis.name, "", "sense of the last motion");
    add(list, "since" + axis.name, unit, "travel since the last reversal");
  }
  for (const model::Input& input : machine.inputs) add(list, input.name, input.unit, "input");
  for (const model::Static& one : machine.statics) add(list, one.name, one.unit, "static");
  add(list, "feed", "mm/min", "along the path");
  add(list, "curv", "1/mm", "path curvature");
  add(list, "t", "s", "time");
  add(list, "visit", "", "rows since the start of the run");
  for (const char* name : {"nx", "ny", "nz"}) add(list, name, "", "normal of the row");
  for (const char* name :
       {"sin", "cos", "tan", "atan2", "sqrt", "abs", "exp", "log", "sign", "min", "max", "lag", "run"})
    add(list, std::string(name) + "(", "", "function");
  add(list, "k", "", "the unknown coefficient");
  return list;
}

Json check_term(const model::Machine& machine, const std::string& text, const std::string& unit) {
  const model::Machine wider = with_unknown(machine);
  Json result;
  try {
    const model::ExprPtr expr = model::parse_expression_for(wider, text);
    std::vector<std::string> warnings;
    const auto found = expression_unit(wider, *expr, "k", warnings);
    const auto wanted = unit_powers(unit);
    result = {{"ok", true}, {"unit", found ? Json(unit_text(*found)) : Json(nullptr)}, {"k_unit", nullptr}};
    if (found && wanted) {
      UnitPowers rest = *wanted;
      for (std::size_t i = 0; i < rest.size(); ++i) rest[i] -= (*found)[i];
      result["k_unit"] = unit_text(rest);
    }
    bool has_unknown = false;
    model::walk(*expr, [&](const model::Expr& node) {
      has_unknown |= node.op == model::Op::kSymbol && node.name == "k";
    });
    if (!has_unknown) warnings.emplace_back("there is no unknown k in it: nothing to fit");
    result["warnings"] = warnings;
  } catch (const model::ExpressionError& error) {
    result = {{"ok", false}, {"message", error.what()}, {"offset", error.offset}, {"word", error.word}};
  }
  return result;
}

}  // namespace vernier::workbench
