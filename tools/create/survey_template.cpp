// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/create/survey_template.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "tools/create/machine_plan.h"
#include "tools/format/columns.h"
#include "tools/model/chain/work_poses.h"
#include "tools/sheet/workbook_writer.h"
#include "tools/text/numbers.h"
#include "tools/text/words.h"

namespace vernier::create {
namespace {

/// Columns of a survey: its readings, and the columns that they need.
std::vector<const format::ColumnGroup*> groups_of(const format::SurveyReading& reading) {
  std::vector<const format::ColumnGroup*> groups;
  for (const format::ReadingForm form : reading.list()) groups.push_back(&format::reading_columns(form));
  for (const format::ReadingForm form : reading.list())
    for (const format::ColumnGroup* const beside : format::columns_beside(form)) groups.push_back(beside);
  return groups;
}

std::string header_of(const format::SurveyReading& reading) {
  std::string header;
  for (const format::ColumnGroup* const group : groups_of(reading))
    for (const char* const name : group->list())
      header += (header.empty() ? "" : ",") + format::heading(name, group->unit);
  return header;
}

/// "# x y z         their meaning", in lines of bounded length.
std::string remark_line(const std::string& names, const std::string& meaning) {
  constexpr std::size_t kIndent = 14, kWidth = 104;  // letters: of the names, of a line
  std::string text, line = "# " + names;
  line.resize(std::max(kIndent + 2, line.size() + 1), ' ');
  for (const std::string& word : text::words_in(meaning, " ")) {
    if (line.size() + 1 + word.size() > kWidth) {
      text += text::trimmed(line) + "\n";
      line = "#";
      line.resize(kIndent + 2, ' ');
    }
    line += (line.back() == ' ' ? "" : " ") + word;
  }
  return text + line + "\n";
}

std::string remarks_of(const format::SurveyReading& reading) {
  std::string text;
  for (const format::ColumnGroup* const group : groups_of(reading)) {
    // A remark on several columns of one form is written once.
    const bool some_will_do = group->use == format::ColumnUse::kReading && group->count > 1 &&
                              !format::entry_of(group->form).together;
    text += remark_line(
        format::words_of(group->list()),
        std::string(group->meaning) +
            (some_will_do
                 ? ". Remove the columns that the instrument does not read, or leave their cells empty."
                 : "."));
  }
  return text;
}

/// The rows: positions of all axes, the direction of the axis that moves alone, run and role.
class Rows {
 public:
  Rows(const model::Machine& machine, const std::string& empty) : machine_(machine), empty_(empty) {
    for (std::size_t a = 0; a < machine.axes.size(); ++a) {
      range_.push_back(model::work_range(machine, a).value_or(std::array{0.0, 0.0}));
      middle_.push_back(std::round((range_[a][0] + range_[a][1]) / 2 * 1000) / 1000);
    }
  }

  std::string text() {
    for (std::size_t a = 0; a < machine_.axes.size(); ++a) alone(a);
    spread();
    return text_;
  }

 private:
  void row(const std::vector<double>& at, std::size_t moving, int sense, const std::string& run, bool check) {
    for (const double position : at) text_ += text::number_text(position) + ",";
    for (std::size_t a = 0; a < at.size(); ++a) text_ += (a == moving ? std::to_string(sense) : "0") + ",";
    text_ += empty_ + run + "," + (check ? format::kCheckRole : format::kFitRole) + "\n";
  }

  /// The stations of the table of an axis that are in its range of work; round positions without a table.
  std::vector<double> stations_along(std::size_t axis) const {
    const auto [low, high] = range_[axis];
    std::vector<double> stations;
    for (const model::Table& table : machine_.tables)
      for (std::size_t k = 0; table.axis == axis && k < table.stations.size(); ++k)
        if (table.stations[k].loc >= low && table.stations[k].loc <= high)
          stations.push_back(table.stations[k].loc);
    return stations.size() > 1 ? stations : round_stations(low, high, machine_.axes[axis].rotary);
  }

  /// One axis over its travel and back, the others in the middle.
  void alone(std::size_t axis) {
    const model::Axis& moving = machine_.axes[axis];
    std::vector<double> stations = stations_along(axis);
    if (moving.rollover) stations.pop_back();  // one turn further on: the first again
    for (const int sense : {1, -1}) {
      for (const double station : stations) {
        std::vector<double> at = middle_;
        at[axis] = station;
        row(at, axis, sense, moving.name, false);
      }
      std::reverse(stations.begin(), stations.end());
    }
  }

