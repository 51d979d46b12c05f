// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/lint/machine_lint.h"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <cmath>
#include <set>

#include "tools/format/columns.h"
#include "tools/format/units.h"
#include "tools/model/machine_reader.h"
#include "tools/model/measurement_names.h"
#include "tools/text/numbers.h"
#include "tools/text/similar.h"

namespace vernier::lint {
namespace {

/// A message of InputError in its parts.
struct Problem {
  std::size_t line = 0;
  std::string word, what;
  bool operator==(const Problem&) const = default;
};

Problem problem_of(const std::string& message, const std::string& file) {
  Problem problem;
  std::string rest = message.starts_with(file + ":") ? message.substr(file.size() + 1) : message;
  std::size_t digits = 0;
  while (digits < rest.size() && std::isdigit(static_cast<unsigned char>(rest[digits])) != 0) ++digits;
  if (digits > 0 && rest.compare(digits, 2, ": ") == 0) {
    problem.line = static_cast<std::size_t>(*text::parse_number(rest.substr(0, digits)));
    rest = rest.substr(digits + 2);
  }
  const auto close = rest.find("\": ", 1);
  if (rest.starts_with('"') && close != std::string::npos) {
    problem.word = rest.substr(1, close - 1);
    rest = rest.substr(close + 3);
  }
  problem.what = rest;
  return problem;
}

bool has(const std::string& text, std::string_view part) { return text.find(part) != std::string::npos; }

/// Takes one broken word out of a machine file so that the rest can be read.
class Mend {
 public:
  Mend(std::string& text, const Problem& problem) : text_(text), problem_(problem) {
    std::size_t line = 1;
    while (line < problem.line && (begin_ = text.find('\n', begin_)) != std::string::npos) {
      ++begin_;
      ++line;
    }
    end_ = begin_ == std::string::npos ? begin_ : std::min(text.find('\n', begin_), text.size());
  }

  bool done() {
    if (problem_.line == 0 || begin_ == std::string::npos) return false;
    if (has(problem_.what, "needs a value")) return insert_value();
    if (has(problem_.what, "attribute")) return remove_attribute(problem_.word);
    if (has(problem_.what, "stations must increase")) return remove_station();
    if (mend_value()) return true;
    return remove_element(problem_.word);
  }

 private:
  struct Attribute {
    std::size_t begin = 0, value = 0, end = 0;  // of its name, its value, behind its closing quote
    std::string name, text;
  };

  std::vector<Attribute> attributes() const {
    std::vector<Attribute> list;
    for (std::size_t at = begin_; at < end_; ++at) {
      if (text_[at] != '=') continue;
      const std::size_t open = text_.find_first_not_of(" \t", at + 1);
      if (open == std::string::npos || (text_[open] != '"' && text_[open] != '\'')) continue;
      const std::size_t close = text_.find(text_[open], open + 1);
      const std::size_t last = text_.find_last_not_of(" \t", at - 1);
      const std::size_t blank = text_.find_last_of(" \t\n<", last);
      if (close == std::string::npos || blank == std::string::npos) continue;
      list.push_back({blank + 1, open + 1, close + 1, text_.substr(blank + 1, last - blank),
                      text_.substr(open + 1, close - open - 1)});
      at = close;
    }
    return list;
  }

  bool remove_attribute(const std::string& name) {
    std::vector<Attribute> list = attributes();
    std::reverse(list.begin(), list.end());  // of two the second
    for (const Attribute& one : list)
      if (one.name == name) {
        text_.erase(one.begin, one.end - one.begin);
        return true;
      }
    return false;
  }

  bool mend_value() {
    for (const Attribute& one : attributes()) {
      if (problem_.word.empty() ? !one.text.empty() : !has(one.text, problem_.word)) continue;
      static const std::set<std::string> kDroppable = {
          "min",  "max",           "maxcorrection", "maxslew", "n",    "scale",    "nominal", "name",
          "note", "interpolation", "rotary",        "fit",     "Hide", "rollover", "gravity"};
      if (one.name == "axis" || one.name == "loc")
        return remove_element(one.name == "axis" ? "table" : "station");
      if (one.name == "branch" || one.name == "run") return false;
      if (kDroppable.contains(one.name))
        text_.erase(one.begin, one.end - one.begin);
      else
        text_.replace(one.value, one.end - 1 - one.value, "0");
      return true;
    }
    return false;
  }

