// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/effects/roles.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <pugixml.hpp>

#include "tools/effects/input_class.h"
#include "tools/effects/insertion.h"
#include "tools/text/error.h"
#include "tools/text/numbers.h"
#include "tools/text/words.h"
#include "tools/text/xml_text.h"

namespace vernier::effects {
namespace {

const model::CandidateInput& candidate_named(const model::Machine& machine, const model::Measurement& rows,
                                             const std::string& name) {
  for (const model::CandidateInput& one : rows.candidates)
    if (one.name == name) return one;
  if (machine.find_input(name))
    throw text::InputError(fmt::format(
        "{}: the machine file declares this input: its role is an attribute there, role=\"...\"", name));
  throw text::InputError(
      fmt::format("{}: the measurement has no column of that name that may be an input", name));
}

std::string line_of(const model::CandidateInput& candidate, model::InputRole role) {
  model::Input input;
  input.name = candidate.name, input.unit = candidate.unit, input.role = role;
  double sum = 0, count = 0;
  for (const double value : candidate.value)
    if (std::isfinite(value)) sum += value, ++count;
  return fmt::format("      <{} unit=\"{}\" reference=\"{}\" role=\"{}\"/>\n", candidate.name,
                     text::escape_attribute(candidate.unit),
                     text::number_text(usual_reference(input, count > 0 ? sum / count : 0)),
                     model::kInputRoleNames[static_cast<std::size_t>(role)]);
}

}  // namespace

ColumnRole parse_column_role(const std::string& statement) {
  const std::size_t sign = statement.find('=');
  ColumnRole one;
  one.column = statement.substr(0, sign);
  const std::string word = sign == std::string::npos ? "" : statement.substr(sign + 1);
  one.ignored = word == "ignore";
  const auto role = model::input_role_named(word);
  if (one.column.empty() || (!role && !one.ignored))
    throw text::InputError(fmt::format(
        "{}: is NAME=ROLE, a role temperature, load, vibration, set-point, other or ignore", statement));
  one.role = role.value_or(model::InputRole::kGuessed);
  return one;
}

std::string with_declared_columns(const std::string& text, const model::Machine& machine,
                                  const model::Measurement& rows, const std::vector<ColumnRole>& roles) {
  std::string lines;
  for (const ColumnRole& one : roles) {
    const model::CandidateInput& candidate = candidate_named(machine, rows, one.column);
    if (!one.ignored) lines += line_of(candidate, one.role);
  }
  if (lines.empty()) return text;
  pugi::xml_document document;
  document.load_buffer(text.data(), text.size(), pugi::parse_default, pugi::encoding_utf8);
  if (const pugi::xml_node inputs = element_named(document, "inputs"))
    return text::apply_edits(text, {at_end_of(text, inputs, lines)});
  const pugi::xml_node variables = element_named(document, "variables");
  if (!variables)
    throw text::InputError(
        fmt::format("{}: the machine file has no <variables> element; add one", machine.file));
  return text::apply_edits(text, {at_end_of(text, variables, "    <inputs>\n" + lines + "    </inputs>\n")});
}

void leave_out(model::Measurement& rows, const std::vector<ColumnRole>& roles) {
  std::erase_if(rows.candidates, [&](const model::CandidateInput& candidate) {
    return std::any_of(roles.begin(), roles.end(),
                       [&](const ColumnRole& one) { return one.ignored && one.column == candidate.name; });
  });
}

}  // namespace vernier::effects
