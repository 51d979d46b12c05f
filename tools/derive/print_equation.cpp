// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/derive/print_equation.h"

#include <fmt/format.h>

namespace vernier::derive {
namespace {

using GiNaC::ex;

constexpr std::array<const char*, 9> kComponents = {"dX", "dY", "dZ", "dA", "dB", "dC", "di", "dj", "dk"};
constexpr std::array<const char*, 9> kLatexComponents = {"\\Delta X", "\\Delta Y", "\\Delta Z",
                                                         "\\Delta A", "\\Delta B", "\\Delta C",
                                                         "\\Delta i", "\\Delta j", "\\Delta k"};
constexpr std::size_t kLineLength = 110;  // letters in a line of a page

ex sensitivity(const ErrorEquation& equation, std::size_t parameter, std::size_t component) {
  if (component < 6) return equation.sensitivity[parameter][component];
  return tool_axis_sensitivity(equation, parameter)[component - 6];
}

std::vector<std::string> component_terms(const ErrorEquation& equation, std::size_t component,
                                         Notation notation) {
  std::vector<std::string> terms;
  for (std::size_t p = 0; p < equation.parameters.size(); ++p) {
    const ex factor = sensitivity(equation, p, component);
    if (factor.is_zero()) continue;
    std::string text = print(factor * equation.parameters[p].symbol, notation);
    const bool negative = text[0] == '-';
    if (negative) text.erase(0, 1);
    terms.push_back((negative ? "- " : "+ ") + text);
  }
  return terms;
}

std::string sum_text(const std::vector<std::string>& terms, const std::string& separator) {
  if (terms.empty()) return "0";
  std::string text = terms[0][0] == '-' ? "-" + terms[0].substr(2) : terms[0].substr(2);
  for (std::size_t i = 1; i < terms.size(); ++i) text += separator + terms[i];
  return text;
}

/// Distributes terms over lines of bounded length, at least one term per line.
std::string wrapped(const std::string& head, const std::vector<std::string>& terms) {
  std::string text = head + " =", line;
  if (terms.empty()) return text + " 0\n";
  text += "\n";
  for (const std::string& term : terms) {
    if (!line.empty() && line.size() + term.size() + 5 > kLineLength) {
      text += "    " + line + "\n";
      line.clear();
    }
    line += (line.empty() ? "" : " ") + term;
  }
  return text + "    " + line + "\n";
}

std::string size_text(const ErrorParameter& p) {
  return fmt::format("{:.6g} {}", p.magnitude, p.unit.empty() ? "(no unit)" : p.unit);
}

std::string bound_text(const DerivedMachine& d) {
  std::string text = "Neglected second order, for errors up to the sizes above over the whole ranges:\n";
  if (d.bound.bound)
    text += fmt::format(
        "    at most {:.4g} um and {:.4g} urad of the tool axis (proved by interval arithmetic)\n",
        d.bound.bound->position_mm * 1e3, d.bound.bound->axis_rad * 1e6);
  else
    text += "    no bound: " + d.bound.reason + "\n";
  if (d.sampled)
    text += fmt::format(
        "    largest seen in {} random poses with all errors at their size: {:.4g} um, {:.4g} urad\n",
        d.samples, d.sampled->position_mm * 1e3, d.sampled->axis_rad * 1e6);
  return text;
}

std::string vector_text(const std::array<ex, 3>& v, Notation notation) {
  return "(" + print(v[0], notation) + ", " + print(v[1], notation) + ", " + print(v[2], notation) + ")";
}

}  // namespace

std::string print_component(const ErrorEquation& equation, std::size_t component, Notation notation,
                            const std::string& separator) {
  return sum_text(component_terms(equation, component, notation), separator);
}

std::string print_text(const DerivedMachine& derived) {
  const ErrorEquation& e = derived.equation;
  std::string text = fmt::format(
      "Error equation of {}, to first order\nActual minus nominal in workpiece coordinates; lengths in mm, "
      "angles and rotary positions in rad.\n\nNominal tool point (X, Y, Z):\n    {}\nNominal tool axis (i, "
      "j, k):\n    {}\n\nDeviation of the tool point:\n",
      e.machine.name.empty() ? "the machine" : e.machine.name, vector_text(e.position, Notation::kText),
      vector_text(e.tool_axis, Notation::kText));
  for (std::size_t c = 0; c < 9; ++c) {
    if (c == 3) text += "\nRotation of the tool (rotation vector):\n";
    if (c == 6) text += "\nDeviation of the tool axis:\n";
    text += wrapped(kComponents[c], component_terms(e, c, Notation::kText));
  }
  if (!e.abbreviations.empty()) text += "\nwhere (mm):\n";
  for (const Abbreviation& a : e.abbreviations)
    text += "    " + a.symbol.get_name() + " = " + print(a.value, Notation::kText) + "\n";
  text += "\nErrors, what they are called in the machine file, size assumed:\n";
  for (const ErrorParameter& p : e.parameters)
    text += fmt::format("    {:<10} {:<22} {}{}\n", p.name, p.source, size_text(p),
                        p.from_file ? " (from the file)" : "");
  text += "\n" + bound_text(derived);
  for (const std::string& note : e.notes) text += "Note: " + note + "\n";
  for (const std::string& note : e.machine.notes) text += "Note: " + note + "\n";
  return text;
}

std::string print_latex(const DerivedMachine& derived) {
  const ErrorEquation& e = derived.equation;
  std::string text =
      "% Error equation to first order: actual minus nominal, workpiece coordinates; mm and rad.\n"
      "\\begin{align*}\n";
  for (std::size_t c = 0; c < 9; ++c) {
    text += std::string(kLatexComponents[c]) + " ={}& ";
    text += print_component(e, c, Notation::kLatex, " \\\\\n &");
    text += c == 8 && e.abbreviations.empty() ? "\n" : " \\\\\n";
  }
  for (std::size_t i = 0; i < e.abbreviations.size(); ++i)
    text += print(e.abbreviations[i].symbol, Notation::kLatex) + " ={}& " +
            print(e.abbreviations[i].value, Notation::kLatex) +
            (i + 1 == e.abbreviations.size() ? "\n" : " \\\\\n");
  text += "\\end{align*}\n";
  if (derived.bound.bound)
    text += fmt::format("%% neglected second order: at most {:.4g} um, {:.4g} urad\n",
                        derived.bound.bound->position_mm * 1e3, derived.bound.bound->axis_rad * 1e6);
  return text;
}

nlohmann::ordered_json to_json(const DerivedMachine& derived) {
  const ErrorEquation& e = derived.equation;
  nlohmann::ordered_json result = {{"machine", e.machine.name}, {"nominal", {}}, {"parameters", {}}};
  for (std::size_t i = 0; i < 3; ++i) {
    result["nominal"][std::string(1, "XYZ"[i])] = print(e.position[i], Notation::kText);
    result["nominal"][std::string(1, "ijk"[i])] = print(e.tool_axis[i], Notation::kText);
  }
  for (std::size_t c = 0; c < 9; ++c) {
    result[kComponents[c]] = print_component(e, c, Notation::kText);
    result["latex"][kComponents[c]] = print_component(e, c, Notation::kLatex);
  }
  for (const Abbreviation& a : e.abbreviations)
    result["where"][a.symbol.get_name()] = print(a.value, Notation::kText);
  result["parameters"] = nlohmann::ordered_json::array();
  for (std::size_t p = 0; p < e.parameters.size(); ++p) {
    const ErrorParameter& q = e.parameters[p];
    nlohmann::ordered_json item = {{"name", q.name},           {"source", q.source},
                                   {"unit", q.unit},           {"file_units", q.file_units},
                                   {"magnitude", q.magnitude}, {"from_file", q.from_file}};
    for (std::size_t c = 0; c < 9; ++c) item[kComponents[c]] = print(sensitivity(e, p, c), Notation::kText);
    result["parameters"].push_back(std::move(item));
  }
  nlohmann::ordered_json second = {
      {"method", "interval"}, {"bound_um", nullptr}, {"axis_bound_urad", nullptr}};
  if (derived.bound.bound) {
    second["bound_um"] = derived.bound.bound->position_mm * 1e3;
    second["axis_bound_urad"] = derived.bound.bound->axis_rad * 1e6;
  } else {
    second["reason"] = derived.bound.reason;
  }
  if (derived.sampled) {
    second["samples"] = derived.samples;
    second["sampled_um"] = derived.sampled->position_mm * 1e3;
    second["axis_sampled_urad"] = derived.sampled->axis_rad * 1e6;
  }
  result["second_order"] = std::move(second);
  result["notes"] = e.notes;
  return result;
}

}  // namespace vernier::derive