  /// Of several stations in one line the one at this position.
  bool remove_station() {
    const std::size_t at = text_.find("\"" + problem_.word + "\"", begin_);
    if (at == std::string::npos || at >= end_) return false;
    begin_ = text_.rfind('<', at);
    return remove_element("station");
  }

  bool insert_value() {
    const std::size_t at = text_.find("<" + problem_.word, begin_);
    if (at == std::string::npos || at >= end_) return false;
    text_.insert(at + 1 + problem_.word.size(), " value=\"0\"");
    return true;
  }

  /// The element that begins in this line, with all that is in it; its lines stay, so that numbers stay
  /// right.
  bool remove_element(const std::string& name) {
    const std::size_t at = name.empty() ? std::string::npos : text_.find("<" + name, begin_);
    if (at == std::string::npos || at >= end_) return false;
    const std::size_t tag_end = text_.find('>', at);
    if (tag_end == std::string::npos) return false;
    std::size_t last = tag_end + 1;
    if (text_[tag_end - 1] != '/') {
      const std::string closing = "</" + name + ">";
      const std::size_t close = text_.find(closing, tag_end);
      if (close == std::string::npos) return false;
      last = close + closing.size();
    }
    for (std::size_t i = at; i < last; ++i)
      if (text_[i] != '\n') text_[i] = ' ';
    return true;
  }

