// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/effects/add.h"
#include <fmt/format.h>

#include <algorithm>
#include <pugixml.hpp>

#include "tools/effects/input_class.h"
#include "tools/effects/insertion.h"
#include "tools/fit/coverage/domain.h"
#include "tools/format/columns.h"
#include "tools/text/error.h"
#include "tools/text/numbers.h"
#include "tools/text/xml_text.h"

namespace vernier::effects {
namespace {

/// Collects the insertions that put a candidate into a machine file.
class Adder {
 public:
  Adder(const std::string& text, const model::Machine& machine, const Candidate& candidate)
      : text_(text), machine_(machine), candidate_(candidate) {
    find_domain();
  }

  std::string add() {
    document_.load_buffer(text_.data(), text_.size(), pugi::parse_default, pugi::encoding_utf8);
    find(document_);
    if (variables_.empty())
      throw text::InputError(
          fmt::format("{}: the machine file has no <variables> element; add one", machine_.file));
    insert_variables();
    for (const CandidateTerm& term : candidate_.terms)
      if (is_stand_in(machine_, term.place))
        base_row_ += " " + std::string(dof_name(machine_, term.place)) + "=\"" + value_of(term) + "\"";
      else
        edit_term(term);
    if (!base_row_.empty()) insert_base_row();
    return text::apply_edits(text_, std::move(edits_));
  }

 private:
  void find(const pugi::xml_node& parent) {
    for (const pugi::xml_node node : parent.children()) {
      if (text::equal_no_case(node.name(), "variables") && variables_.empty()) variables_ = node;
      if (text::equal_no_case(node.name(), "static") && static_.empty()) static_ = node;
      if (text::equal_no_case(node.name(), "inputs") && inputs_.empty()) inputs_ = node;
      if (text::equal_no_case(node.name(), "transforms")) chains_.push_back(node);
      if (text::equal_no_case(node.name(), "variables") || node.parent() == document_) find(node);
    }
  }

  /// A term that was learned on accelerometer features gets a domain of validity. The domain
  /// covers its inputs and the feed, if they are in the term, and every thermometer of the
  /// machine. Temperature changes such terms without a visible sign.
  void find_domain() {
    const Choice& choice = candidate_.choice;
    bool learned = false;
    for (std::size_t i = 0; i < choice.inputs.size(); ++i) {
      model::Input input;
      input.name = choice.inputs[i];
      input.unit = i < choice.units.size() ? choice.units[i] : "";
      if (const auto known = machine_.find_input(input.name)) input = machine_.inputs[*known];
      learned = learned || class_of_input(input) == InputClass::kFeature;
      domain_.emplace_back(input.name, input.unit);
    }
    if (!learned) return domain_.clear();
    bool feed = false;
    for (const CandidateTerm& term : candidate_.terms)
      model::walk(*model::parse_expression(term.text), [&feed](const model::Expr& e) {
        feed = feed || (e.op == model::Op::kSymbol && e.name == format::columns::kFeed);
      });
    if (feed) domain_.emplace_back(format::columns::kFeed, format::column_unit(format::columns::kFeed));
    for (const model::Input& input : machine_.inputs) {
      const bool listed =
          std::any_of(domain_.begin(), domain_.end(), [&](const auto& q) { return q.first == input.name; });
      if (!listed && class_of_input(input) == InputClass::kTemperature)
        domain_.emplace_back(input.name, input.unit);
    }
    for (int n = 1;
         domain_name_.empty() || machine_.find_static(domain_name_ + "_" + domain_[0].first + "_low"); ++n)
      domain_name_ = fmt::format("domain{}", n);
  }

  std::string in_domain(const std::string& term) const {
    if (domain_.empty()) return term;
    std::vector<std::string> quantities;
    for (const auto& [quantity, unit] : domain_) quantities.push_back(quantity);
    const model::ExprPtr weight = model::parse_expression(fit::domain_weight(domain_name_, quantities));
    return model::to_text(*model::make_node(model::Op::kMultiply, {weight, model::parse_expression(term)}));
  }

  void append(const pugi::xml_node& node, const std::string& lines) {
    edits_.push_back(at_end_of(text_, node, lines));
  }

  std::string lines_of_statics() const {
    std::string lines;
    for (const CandidateUnknown& unknown : candidate_.unknowns)
      // A time constant or a period has no meaning at 0, so its nominal is its start value. The
      // term is still 0, because its coefficient is 0.
      lines +=
          fmt::format("      <{} value=\"{}\" nominal=\"{}\" unit=\"{}\"{} note=\"{}\"/>\n", unknown.name,
                      text::number_text(unknown.start),
                      unknown.kind == UnknownKind::kLinear ? "0" : text::number_text(unknown.start),
                      text::escape_attribute(unknown.unit),
                      unknown.scale ? fmt::format(" scale=\"{}\"", text::number_text(*unknown.scale)) : "",
                      text::escape_attribute(candidate_.label));
    for (const fit::DomainStatic& item : fit::open_domain(domain_name_, domain_))
      lines +=
          fmt::format("      <{} value=\"{}\" Hide=\"true\" unit=\"{}\" note=\"where it is valid: {}\"/>\n",
                      item.name, text::number_text(item.value), text::escape_attribute(item.unit),
                      text::escape_attribute(candidate_.label));
    return lines;
  }

