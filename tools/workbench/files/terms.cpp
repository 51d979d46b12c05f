// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/workbench/files/terms.h"

#include "tools/format/columns.h"
#include "tools/workbench/files/dimensions.h"

namespace vernier::workbench {
namespace {

using Json = nlohmann::ordered_json;

void add(Json& list, const std::string& name, const std::string& unit, const char* what) {
  list.push_back({{"name", name}, {"unit", unit}, {"what", what}});
}

/// Returns the same machine with the unknown coefficient as an additional static.
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
    using format::AxisQuantity;
    const auto quantity = [&](AxisQuantity one, const char* words) {
      add(list, format::axis_column(one, axis.name), format::unit_of(one, axis.rotary), words);
    };
    quantity(AxisQuantity::kPosition, "axis position");
    quantity(AxisQuantity::kSpeed, "speed of the axis");
    quantity(AxisQuantity::kAcceleration, "acceleration of the axis");
    quantity(AxisQuantity::kSense, "direction of the last motion");
    quantity(AxisQuantity::kSince, "travel since the last reversal");
  }
  for (const model::Input& input : machine.inputs) add(list, input.name, input.unit, "input");
  for (const model::Static& one : machine.statics) add(list, one.name, one.unit, "static");
  namespace columns = format::columns;
  const auto column = [&](const char* name, const char* words) {
    add(list, name, format::column_unit(name), words);
  };
  column(columns::kFeed, "along the path");
  column(columns::kCurvature, "path curvature");
  column(columns::kTime, "time");
  column(columns::kVisit, "rows since the start of the run");
  for (const char* name : columns::kNormal) column(name, "normal of the row");
  for (const std::string& name : model::function_names()) add(list, name + "(", "", "function");
  add(list, std::string(columns::kRun) + "(", "", "function");
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
    if (!has_unknown) warnings.emplace_back("the term has no unknown k; a fit needs it");
    result["warnings"] = warnings;
  } catch (const model::ExpressionError& error) {
    result = {{"ok", false}, {"message", error.what()}, {"offset", error.offset}, {"word", error.word}};
  }
  return result;
}

}  // namespace vernier::workbench