  std::string& text_;
  const Problem& problem_;
  std::size_t begin_ = 0, end_ = 0;
};

/// Names that a file declares, for "did you mean".
std::vector<std::string> names_in(const std::string& text) {
  std::vector<std::string> names = model::function_names();
  for (const format::ColumnGroup& group : format::column_groups())
    if (group.in_terms) names.insert(names.end(), group.list().begin(), group.list().end());
  for (std::size_t at = 0; (at = text.find('<', at)) != std::string::npos;) {
    std::size_t end = ++at;
    while (end < text.size() &&
           (std::isalnum(static_cast<unsigned char>(text[end])) != 0 || text[end] == '_'))
      ++end;
    if (end > at) names.push_back(text.substr(at, end - at));
  }
  return names;
}

std::string meaning_of(const Problem& problem, const std::string& text) {
  const bool number = has(problem.what, "must be a number");
  if (number && has(problem.word, ",")) return "decimal comma? Machine files have a decimal point";
  if (number && !problem.word.empty()) {
    std::size_t end = problem.word.find_first_not_of("0123456789.+-eE");
    if (end != std::string::npos && end > 0 && text::parse_number(problem.word.substr(0, end)))
      return "write the unit as the attribute unit=\"…\", not behind the number; values are in mm and deg";
  }
  if (has(problem.what, "unknown name") || has(problem.what, "the machine has no axis of this name"))
    if (const auto meant = text::word_meant(problem.word, names_in(text)))
      return "did you mean " + *meant + "?";
  if (has(problem.what, "unknown attribute")) {
    static const std::vector<std::string> kAttributes = {
        "value", "nominal",       "unit",          "note",    "Hide",     "scale",       "rotary",
        "min",   "max",           "maxcorrection", "maxslew", "rollover", "scalefactor", "reference",
        "axis",  "interpolation", "fit",           "loc",     "branch",   "theta",       "alpha"};
    if (const auto meant = text::word_meant(problem.word, kAttributes)) return "did you mean " + *meant + "?";
  }
  if (has(problem.what, "unknown element")) {
    static const std::vector<std::string> kElements = {
        "variables", "static", "machineaxes", "inputs",    "comptables", "table",  "station",   "transforms",
        "sixdof",    "DH",     "BaseShift",   "ToolShift", "tools",      "volume", "instrument"};
    if (const auto meant = text::word_meant(problem.word, kElements)) return "did you mean " + *meant + "?";
  }
  if (has(problem.what, "stations must increase"))
    return "the stations must be in the order of their positions, each once";
  return "";
}

/// Names that the transforms use.
struct Used {
  std::set<std::size_t> statics, axes, inputs, table_values;  // table_values: axis * 6 + column
  bool feed = false;
};

Used used_by(const model::Machine& machine) {
  Used used;
  for (const auto* branch : {&machine.tool, &machine.workpiece})
    for (const model::Transform& transform : *branch)
      for (std::size_t i = 0; i < transform.dof_count(); ++i)
        model::walk(*transform.dof[i], [&](const model::Expr& node) {
          if (node.op != model::Op::kSymbol) return;
          const auto [kind, index] = node.symbol;
          if (kind == model::SymbolKind::kStatic) used.statics.insert(index);
          if (kind == model::SymbolKind::kAxis) used.axes.insert(index);
          if (kind == model::SymbolKind::kInput) used.inputs.insert(index);
          if (kind == model::SymbolKind::kTableValue) used.table_values.insert(index);
        });
  for (const model::Artefact& artefact : machine.artefacts)
    if (const auto tip = machine.find_static(artefact.tip)) used.statics.insert(*tip);
  return used;
}

/// Names that a broken term would have used, from the text of the transforms.
void add_words(Used& used, const model::Machine& machine, const std::string& text) {
  std::string word;
  for (std::size_t at = std::min(text.find("<transforms"), text.size()); at <= text.size(); ++at) {
    const bool letter =
        at < text.size() && (std::isalnum(static_cast<unsigned char>(text[at])) != 0 || text[at] == '_');
    if (letter) {
      word += text[at];
      continue;
    }
    if (const auto found = machine.find_static(word)) used.statics.insert(*found);
    if (const auto found = machine.find_input(word)) used.inputs.insert(*found);
    // The axis X is a word of every sixdof too: its attribute.
    if (const auto found = machine.find_axis(word); found && (at >= text.size() || text[at] != '='))
      used.axes.insert(*found);
    for (std::size_t axis = 0; axis < machine.axes.size(); ++axis)
      for (std::size_t c = 0; c < 6; ++c)
        if (word == fmt::format("{}{}{}", c < 3 ? "l" : "r", machine.axes[axis].name, "xyz"[c % 3]))
          used.table_values.insert(axis * 6 + c);
    word.clear();
  }
}

class Oddities {
 public:
  Oddities(const model::Machine& machine, const std::string& text, bool broken_terms, LintFindings& findings)
      : m_(machine), findings_(findings), used_(used_by(machine)) {
    if (broken_terms) add_words(used_, machine, text);
  }

  void look() {
    for (std::size_t i = 0; i < m_.statics.size(); ++i) look_at(m_.statics[i], i);
    for (std::size_t i = 0; i < m_.axes.size(); ++i) look_at(m_.axes[i], i);
    for (std::size_t i = 0; i < m_.inputs.size(); ++i) look_at(m_.inputs[i], i);
    for (const model::Table& table : m_.tables) look_at(table);
    if (m_.base_shifts.empty())
      findings_.remark(0, "BaseShift",
                       "BaseShift is missing: the measuring frame is then the frame of the machine",
                       "a tracker or CMM has another frame; with <BaseShift X=\"0\" …/> a fit estimates the "
                       "position of the instrument");
    std::set<std::string> runs;
    for (const model::BaseShift& shift : m_.base_shifts)
      if (shift.run && m_.base_shifts.size() == 1)
        findings_.remark(shift.line, *shift.run,
                         "this BaseShift is only for one run; rows of other runs have no BaseShift");
  }

