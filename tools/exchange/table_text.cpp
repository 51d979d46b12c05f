// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/exchange/table_text.h"

#include <algorithm>
#include <cmath>
#include <set>

#include "tools/model/machine_reader.h"
#include "tools/model/station_table.h"
#include "tools/text/numbers.h"
#include "tools/text/xml_text.h"

namespace vernier::exchange {
namespace {

constexpr std::size_t kNowhere = std::string::npos;  // not found

/// Offset of a word in any case, from `at` on.
std::size_t find_no_case(const std::string& text, const std::string& word, std::size_t at) {
  for (; at + word.size() <= text.size(); ++at)
    if (text::equal_no_case(std::string_view(text).substr(at, word.size()), word)) return at;
  return kNowhere;
}

std::string table_element(const model::Machine& machine, const model::Table& table) {
  const model::Axis& axis = machine.axes[table.axis];
  std::string text = "<table axis=\"" + axis.name + "\" interpolation=\"" +
                     (table.interpolation == model::Interpolation::kCubic ? "cubic" : "linear") + "\"";
  std::string fit;
  for (std::size_t k = 0; k < 6; ++k)
    if (table.free[k]) fit += (fit.empty() ? "" : " ") + std::string(model::kSixDofNames[k]);
  if (!fit.empty()) text += " fit=\"" + fit + "\"";
  std::string scales;
  for (std::size_t k = 0; k < 6; ++k)
    if (table.free[k] && table.scale[k])
      scales += (scales.empty() ? "" : " ") + text::number_text(*table.scale[k]);
  if (!scales.empty()) text += " scale=\"" + scales + "\"";
  text += ">\n";
  for (const model::Station& station : table.stations) {
    text += "        <station loc=\"" + text::number_text(station.loc) + "\"";
    for (std::size_t k = 0; k < 6; ++k)
      text += std::string(" ") + model::kSixDofNames[k] + "=\"" + text::number_text(station.value[k]) + "\"";
    text += "/>\n";
  }
  return text + "      </table>";
}

/// Start of the element of the table of this axis, or kNowhere.
std::size_t table_start(const std::string& text, const std::string& axis) {
  for (std::size_t at = find_no_case(text, "<table", 0); at != kNowhere;
       at = find_no_case(text, "<table", at + 1))
    for (const text::AttributeSpan& span : text::attribute_spans(text, at + 1))
      if (text::equal_no_case(span.name, "axis") && text.substr(span.value_at, span.value_size) == axis)
        return at;
  return kNowhere;
}

std::string with_element(const std::string& text, const model::Machine& machine, const model::Table& table) {
  const std::string element = table_element(machine, table);
  const std::string& axis = machine.axes[table.axis].name;
  if (machine.table_of(table.axis) != nullptr) {
    const std::size_t start = table_start(text, axis), end = find_no_case(text, "</table>", start);
    if (start == kNowhere || end == kNowhere)
      throw text::InputError({machine.file, 0}, axis, "the machine file has no table of this axis");
    return text::apply_edits(text, {{start, end + 8 - start, element}});
  }
  const std::size_t list = find_no_case(text, "</comptables>", 0),
                    variables = find_no_case(text, "</variables>", 0);
  if (list != kNowhere) return text::apply_edits(text, {{list, 0, "  " + element + "\n    "}});
  if (variables == kNowhere)
    throw text::InputError({machine.file, 0}, "variables",
                           "the machine file has no element <comptables> or <variables>, so the table cannot "
                           "be inserted; add the element <variables>");
  return text::apply_edits(text,
                           {{variables, 0, "<comptables>\n      " + element + "\n    </comptables>\n  "}});
}

bool same(const model::Table& a, const model::Table& b) {
  if (a.stations.size() != b.stations.size() || a.interpolation != b.interpolation || a.free != b.free)
    return false;
  for (std::size_t i = 0; i < a.stations.size(); ++i)
    if (a.stations[i].loc != b.stations[i].loc || a.stations[i].value != b.stations[i].value) return false;
  return true;
}

}  // namespace

std::string set_table(const std::string& text, const model::Machine& machine, const model::Table& table) {
  const std::string result = with_element(text, machine, table);
  const model::Machine back = model::parse_machine(result, machine.file);
  const model::Table* read = back.table_of(table.axis);
  if (read == nullptr || !same(*read, table))
    throw text::InputError({machine.file, 0}, machine.axes[table.axis].name,
                           "the table cannot be written into this machine file, probably because a comment "
                           "contains a <table> element: remove this comment");
  return result;
}

void check_used(const model::Machine& machine, const model::Table& table) {
  std::set<std::size_t> used;
  for (const auto* branch : {&machine.tool, &machine.workpiece})
    for (const model::Transform& transform : *branch)
      for (std::size_t i = 0; i < transform.dof_count(); ++i)
        model::walk(*transform.dof[i], [&](const model::Expr& node) {
          if (node.op == model::Op::kSymbol && node.symbol.kind == model::SymbolKind::kTableValue)
            used.insert(node.symbol.index);
        });
  for (std::size_t k = 0; k < 6; ++k) {
    const auto zero = [&](const model::Station& station) { return station.value[k] == 0; };
    if (std::all_of(table.stations.begin(), table.stations.end(), zero)) continue;
    if (used.contains(6 * table.axis + k)) continue;
    throw text::InputError({machine.file, 0},
                           model::symbol_name(machine, {model::SymbolKind::kTableValue, 6 * table.axis + k}),
                           "no transform uses this table value, so the table would have no effect");
  }
}

model::Table empty_table(const model::Machine& machine, std::size_t axis,
                         const std::vector<double>& positions) {
  model::Table table;
  if (const model::Table* old = machine.table_of(axis)) table = *old;
  table.axis = axis;
  table.stations.clear();
  for (const double position : positions)
    table.stations.push_back({position, text::number_text(position), {}});
  return table;
}

model::Table table_at(const model::Machine& machine, std::size_t axis, const std::vector<double>& positions) {
  const model::Table* const old = machine.table_of(axis);
  if (old == nullptr)
    throw text::InputError({machine.file, machine.axes[axis].line}, machine.axes[axis].name,
                           "the machine file has no table of this axis");
  model::Table table = empty_table(machine, axis, positions);
  for (model::Station& station : table.stations) {
    const std::array<double, 6> values = model::table_values(*old, station.loc);
    std::transform(values.begin(), values.end(), station.value.begin(), nine_decimals);
  }
  return table;
}

double nine_decimals(double value) {
  const double scaled = std::round(value * 1e9);
  return scaled == 0 ? 0 : scaled / 1e9;
}

}  // namespace vernier::exchange
