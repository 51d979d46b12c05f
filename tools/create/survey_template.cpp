// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/create/survey_template.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "tools/create/machine_plan.h"
#include "tools/model/work_poses.h"
#include "tools/sheet/workbook_writer.h"
#include "tools/text/numbers.h"
#include "tools/text/words.h"

namespace vernier::create {
namespace {

struct ReadingColumns {
  const char* header;
  const char* remark;
};

ReadingColumns columns_of(Reading reading) {
  switch (reading) {
    case Reading::kPoint:
      return {"x[mm],y[mm],z[mm]",
              "# x y z         what the instrument read: the tool point in its own frame. One or two of the "
              "three will do;\n"
              "#               take the columns of the others away or leave their cells empty.\n"};
    case Reading::kLength:
      return {"length[mm],cx[mm],cy[mm],cz[mm]",
              "# length        distance of the tool point from a fixed centre, as the bar read it (its full "
              "length).\n"
              "# cx cy cz      that centre, in the measuring frame.\n"};
    case Reading::kTouch:
      return {
          "d[mm],nx,ny,nz,px[mm],py[mm],pz[mm]",
          "# d             reading along the normal: how far the tool point was from the nominal point, out "
          "of the\n"
          "#               material positive.\n"
          "# nx ny nz      that normal, a unit vector in workpiece coordinates (dial gauge along X: 1 0 0).\n"
          "# px py pz      the nominal point, workpiece coordinates.\n"};
    case Reading::kPose:
      return {"x[mm],y[mm],z[mm],rx[deg],ry[deg],rz[deg]",
              "# x y z         the tool point in the instrument's frame.\n"
              "# rx ry rz      its rotation there, as a rotation vector.\n"};
  }
  return {"", ""};
}

/// The rows: positions of all axes, the sense of the axis that moves alone, run and role.
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
    text_ += empty_ + run + "," + (check ? "check" : "fit") + "\n";
  }

  /// One axis over its travel and back, the others in the middle.
  void alone(std::size_t axis) {
    const model::Axis& moving = machine_.axes[axis];
    std::vector<double> stations = round_stations(range_[axis][0], range_[axis][1], moving.rotary);
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

std::string remarks(const model::Machine& machine, Reading reading) {
  std::string axes;
  for (const model::Axis& axis : machine.axes) axes += axis.name + " ";
  axes.resize(std::max<std::size_t>(14, axes.size()), ' ');
  return "# Survey of the machine \"" + machine.name +
         "\". Fill in the empty cells; a row that you could not measure may stay empty or go.\n"
         "# Decimal point, comma between columns, one row a reading. A unit stands in the brackets of the "
         "header and may be\n"
         "# another one (um, in, arcsec, ...). Positions may be changed to what the machine can reach; the "
         "more they differ\n"
         "# in all axes at once, the more errors can be told apart.\n#\n"
         "# " +
         axes +
         "where the machine was sent: positions as the control shows them.\n"
         "# dir...        the sense of the last motion of an axis, 1 or -1: come from that side. 0: it does "
         "not matter.\n" +
         columns_of(reading).remark +
         "# run           which pass it was. Stood the instrument elsewhere in some run, give the machine "
         "file a BaseShift\n"
         "#               with that run=\"label\".\n"
         "# role          fit, or check: rows that a fit does not see and that judge it.\n"
         "# More columns are welcome, in any place: u[mm] standard uncertainty of the reading, t[s] time, "
         "feed[mm/min],\n"
         "# T_name[degC] a temperature, load[%], whatever was logged; `vernier diagnose` asks them what they "
         "explain.\n"
         "# `vernier lint` says what is wrong with the file, `vernier import table` reads a spreadsheet "
         "instead.\n";
}

}  // namespace

Reading reading_of(const std::string& name) {
  if (name == "point") return Reading::kPoint;
  if (name == "length") return Reading::kLength;
  if (name == "touch") return Reading::kTouch;
  if (name == "pose") return Reading::kPose;
  throw text::InputError("\"" + name + "\": a reading is point, length, touch or pose");
}

std::string survey_template(const model::Machine& machine, Reading reading) {
  const std::string header = columns_of(reading).header;
  std::string text = remarks(machine, reading);
  for (const model::Axis& axis : machine.axes) text += axis.name + (axis.rotary ? "[deg]," : "[mm],");
  for (const model::Axis& axis : machine.axes) text += "dir" + axis.name + ",";
  text += header + ",run,role\n";
  const std::string empty(static_cast<std::size_t>(std::count(header.begin(), header.end(), ',')) + 1, ',');
  return text + Rows(machine, empty).text();
}

std::string survey_workbook(const std::string& survey) {
  sheet::SheetToWrite rows{"Survey", {}}, remarks{"Read me", {{"How to fill it in"}}};
  for (const std::string& line : text::parts_of(survey, '\n')) {
    // How a CSV is written concerns nobody here.
    if (line.starts_with("# Decimal point, comma")) continue;
    if (line.starts_with("#"))
      remarks.rows.push_back({line.substr(line.starts_with("# ") ? 2 : 1)});
    else if (!line.empty())
      rows.rows.push_back(text::parts_of(line, ','));
  }
  return sheet::workbook_of({rows, remarks});
}

}  // namespace vernier::create
