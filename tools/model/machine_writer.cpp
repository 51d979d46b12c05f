// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/model/machine_writer.h"

#include <pugixml.hpp>
#include <utility>

#include "tools/model/fit_record.h"
#include "tools/model/machine.h"
#include "tools/text/numbers.h"
#include "tools/text/xml_text.h"

namespace vernier::model {
namespace {

/// Collects the edits that replace the numbers of a text by those of a machine.
class Writer {
 public:
  Writer(const std::string& text, const Machine& machine, bool set_nominal)
      : text_(text), machine_(machine), set_nominal_(set_nominal) {}

  std::string write() {
    pugi::xml_document document;
    document.load_buffer(text_.data(), text_.size(), pugi::parse_default, pugi::encoding_utf8);
    visit(document);
    return text::apply_edits(text_, std::move(edits_));
  }

 private:
  void visit(const pugi::xml_node& parent) {
    for (const pugi::xml_node node : parent.children()) {
      if (text::equal_no_case(node.name(), "static"))
        for (const pugi::xml_node child : node.children()) edit_static(child);
      else if (text::equal_no_case(node.name(), "table"))
        edit_table(node);
      else if (text::equal_no_case(node.name(), "machineaxes"))
        for (const pugi::xml_node child : node.children()) edit_axis(child);
      else
        visit(node);
    }
  }

  void edit_static(const pugi::xml_node& node) {
    const bool at_tool = text::equal_no_case(node.name(), "ToolShift");
    if (at_tool || text::equal_no_case(node.name(), "BaseShift")) {
      std::optional<std::string> run;
      for (const pugi::xml_attribute item : node.attributes())
        if (text::equal_no_case(item.name(), "run") || text::equal_no_case(item.name(), "setup"))
          run = item.value();
      for (const BaseShift& shift : at_tool ? machine_.tool_shifts : machine_.base_shifts)
        if (shift.run == run) set_six(node, shift.value);
      return;
    }
    const auto index = machine_.find_static(node.name());
    if (!index) return;
    const Static& item = machine_.statics[*index];
    const std::string before = text_of(node, "value");
    if (item.hidden) return;
    set(node, "value", text::number_text(item.value));
    if (set_nominal_) set_nominal(node, item, before);
  }

  /// Sets nominal if the text has none: to the machine's nominal, else to the value that the text
  /// had. The number is kept as it was written.
  void set_nominal(const pugi::xml_node& node, const Static& item, const std::string& before) {
    if (!text_of(node, "nominal").empty()) return;
    const bool as_written = !item.nominal || text::parse_number(before) == item.nominal;
    set(node, "nominal", as_written ? before : text::number_text(*item.nominal));
  }

  void edit_axis(const pugi::xml_node& node) {
    const auto index = machine_.find_axis(node.name());
    if (!index) return;
    const Axis& axis = machine_.axes[*index];
    if (axis.scale_free) set(node, "scalefactor", text::number_text(axis.scale_factor));
    for (const auto& [name, limit] : {std::pair("min", axis.min), std::pair("max", axis.max)})
      if (limit && text::parse_number(text_of(node, name)) != limit)
        set(node, name, text::number_text(*limit));
  }

  void edit_table(const pugi::xml_node& node) {
    const auto axis = machine_.find_axis(text_of(node, "axis"));
    const Table* table = axis ? machine_.table_of(*axis) : nullptr;
    if (table == nullptr) return;
    std::size_t at = 0;
    for (const pugi::xml_node station : node.children())
      if (at < table->stations.size()) set_six(station, table->stations[at++].value);
  }

  void set_six(const pugi::xml_node& node, const std::array<double, 6>& value) {
    for (std::size_t i = 0; i < 6; ++i) {
      const auto now = text::parse_number(text_of(node, kSixDofNames[i]));
      if (now.value_or(0) != value[i]) set(node, kSixDofNames[i], text::number_text(value[i]));
    }
  }

  std::string text_of(const pugi::xml_node& node, std::string_view name) const {
    for (const text::AttributeSpan& span : text::attribute_spans(text_, offset(node)))
      if (text::equal_no_case(span.name, name)) return text_.substr(span.value_at, span.value_size);
    return {};
  }

  void set(const pugi::xml_node& node, const std::string& name, const std::string& value) {
    for (const text::AttributeSpan& span : text::attribute_spans(text_, offset(node)))
      if (text::equal_no_case(span.name, name)) {
        if (text_.compare(span.value_at, span.value_size, value) != 0)
          edits_.push_back({span.value_at, span.value_size, value});
        return;
      }
    edits_.push_back({text::end_of_attributes(text_, offset(node)), 0, " " + name + "=\"" + value + "\""});
  }

  static std::size_t offset(const pugi::xml_node& node) {
    return static_cast<std::size_t>(node.offset_debug());
  }

  const std::string& text_;
  const Machine& machine_;
  bool set_nominal_;
  std::vector<text::TextEdit> edits_;
};

}  // namespace

std::string update_machine_text(const std::string& text, const Machine& machine, bool set_nominal) {
  const std::string written = Writer(text, machine, set_nominal).write();
  return machine.fitted ? with_fit_record(written, *machine.fitted) : written;
}

}  // namespace vernier::model
