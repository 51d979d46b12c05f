// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/effects/roles.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <pugixml.hpp>

#include "tools/effects/input_class.h"
#include "tools/effects/insertion.h"
#include "tools/format/columns.h"
#include "tools/format/row_counts.h"
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
  return fmt::format("      <{} unit=\"{}\" reference=\"{}\" role=\"{}\"/>\n", candidate.name,
                     text::escape_attribute(candidate.unit),
                     text::number_text(usual_reference(input, mean_of_cells(candidate))),
                     model::kInputRoleNames[static_cast<std::size_t>(role)]);
}

/// Cells of an undeclared column in one file.
struct Cells {
  std::size_t rows = 0, empty = 0;
  std::size_t first_line = 0;  // line of the first empty cell

  bool is_absent() const { return rows > 0 && empty == rows; }
  bool is_unusable() const {
    constexpr double kMostEmpty = 0.2;  // of the rows: too many rows to exclude for one column
    return !is_absent() && static_cast<double>(empty) > kMostEmpty * static_cast<double>(rows);
  }
};

std::vector<Cells> cells_of(const model::CandidateInput& candidate, const model::Measurement& rows) {
  std::vector<Cells> files(rows.files.size());
  for (std::size_t row = 0; row < rows.rows(); ++row) {
    Cells& file = files[rows.file[row]];
    ++file.rows;
    if (std::isfinite(candidate.value[static_cast<Eigen::Index>(row)])) continue;
    if (file.empty++ == 0) file.first_line = rows.line[row];
  }
  return files;
}

/// What a file shows of an axis.
struct AxisOfFile {
  bool has_direction = false, moves = false;
};

std::vector<AxisOfFile> files_of_axis(const model::Measurement& rows, std::size_t axis) {
  std::vector<AxisOfFile> files(rows.files.size());
  std::vector<double> first(rows.files.size());
  std::vector<char> begun(rows.files.size(), 0);
  for (std::size_t row = 0; row < rows.rows(); ++row) {
    const auto at = static_cast<Eigen::Index>(row);
    const std::size_t file = rows.file[row];
    const double position = rows.states.axis[axis][at];
    if (begun[file] == 0) first[file] = position;
    begun[file] = 1;
    files[file].has_direction = files[file].has_direction || rows.states.direction[axis][at] != 0;
    files[file].moves = files[file].moves || position != first[file];
  }
  return files;
}

}  // namespace

double mean_of_cells(const model::CandidateInput& candidate) {
  double sum = 0, count = 0;
  for (const double value : candidate.value)
    if (std::isfinite(value)) sum += value, ++count;
  return count > 0 ? sum / count : 0;
}

/// True for a column that counts the rows of its table: no quantity that a machine can depend on, and no
/// other file is asked for it.
bool counts_rows(const model::CandidateInput& candidate) {
  return format::names_row_count(candidate.name, candidate.unit) &&
         std::all_of(candidate.value.begin(), candidate.value.end(), [](double value) {
           return !std::isfinite(value) || (value >= 0 && value == std::floor(value));
         });
}

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

std::vector<std::string> notes_of_missing_directions(const model::Machine& machine,
                                                     const model::Measurement& rows) {
  std::vector<std::vector<std::string>> missing(rows.files.size());
  for (std::size_t axis = 0; axis < machine.axes.size(); ++axis) {
    const std::vector<AxisOfFile> files = files_of_axis(rows, axis);
    if (std::none_of(files.begin(), files.end(), [](const AxisOfFile& one) { return one.has_direction; }))
      continue;
    for (std::size_t file = 0; file < files.size(); ++file)
      if (files[file].moves && !files[file].has_direction)
        missing[file].push_back(format::axis_column(format::AxisQuantity::kSense, machine.axes[axis].name));
  }
  std::vector<std::string> notes;
  for (std::size_t file = 0; file < missing.size(); ++file)
    if (!missing[file].empty())
      notes.push_back(fmt::format(
          "{} has no {}, and another file has. The model predicts no reversal error (backlash) for these "
          "rows, "
          "so that they contradict one. If the rows are in the order of the measurement, import the file "
          "again "
          "with the directions of the motion (option --directions from-order of vernier import)",
          rows.files[file], fmt::join(missing[file], ", ")));
  return notes;
}

std::vector<std::string> complete_columns(const model::Machine& machine, model::Measurement& rows) {
  std::vector<std::string> said;
  for (const std::string& note : notes_of_missing_directions(machine, rows)) said.push_back(note + ".");
  std::vector<char> excluded(rows.rows(), 0);
  const auto complete = [&](model::CandidateInput& candidate) {
    if (counts_rows(candidate)) return false;
    const std::vector<Cells> files = cells_of(candidate, rows);
    for (std::size_t file = 0; file < files.size(); ++file)
      if (files[file].is_unusable()) {
        said.push_back(
            fmt::format("The column {} is empty in {} of {} rows of {}: it is not used as an input.",
                        candidate.name, files[file].empty, files[file].rows, rows.files[file]));
        return false;
      }
    model::Input input;
    input.name = candidate.name;
    input.unit = candidate.unit;
    const double reference = usual_reference(input, mean_of_cells(candidate));
    std::vector<std::string> without;  // files
    for (std::size_t file = 0; file < files.size(); ++file) {
      if (files[file].is_absent())
        without.push_back(rows.files[file]);
      else if (files[file].empty > 0)
        said.push_back(fmt::format(
            "{} rows of {} with an empty cell in the column {} are excluded (the first in line {}).",
            files[file].empty, rows.files[file], candidate.name, files[file].first_line));
    }
    if (!without.empty())
      said.push_back(fmt::format(
          "No column {1} in {0}: these rows count as read at {2:.4g}{3}{4}. If this is not "
          "right, add the column "
          "(import table --set \"{1}{5}=VALUE\").",
          text::joined(without, ", "), candidate.name, reference, candidate.unit.empty() ? "" : " ",
          candidate.unit, candidate.unit.empty() ? "" : "[" + candidate.unit + "]"));
    for (std::size_t row = 0; row < rows.rows(); ++row) {
      double& value = candidate.value[static_cast<Eigen::Index>(row)];
      if (std::isfinite(value)) continue;
      if (files[rows.file[row]].is_absent())
        value = reference;
      else
        excluded[row] = 1;
    }
    return true;
  };
  std::erase_if(rows.candidates, [&](model::CandidateInput& candidate) { return !complete(candidate); });
  std::vector<std::size_t> keep;
  for (std::size_t row = 0; row < excluded.size(); ++row)
    if (excluded[row] == 0) keep.push_back(row);
  if (keep.size() == rows.rows()) return said;
  const std::size_t all = rows.excluded + rows.rows() - keep.size();
  rows = model::select_rows(rows, keep);
  rows.excluded = all;
  return said;
}

}  // namespace vernier::effects
