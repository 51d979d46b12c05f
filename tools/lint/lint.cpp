// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/lint/lint.h"

#include <fmt/format.h>

#include <algorithm>

#include "tools/fit/noise/contradicting_rows.h"
#include "tools/format/columns.h"
#include "tools/lint/machine_lint.h"
#include "tools/lint/measurement_lint.h"
#include "tools/model/measurement.h"
#include "tools/sheet/encoding.h"
#include "tools/sheet/sheet.h"
#include "tools/text/files.h"
#include "tools/text/words.h"

namespace vernier::lint {

LintedKind linted_kind_of(const std::string& bytes, const std::string& file) {
  if (sheet::is_workbook(bytes)) return LintedKind::kSpreadsheet;
  const std::string text = sheet::utf8_of(bytes, sheet::encoding_of(bytes));
  const std::string head = text::trimmed(std::string_view(text).substr(0, 4096));
  if (head.starts_with('<') || file.ends_with(".xml")) return LintedKind::kMachine;
  if (head.empty() || text.find('\0') != std::string::npos) return LintedKind::kOther;
  return import_command_for(bytes, file).empty() ? LintedKind::kMeasurement : LintedKind::kSpreadsheet;
}

const char* linted_kind_name(LintedKind kind) {
  switch (kind) {
    case LintedKind::kMachine:
      return "machine";
    case LintedKind::kMeasurement:
      return "measurement";
    case LintedKind::kSpreadsheet:
      return "spreadsheet";
    case LintedKind::kOther:
      return "other";
  }
  return "";
}

namespace {

/// Warns about measurement files without u beside files with u: the fit must estimate their weight.
void compare_uncertainties(std::vector<LintedFile>& files) {
  const auto lacks_u = [](const LintFinding& finding) {
    return finding.weight == LintWeight::kRemark && finding.word == format::columns::kUncertainty;
  };
  const auto has_u = [&](const LintedFile& file) {
    return file.kind == LintedKind::kMeasurement && file.usable &&
           std::none_of(file.findings.begin(), file.findings.end(), lacks_u);
  };
  const auto with = std::find_if(files.begin(), files.end(), has_u);
  if (with == files.end()) return;
  for (LintedFile& file : files)
    for (LintFinding& finding : file.findings) {
      if (!lacks_u(finding)) continue;
      finding.weight = LintWeight::kWarning;
      finding.what = fmt::format(
          "no standard uncertainty u in the file, and {} has one: fit, diagnose and improve estimate u from "
          "the repeats or the residual of this file",
          text::printable(with->file));
      finding.meaning = "state the standard uncertainty of the instrument in a column u[um]";
    }
}

/// Warns about measurement files without the directions of an axis that moves in them, beside files with
/// them.
void compare_directions(const model::Machine& machine, const std::vector<std::string>& bytes,
                        std::vector<LintedFile>& files) {
  std::vector<std::size_t> usable;
  std::vector<model::Measurement> rows;
  for (std::size_t i = 0; i < files.size(); ++i)
    if (files[i].kind == LintedKind::kMeasurement && files[i].usable) {
      usable.push_back(i);
      rows.push_back(model::parse_measurement(bytes[i], files[i].file, machine));
    }
  for (std::size_t axis = 0; axis < machine.axes.size(); ++axis) {
    const auto has = [&](const model::Measurement& m) { return (m.states.direction[axis] != 0).any(); };
    const auto with = std::find_if(rows.begin(), rows.end(), has);
    if (with == rows.end()) continue;
    const std::string sense = format::axis_column(format::AxisQuantity::kSense, machine.axes[axis].name);
    for (std::size_t k = 0; k < rows.size(); ++k) {
      const model::Column& position = rows[k].states.axis[axis];
      if (has(rows[k]) || position.minCoeff() == position.maxCoeff()) continue;
      LintFinding warning;
      warning.file = files[usable[k]].file;
      warning.weight = LintWeight::kWarning;
      warning.word = sense;
      warning.what = fmt::format(
          "no {} in the file, and {} has it: the model predicts no reversal error (backlash) for these rows, "
          "so that they contradict one",
          sense, text::printable(files[usable[static_cast<std::size_t>(with - rows.begin())]].file));
      warning.meaning =
          "if the rows are in the order of the measurement, import the file again with the directions of the "
          "motion (option --directions from-order of vernier import)";
      files[usable[k]].findings.push_back(std::move(warning));
    }
  }
}

/// Warns about rows at one pose whose points cannot both be right.
void look_for_contradictions(const model::Machine& machine, const std::vector<std::string>& bytes,
                             std::vector<LintedFile>& files) {
  for (std::size_t i = 0; i < files.size(); ++i) {
    if (files[i].kind != LintedKind::kMeasurement || !files[i].usable) continue;
    const model::Measurement m = model::parse_measurement(bytes[i], files[i].file, machine);
    const auto rows = fit::contradicting_rows(m);
    if (rows.empty()) continue;
    LintFinding warning;
    warning.file = files[i].file;
    warning.line = m.line[rows.front().row];
    warning.weight = LintWeight::kWarning;
    warning.what = fit::contradiction_in_words(m, rows);
    files[i].findings.push_back(std::move(warning));
  }
}

}  // namespace

std::vector<LintedFile> lint_files(const std::vector<std::string>& paths) {
  std::vector<std::string> bytes;
  bytes.reserve(paths.size());
  for (const std::string& path : paths) bytes.push_back(text::read_file(path));
  return lint_contents(paths, bytes);
}

std::vector<LintedFile> lint_contents(const std::vector<std::string>& names,
                                      const std::vector<std::string>& bytes) {
  std::vector<LintedFile> list;
  std::optional<model::Machine> machine;
  for (std::size_t i = 0; i < names.size(); ++i) {
    list.push_back({names[i], linted_kind_of(bytes[i], names[i]), true, {}});
    if (list.back().kind != LintedKind::kMachine) continue;
    MachineLint result = lint_machine(bytes[i], names[i]);
    list.back().findings = std::move(result.findings);
    if (!machine) machine = std::move(result.machine);
  }
  for (std::size_t i = 0; i < list.size(); ++i) {
    LintedFile& one = list[i];
    if (one.kind != LintedKind::kMachine)
      one.findings = lint_measurement(bytes[i], one.file, machine ? &*machine : nullptr);
    one.usable = std::none_of(one.findings.begin(), one.findings.end(), [](const LintFinding& finding) {
      return finding.weight == LintWeight::kError;
    });
  }
  if (!machine || !machine->instrument) compare_uncertainties(list);
  if (machine) compare_directions(*machine, bytes, list);
  if (machine) look_for_contradictions(*machine, bytes, list);
  return list;
}

}  // namespace vernier::lint
