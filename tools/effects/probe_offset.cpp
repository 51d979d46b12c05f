// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/effects/probe_offset.h"

#include <fmt/format.h>

#include <cmath>
#include <pugixml.hpp>

#include "tools/effects/insertion.h"
#include "tools/format/columns.h"
#include "tools/text/error.h"
#include "tools/text/xml_text.h"

namespace vernier::effects {
namespace {

using format::columns::kProbe;

constexpr const char* kHeight = "probe_height";

/// The transforms of the tool branch: without the attribute `branch`, or with the word "tool".
pugi::xml_node tool_branch(const pugi::xml_node& document) {
  return document.find_node([](const pugi::xml_node& node) {
    if (!text::equal_no_case(node.name(), "transforms")) return false;
    for (const pugi::xml_attribute attribute : node.attributes())
      if (text::equal_no_case(attribute.name(), "branch"))
        return text::equal_no_case(attribute.value(), "tool");
    return true;
  });
}

/// Number of the last transform of a branch.
int last_number(const pugi::xml_node& branch) {
  int last = 0;
  for (const pugi::xml_node row : branch.children())
    if (row.type() == pugi::node_element) last = row.attribute("n").as_int(last + 1);
  return last;
}

/// Which touches the rows have: with the probe, with the tool point.
struct Touches {
  bool of_probe = false, of_tool_point = false;
};

Touches touches_of(const model::Measurement& rows) {
  Touches touches;
  for (std::size_t row = 0; row < rows.rows(); ++row) {
    if (rows.thing_of(row) == model::kNoThing) continue;
    bool of_probe = false;
    for (const model::CandidateInput& column : rows.candidates)
      for (const char* const name : kProbe) {
        const double value = column.value[static_cast<Eigen::Index>(row)];
        if (column.name == name && std::isfinite(value) && value != 0) of_probe = true;
      }
    (of_probe ? touches.of_probe : touches.of_tool_point) = true;
  }
  return touches;
}

}  // namespace

model::CompletedText with_probe_offset(const std::string& text, const model::Machine& machine,
                                       const model::Measurement& rows) {
  for (const char* const name : kProbe)
    if (machine.find_input(name)) return {text, {}};
  const Touches touches = touches_of(rows);
  if (!touches.of_probe) return {text, {}};
  pugi::xml_document document;
  document.load_buffer(text.data(), text.size(), pugi::parse_default, pugi::encoding_utf8);
  const pugi::xml_node branch = tool_branch(document), variables = element_named(document, "variables");
  if (!branch || !variables)
    throw text::InputError(
        {machine.file, 0}, kProbe[0],
        "the rows state the offset of a probe, but the machine file has no <variables> or no "
        "<transforms branch=\"tool\">: write the transform of the probe into the machine file");
  model::CompletedText result;
  std::vector<text::TextEdit> edits;
  const pugi::xml_node inputs = element_named(document, "inputs"),
                       statics = element_named(document, "static");
  std::string lines;
  for (const char* const name : kProbe)
    lines += fmt::format("      <{} unit=\"mm\" reference=\"0\" role=\"other\"/>\n", name);
  std::string height;
  if (touches.of_tool_point) {
    height = fmt::format(" Z=\"{}*(abs({})+abs({})&gt;0)\"", kHeight, kProbe[0], kProbe[1]);
    const std::string entry = fmt::format(
        "      <{} value=\"0\" nominal=\"0\" unit=\"mm\" note=\"height of the probe over the tool "
        "point\"/>\n",
        kHeight);
    edits.push_back(statics ? at_end_of(text, statics, entry)
                            : at_end_of(text, variables, "    <static>\n" + entry + "    </static>\n"));
  }
  edits.push_back(inputs ? at_end_of(text, inputs, lines)
                         : at_end_of(text, variables, "    <inputs>\n" + lines + "    </inputs>\n"));
  edits.push_back(at_end_of(text, branch,
                            fmt::format("    <sixdof n=\"{}\" X=\"{}\" Y=\"{}\"{}/>\n",
                                        last_number(branch) + 1, kProbe[0], kProbe[1], height)));
  result.text = text::apply_edits(text, std::move(edits));
  result.notes.push_back(fmt::format(
      "the rows touch with a probe beside the tool point: the machine file has the inputs {} and {}, and a "
      "transform of the probe",
      kProbe[0], kProbe[1]));
  if (touches.of_tool_point)
    result.notes.push_back(
        fmt::format("the height of the probe over the tool point is unknown: {} is fitted", kHeight));
  return result;
}

}  // namespace vernier::effects
