// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/fit/coverage/domain.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <pugixml.hpp>

#include "tools/model/chain/chain.h"
#include "tools/model/chain/evaluate.h"
#include "tools/text/numbers.h"
#include "tools/text/xml_text.h"

namespace vernier::fit {
namespace {

constexpr double kOpen = 1e9;       // value that means "no bound"
constexpr double kFadeShare = 0.1;  // of a measured range; a term fades over it outside the range

model::Column values_of(const model::Machine& machine, const DomainRange& range,
                        const model::States& states) {
  return model::evaluate(machine, *model::parse_expression_for(machine, range.quantity), states);
}

/// New numbers for attributes of the elements in a text's `section` ("static", "inputs"), by element name.
struct Setting {
  std::string section, element, attribute;
  double value;
};

void edit(const pugi::xml_node& parent, const std::string& text, const std::vector<Setting>& settings,
          std::vector<text::TextEdit>& edits) {
  for (const pugi::xml_node node : parent.children())
    for (const pugi::xml_node item : node.children())
      for (const Setting& one : settings) {
        if (!text::equal_no_case(node.name(), one.section) || one.element != item.name()) continue;
        const auto at = static_cast<std::size_t>(item.offset_debug());
        bool there = false;
        for (const text::AttributeSpan& span : text::attribute_spans(text, at)) {
          if (!text::equal_no_case(span.name, one.attribute)) continue;
          edits.push_back({span.value_at, span.value_size, text::number_text(one.value)});
          there = true;
        }
        if (!there)
          edits.push_back({text::end_of_attributes(text, at), 0,
                           fmt::format(" {}=\"{}\"", one.attribute, text::number_text(one.value))});
      }
  for (const pugi::xml_node node : parent.children()) edit(node, text, settings, edits);
}

/// Closes the statics of a range, and the range of an input that has none.
void close(const model::Machine& machine, const DomainRange& range, double low, double high,
           std::vector<Setting>& settings) {
  double width = high > low ? high - low : std::fabs(high);
  if (width == 0) width = 1;
  const double fade = kFadeShare * width;
  const std::string name = range.domain + "_" + range.quantity;
  settings.push_back({"static", name + "_low", "value", low});
  settings.push_back({"static", name + "_high", "value", high});
  settings.push_back({"static", name + "_fade", "value", fade});
  const auto input = machine.find_input(range.quantity);
  if (!input || machine.inputs[*input].hidden_axis) return;
  const auto is_set = [&](const Setting& one) {
    return one.section == "inputs" && one.element == range.quantity;
  };
  if (std::any_of(settings.begin(), settings.end(), is_set))
    return;  // another domain over the same rows has set it
  if (!machine.inputs[*input].min) settings.push_back({"inputs", range.quantity, "min", low - 2 * fade});
  if (!machine.inputs[*input].max) settings.push_back({"inputs", range.quantity, "max", high + 2 * fade});
}

}  // namespace

std::string domain_weight(const std::string& domain, const std::vector<std::string>& quantities) {
  std::string weight;
  for (const std::string& q : quantities) {
    const std::string name = domain + "_" + q;
    weight += fmt::format("{1}max(0,1-max(0,max({0}_low-{2},{2}-{0}_high))/{0}_fade)", name,
                          weight.empty() ? "" : "*", q);
  }
  return weight;
}

std::vector<DomainStatic> open_domain(
    const std::string& domain, const std::vector<std::pair<std::string, std::string>>& quantity_and_unit) {
  std::vector<DomainStatic> list;
  for (const auto& [quantity, unit] : quantity_and_unit) {
    const std::string name = domain + "_" + quantity;
    list.push_back({name + "_low", unit, -kOpen});
    list.push_back({name + "_high", unit, kOpen});
    list.push_back({name + "_fade", unit, kOpen});
  }
  return list;
}

std::vector<DomainRange> domain_ranges(const model::Machine& machine) {
  std::vector<DomainRange> list;
  for (const model::Static& item : machine.statics) {
    const auto end = item.name.size() < 4 ? std::string::npos : item.name.rfind("_low");
    const auto begin = item.name.find('_');
    if (!item.hidden || end == std::string::npos || end + 4 != item.name.size() || begin >= end) continue;
    DomainRange range{item.name.substr(0, begin),
                      item.name.substr(begin + 1, end - begin - 1),
                      {},
                      item.value,
                      0,
                      0,
                      false};
    const auto high = machine.find_static(item.name.substr(0, end) + "_high");
    const auto fade = machine.find_static(item.name.substr(0, end) + "_fade");
    range.symbol = model::resolve_name(machine, range.quantity);
    if (!high || !fade || range.symbol.kind == model::SymbolKind::kUnresolved) continue;
    range.high = machine.statics[*high].value;
    range.fade = machine.statics[*fade].value;
    range.open = range.low <= -kOpen && range.high >= kOpen;
    list.push_back(range);
  }
  return list;
}

std::string close_domains(const std::string& text, const model::Machine& machine,
                          const model::Measurement& measurement) {
  std::vector<Setting> settings;
  for (const DomainRange& range : domain_ranges(machine)) {
    if (!range.open) continue;
    const model::Column column = values_of(machine, range, measurement.states);
    double low = HUGE_VAL, high = -HUGE_VAL;
    for (std::size_t row = 0; row < measurement.rows(); ++row) {
      if (measurement.check[row]) continue;
      low = std::min(low, column[static_cast<Eigen::Index>(row)]);
      high = std::max(high, column[static_cast<Eigen::Index>(row)]);
    }
    if (low <= high) close(machine, range, low, high, settings);
  }
  if (settings.empty()) return text;
  pugi::xml_document document;
  document.load_buffer(text.data(), text.size(), pugi::parse_default, pugi::encoding_utf8);
  std::vector<text::TextEdit> edits;
  edit(document, text, settings, edits);
  return text::apply_edits(text, std::move(edits));
}

std::vector<DomainUse> domain_use(const model::Machine& machine, const model::Measurement& measurement) {
  std::vector<DomainUse> list;
  for (const DomainRange& range : domain_ranges(machine)) {
    DomainUse use{range, HUGE_VAL, -HUGE_VAL, 0, 0};
    for (const double value : values_of(machine, range, measurement.states)) {
      use.least = std::min(use.least, value);
      use.most = std::max(use.most, value);
      const double beyond = std::max(range.low - value, value - range.high);
      use.faded += beyond > 0 ? 1 : 0;
      use.gone += beyond >= range.fade ? 1 : 0;
    }
    list.push_back(use);
  }
  return list;
}

}  // namespace vernier::fit