  /// Poses all over the travel: what angles do at their levers shows only there.
  void spread() {
    const std::size_t count = 20 + 12 * machine_.axes.size();
    const model::WorkPoses poses = model::work_poses(machine_);
    for (std::size_t i = 0; i < count; ++i) {
      std::vector<double> at;
      for (std::size_t a = 0; a < machine_.axes.size(); ++a)
        at.push_back(std::round(poses.states.axis[a][static_cast<Eigen::Index>(i)] * 10) / 10);
      for (std::size_t a = 0; a < at.size(); ++a) at[a] = std::clamp(at[a], range_[a][0], range_[a][1]);
      // The first two are the corners: where tables end only a fit row helps.
      row(at, at.size(), 0, "volume", i >= 2 && i % 4 == 3);
    }
  }

  const model::Machine& machine_;
  const std::string& empty_;
  std::vector<std::array<double, 2>> range_;
  std::vector<double> middle_;
  std::string text_;
};

std::string remarks(const model::Machine& machine, const format::SurveyReading& reading) {
  std::string axes;
  for (const model::Axis& axis : machine.axes) axes += axis.name + " ";
  axes.resize(std::max<std::size_t>(14, axes.size()), ' ');
  return "# Survey of the machine \"" + machine.name +
         "\". Fill in the empty cells; if you could not measure a row, leave its cells empty or delete the "
         "row.\n"
         "# Use a decimal point, a comma between columns, and one row per pose. The header has the unit of "
         "each column in\n"
         "# brackets; you may change it (um, in, arcsec, ...). You may change the positions to positions "
         "that the machine can\n"
         "# reach; the more the positions of all axes differ, the more errors can be distinguished.\n"
         "#\n"
         "# " +
         axes +
         "commanded positions, as the control shows them.\n"
         "# dir...        approach direction: direction of the last motion of an axis, 1 or -1; 0: not "
         "known.\n" +
         remarks_of(reading) +
         "# run           label of the measuring run. If the instrument had another position in a run, write "
         "a BaseShift with\n"
         "#               run=\"LABEL\" of this run into the machine file.\n"
         "# role          fit, or check: held-out rows that test the fit.\n"
         "# You may add further columns, at any position: " +
         format::heading(format::columns::kUncertainty) + " standard uncertainty of the reading, " +
         format::heading(format::columns::kTime) + " time,\n# " + format::heading(format::columns::kFeed) +
         ", T_name[degC] a temperature, load[%], any logged quantity; `vernier diagnose` tests whether they\n"
         "# explain the residual.\n"
         "# `vernier lint` reports errors in the file, `vernier import table` reads a spreadsheet instead.\n";
}

}  // namespace

const format::SurveyReading& reading_of(const std::string& word) {
  const format::SurveyReading* const reading = format::survey_reading(word);
  if (reading == nullptr)
    throw text::InputError("\"" + word + "\": a reading is " + format::survey_words("or"));
  return *reading;
}

std::string survey_template(const model::Machine& machine, const format::SurveyReading& reading) {
  using format::AxisQuantity;
  for (const format::ReadingForm form : reading.list())
    if (form == format::ReadingForm::kInclination && !machine.workpiece.empty())
      throw text::InputError(
          fmt::format("--reading {}: an inclination can be read only on the tool of a machine whose "
                      "workpiece does not move",
                      reading.word));
  const std::string header = header_of(reading);
  std::string text = remarks(machine, reading);
  for (const AxisQuantity quantity : {AxisQuantity::kPosition, AxisQuantity::kSense})
    for (const model::Axis& axis : machine.axes)
      text += format::axis_heading(quantity, axis.name, axis.rotary) + ",";
  text += header + "," + format::columns::kRun + "," + format::columns::kRole + "\n";
  const std::string empty(static_cast<std::size_t>(std::count(header.begin(), header.end(), ',')) + 1, ',');
  return text + Rows(machine, empty).text();
}

std::string survey_workbook(const std::string& survey) {
  sheet::SheetToWrite rows{"Survey", {}}, remarks{"Read me", {{"How to fill it in"}}};
  for (const std::string& line : text::parts_of(survey, '\n')) {
    // The rules of a CSV file are applied elsewhere.
    if (line.starts_with("# Decimal point, comma")) continue;
    if (line.starts_with("#"))
      remarks.rows.push_back({line.substr(line.starts_with("# ") ? 2 : 1)});
    else if (!line.empty())
      rows.rows.push_back(text::parts_of(line, ','));
  }
  return sheet::workbook_of({rows, remarks});
}

}  // namespace vernier::create