  std::string lines_of_inputs() const {
    std::string lines;
    for (const auto& [name, unit] : names_of_new_inputs()) {
      const double reference = candidate_.choice.reference.value_or(unit == "degC" ? 20 : 0);
      lines += fmt::format("      <{} unit=\"{}\" reference=\"{}\"/>\n", name, text::escape_attribute(unit),
                           text::number_text(reference));
    }
    return lines;
  }

  /// Inserts into the sections that exist. Missing sections are created together.
  void insert_variables() {
    const std::string statics = lines_of_statics(), inputs = lines_of_inputs();
    std::string sections;
    if (static_.empty())
      sections += "    <static>\n" + statics + "    </static>\n";
    else
      append(static_, statics);
    if (inputs_.empty() && !inputs.empty())
      sections += "    <inputs>\n" + inputs + "    </inputs>\n";
    else if (!inputs.empty())
      append(inputs_, inputs);
    if (!sections.empty()) append(variables_, sections);
  }

  std::vector<std::pair<std::string, std::string>> names_of_new_inputs() const {
    std::vector<std::pair<std::string, std::string>> list;
    for (std::size_t i = 0; i < candidate_.choice.inputs.size(); ++i) {
      const std::string& name = candidate_.choice.inputs[i];
      if (machine_.find_input(name)) continue;
      list.emplace_back(name, i < candidate_.choice.units.size() ? candidate_.choice.units[i] : "");
    }
    return list;
  }

  pugi::xml_node chain_of(bool of_workpiece) const {
    for (const pugi::xml_node chain : chains_) {
      bool workpiece = false;
      for (const pugi::xml_attribute item : chain.attributes())
        if (text::equal_no_case(item.name(), "branch")) workpiece = item.value() == std::string("workpiece");
      if (workpiece == of_workpiece) return chain;
    }
    return {};
  }

  /// Returns the row of the file for a location that with_base_row did not add.
  pugi::xml_node node_of(const DofPlace& place) const {
    // By position, because `n` may be absent.
    std::size_t index = !place.workpiece && is_stand_in(machine_, {false, 0, 0}) ? 1 : 0;
    for (const pugi::xml_node node : chain_of(place.workpiece).children())
      if (node.type() == pugi::node_element && index++ == place.transform) return node;
    throw text::InputError(
        fmt::format("{}: transform {} was not found again", machine_.file, transform_at(machine_, place).n));
  }

  /// Writes the row that with_base_row added: first of the tool branch, last of the workpiece
  /// branch.
  void insert_base_row() {
    const DofPlace place = candidate_.terms[0].place;
    const std::string row = fmt::format("<sixdof n=\"{}\"{}/>", transform_at(machine_, place).n, base_row_);
    if (place.workpiece) return append(chain_of(true), "    " + row + "\n");
    const std::size_t first = offset_of(node_of({false, 1, 0})) - 1;
    const std::size_t line = text_.rfind('\n', first) + 1;  // 0 on the first line
    const bool alone = text_.find_first_not_of(" \t", line) == first;
    edits_.push_back({first, 0, row + (alone ? "\n" + text_.substr(line, first - line) : "")});
  }

  /// Comparisons have the lowest precedence. Next to another operand they need parentheses.
  static bool is_comparison(const model::Expr& expr) {
    return expr.op == model::Op::kEqual || expr.op == model::Op::kLess || expr.op == model::Op::kGreater;
  }

  /// Returns the term as an attribute contains it, next to other terms or alone.
  std::string value_of(const CandidateTerm& term) const {
    const std::string text = in_domain(term.text);
    const bool open = is_comparison(*model::parse_expression(text));
    return text::escape_attribute(open ? "(" + text + ")" : text);
  }

  void edit_term(const CandidateTerm& term) {
    const pugi::xml_node node = node_of(term.place);
    const std::string name = dof_name(machine_, term.place);
    const std::string value = value_of(term);
    const bool closed = !is_comparison(*transform_at(machine_, term.place).dof[term.place.dof]);
    for (const text::AttributeSpan& span : text::attribute_spans(text_, offset_of(node))) {
      if (!text::equal_no_case(span.name, name)) continue;
      const std::string before = text_.substr(span.value_at, span.value_size);
      const auto number = text::parse_number(before);
      if (before.empty() || (number && *number == 0))
        edits_.push_back({span.value_at, span.value_size, value});
      else {
        if (!closed) edits_.push_back({span.value_at, 0, "("});
        edits_.push_back({span.value_at + span.value_size, 0,
                          (closed ? "" : ")") + std::string(value[0] == '-' ? "" : "+") + value});
      }
      return;
    }
    edits_.push_back({text::end_of_attributes(text_, offset_of(node)), 0, " " + name + "=\"" + value + "\""});
  }

  const std::string& text_;
  const model::Machine& machine_;
  const Candidate& candidate_;
  std::string domain_name_;
  std::vector<std::pair<std::string, std::string>> domain_;  // quantity and unit; empty: not learned
  pugi::xml_document document_;
  pugi::xml_node variables_, static_, inputs_;
  std::vector<pugi::xml_node> chains_;
  std::string base_row_;  // attributes of the row to write
  std::vector<text::TextEdit> edits_;
};

}  // namespace

std::string add_to_machine_text(const std::string& text, const model::Machine& machine,
                                const Candidate& candidate) {
  return Adder(text, machine, candidate).add();
}

}  // namespace vernier::effects