 private:
  void look_at_unit(const std::string& name, const std::string& unit, std::size_t line, bool scales) {
    if (unit.empty()) return;
    const auto known = format::find_unit(unit);
    if (!known) {
      std::vector<std::string> units;
      const std::string all = format::known_units();
      for (std::size_t at = 0; at < all.size();) {
        const std::size_t end = std::min(all.find(' ', at), all.size());
        units.push_back(all.substr(at, end - at));
        at = end + 1;
      }
      const bool inch = unit == "inch" || unit == "inches" || unit == "\"";
      const auto meant = inch ? std::optional<std::string>("in") : text::word_meant(unit, units);
      // "1/K", "mm/degC": units of coefficients are made of the known ones.
      const bool composed = unit.find_first_of("/*^") != std::string::npos;
      if (!composed)
        findings_.warn(line, unit, "unknown unit, of " + name, meant ? "did you mean " + *meant + "?" : "");
      return;
    }
    const bool base = known->factor == 1 && known->offset == 0;
    if (scales || base || unit == "rad" || unit == "um/m" || unit == "%") return;
    if (known->dimension == format::Dimension::kLength || known->dimension == format::Dimension::kAngle)
      findings_.warn(
          line, unit,
          fmt::format(
              "the unit does not convert the value of {}: the equations of the machine use the value in {}",
              name, format::base_unit(known->dimension)),
          fmt::format("write the value in {}, or the factor in the term",
                      format::base_unit(known->dimension)));
  }

  void look_at(const model::Static& item, std::size_t index) {
    look_at_unit(item.name, item.unit, item.line, false);
    if (!used_.statics.contains(index) && item.hidden)
      findings_.add_of_kind("unused constant", LintWeight::kRemark, item.line, item.name,
                            "no transform uses this constant",
                            "the chain has several tools, or this constant is not used");
    else if (!used_.statics.contains(index))
      findings_.warn(item.line, item.name, "no transform uses this static",
                     "add the name to a term, or remove it");
    else if (!item.hidden && !item.nominal)
      findings_.add_of_kind("nominal", LintWeight::kRemark, item.line, item.name,
                            "this constant is free and has no nominal: fit writes its value as nominal, and "
                            "compile requires nominal",
                            "nominal is the value that the control uses, mostly 0 for an error");
    if (!item.hidden && item.nominal && item.unit == "mm" && std::abs(item.value - *item.nominal) > 50)
      findings_.warn(item.line, item.name,
                     fmt::format("{:.6g} mm off its nominal", item.value - *item.nominal),
                     "µm written as mm?");
  }

  void look_at(const model::Axis& axis, std::size_t index) {
    if (model::is_no_axis_name(m_, axis.name))
      findings_.error(axis.line, axis.name, model::kMeasuredName,
                      "the programs can read no measurement file of this machine; choose another name");
    bool by_table = false;
    for (std::size_t c = 0; c < 6; ++c) by_table |= used_.table_values.contains(index * 6 + c);
    if (!used_.axes.contains(index))
      findings_.warn(axis.line, axis.name,
                     by_table ? "no transform moves with this axis, but the chain uses the table of this axis"
                              : "no transform uses this axis",
                     fmt::format("X=\"{}\" is missing in some sixdof, or the name differs", axis.name));
    if (!axis.min || !axis.max)
      findings_.add_of_kind(
          "travel", LintWeight::kRemark, axis.line, axis.name,
          "the axis has no min and max: the commands compile and plan need the travel of the axis");
    const bool turns = axis.name.size() == 1 && std::string("ABC").find(axis.name) != std::string::npos;
    if (turns && !axis.rotary)
      findings_.warn(axis.line, axis.name, "the axis has no rotary=\"true\": its positions are in mm",
                     "rotary=\"true\"?");
    if (axis.min && axis.max && !axis.rotary) {
      const double travel = *axis.max - *axis.min;
      if (travel < 5)
        findings_.warn(axis.line, axis.name, fmt::format("a travel of {} mm", text::number_text(travel)),
                       "is the travel in metres or inches? Axis positions are in mm");
      if (travel > 1e5)
        findings_.warn(axis.line, axis.name, fmt::format("a travel of {} mm", text::number_text(travel)),
                       "µm? Axes are in mm");
    }
    if (axis.min && axis.max && axis.rotary && *axis.max - *axis.min < 7)
      findings_.warn(axis.line, axis.name, fmt::format("turns by {:.6g} deg only", *axis.max - *axis.min),
                     "radians? Angles are in deg");
    if (axis.max_correction && *axis.max_correction > (axis.rotary ? 10 : 5))
      findings_.warn(axis.line, axis.name,
                     fmt::format("maxcorrection of {} {}", text::number_text(*axis.max_correction),
                                 axis.rotary ? "deg" : "mm"),
                     "is the value in µm? Its unit is that of the axis");
    if (!axis.max_correction)
      findings_.add_of_kind(
          "maxcorrection", LintWeight::kRemark, axis.line, axis.name,
          "the axis has no maxcorrection: the board does not limit the correction of this axis");
  }

