// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/lint/lint.h"

#include <fmt/format.h>

#include <algorithm>
#include <map>

#include "tools/fit/noise/contradicting_rows.h"
#include "tools/format/columns.h"
#include "tools/lint/machine_lint.h"
#include "tools/lint/measurement_lint.h"
#include "tools/lint/measurement_meaning.h"
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

/// The measurement files without errors, as a fit of the machine reads them.
struct UsableFiles {
  std::vector<std::size_t> at;  // index of each file
  std::vector<model::Measurement> rows;
};

UsableFiles usable_files(const model::Machine& machine, const std::vector<std::string>& bytes,
                         const std::vector<LintedFile>& files) {
  UsableFiles usable;
  for (std::size_t i = 0; i < files.size(); ++i)
    if (files[i].kind == LintedKind::kMeasurement && files[i].usable) {
      usable.at.push_back(i);
      usable.rows.push_back(model::parse_measurement(bytes[i], files[i].file, machine));
    }
  return usable;
}

/// Removes the findings about a word that have this meaning.
void forget(const UsableFiles& usable, const std::string& word, const char* meaning,
            std::vector<LintedFile>& files) {
  for (const std::size_t file : usable.at)
    std::erase_if(files[file].findings, [&](const LintFinding& finding) {
      return finding.word == word && finding.meaning == meaning;
    });
}

/// An axis that stands in one file and moves in another one is measured: the warning about it is removed.
void forgive_axes_that_others_move(const model::Machine& machine, const UsableFiles& usable,
                                   std::vector<LintedFile>& files) {
  for (std::size_t axis = 0; axis < machine.axes.size(); ++axis) {
    const bool moves = std::any_of(usable.rows.begin(), usable.rows.end(), [&](const model::Measurement& m) {
      return m.states.axis[axis].maxCoeff() > m.states.axis[axis].minCoeff();
    });
    if (moves) forget(usable, machine.axes[axis].name, kAxisStands, files);
  }
}

/// A quantity that another file has determines its term there: the warning about it is removed.
void forgive_quantities_that_others_have(const UsableFiles& usable, std::vector<LintedFile>& files) {
  std::map<std::string, std::size_t> lacking;  // number of files without the quantity
  for (const std::size_t file : usable.at)
    for (const LintFinding& finding : files[file].findings)
      if (finding.meaning == kRecordOrHold) ++lacking[finding.word];
  for (const auto& [word, count] : lacking)
    if (count < usable.at.size()) forget(usable, word, kRecordOrHold, files);
}

/// Warns about measurement files without the directions of an axis that moves in them, beside files with
/// them.
void compare_directions(const model::Machine& machine, const UsableFiles& usable,
                        std::vector<LintedFile>& files) {
  const std::vector<model::Measurement>& rows = usable.rows;
  for (std::size_t axis = 0; axis < machine.axes.size(); ++axis) {
    const auto has = [&](const model::Measurement& m) { return (m.states.direction[axis] != 0).any(); };
    const auto with = std::find_if(rows.begin(), rows.end(), has);
    if (with == rows.end()) continue;
    const std::string sense = format::axis_column(format::AxisQuantity::kSense, machine.axes[axis].name);
    for (std::size_t k = 0; k < rows.size(); ++k) {
      const model::Column& position = rows[k].states.axis[axis];
      if (has(rows[k]) || position.minCoeff() == position.maxCoeff()) continue;
      LintFinding warning;
      warning.file = files[usable.at[k]].file;
      warning.weight = LintWeight::kWarning;
      warning.word = sense;
      warning.what = fmt::format(
          "no {} in the file, and {} has it: the model predicts no reversal error (backlash) for these rows, "
          "so that they contradict one",
          sense, text::printable(files[usable.at[static_cast<std::size_t>(with - rows.begin())]].file));
      warning.meaning =
          "if the rows are in the order of the measurement, import the file again with the directions of the "
          "motion (option --directions from-order of vernier import)";
      files[usable.at[k]].findings.push_back(std::move(warning));
    }
  }
}

/// Warns about rows at one pose whose points cannot both be right.
void look_for_contradictions(const UsableFiles& usable, std::vector<LintedFile>& files) {
  for (std::size_t k = 0; k < usable.at.size(); ++k) {
    const model::Measurement& m = usable.rows[k];
    const auto rows = fit::contradicting_rows(m);
    if (rows.empty()) continue;
    LintedFile& file = files[usable.at[k]];
    LintFinding warning;
    warning.file = file.file;
    warning.line = m.line[rows.front().row];
    warning.weight = LintWeight::kWarning;
    warning.what = fit::contradiction_in_words(m, rows);
    file.findings.push_back(std::move(warning));
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
  if (!machine) return list;
  const UsableFiles usable = usable_files(*machine, bytes, list);
  forgive_axes_that_others_move(*machine, usable, list);
  forgive_quantities_that_others_have(usable, list);
  compare_directions(*machine, usable, list);
  look_for_contradictions(usable, list);
  return list;
}

}  // namespace vernier::lint