  void look_at(const model::Input& input, std::size_t index) {
    if (model::is_no_input_name(m_, input.name))
      findings_.error(input.line, input.name, model::kMeasuredName,
                      "the programs can read no measurement file of this machine; choose another name");
    look_at_unit(input.name, input.unit, input.line, true);
    if (!used_.inputs.contains(index))
      findings_.warn(input.line, input.name, "no transform uses this input",
                     "a term that uses this input is missing, or remove this input");
  }

  void look_at(const model::Table& table) {
    const model::Axis& axis = m_.axes[table.axis];
    bool any = false;
    for (std::size_t c = 0; c < 6; ++c) {
      const bool used = used_.table_values.contains(table.axis * 6 + c);
      any |= used;
      if (!used && table.free[c])
        findings_.warn(
            table.line, axis.name,
            fmt::format("the attribute fit frees the column {}, which no transform uses",
                        model::kSixDofNames[c]),
            fmt::format("{}{}{} is missing in some transform", c < 3 ? "l" : "r", axis.name, "xyz"[c % 3]));
    }
    if (!any)
      findings_.warn(table.line, axis.name, "no transform uses this table",
                     fmt::format("the values of this table are l{0}x … r{0}z", axis.name));
    if (table.stations.empty() || !axis.min || !axis.max) return;
    const double slack = 1e-6 * (*axis.max - *axis.min);
    if (table.stations.front().loc > *axis.min + slack || table.stations.back().loc < *axis.max - slack)
      findings_.remark(table.line, axis.name,
                       fmt::format("stations are from {} to {}, travel is from {} to {}: beyond its ends a "
                                   "table uses its last value",
                                   text::number_text(table.stations.front().loc),
                                   text::number_text(table.stations.back().loc), text::number_text(*axis.min),
                                   text::number_text(*axis.max)));
    if (table.stations.front().loc < *axis.min - slack || table.stations.back().loc > *axis.max + slack)
      findings_.warn(table.line, axis.name, "the table has stations outside the travel of the axis",
                     "another unit, or another axis?");
  }

  const model::Machine& m_;
  LintFindings& findings_;
  Used used_;
};

}  // namespace

MachineLint lint_machine(const std::string& text, const std::string& file) {
  constexpr std::size_t kMostProblems = 200;  // more problems than a user corrects in one pass
  MachineLint result;
  LintFindings findings(file);
  std::string mended = text;
  std::vector<Problem> seen;
  std::optional<model::Machine> machine;
  bool broken_terms = false, all_read = false;
  while (!all_read && seen.size() < kMostProblems) {
    try {
      machine = model::parse_machine(mended, file);
      all_read = true;
    } catch (const text::InputError& error) {
      const Problem problem = problem_of(error.what(), file);
      if (std::find(seen.begin(), seen.end(), problem) != seen.end()) break;
      seen.push_back(problem);
      findings.add(LintWeight::kError, problem.line, problem.word, problem.what, meaning_of(problem, text));
      broken_terms |= has(problem.what, "=\"");
      if (!Mend(mended, problem).done()) break;
    }
  }
  if (!all_read)
    findings.add(LintWeight::kRemark, 0, "", "the text after the last error was not checked",
                 "correct the error and run lint again");
  if (machine) {
    for (const std::string& note : machine->notes)
      findings.add(LintWeight::kRemark, 0, "",
                   note.starts_with(file + ":") ? "line " + note.substr(file.size() + 1) : note);
    Oddities(*machine, text, broken_terms, findings).look();
    if (seen.empty()) result.machine = std::move(machine);
  }
  result.findings = findings.take();
  return result;
}

}  // namespace vernier::lint
