// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/plan/sheets.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <set>
#include <vector>

#include "tools/format/columns.h"
#include "tools/plan/offers.h"
#include "tools/text/numbers.h"

namespace vernier::plan {
namespace {

/// A feed for approaches if none is recorded, mm/min, and the share of the range for an approach.
constexpr double kApproachFeed = 1000, kApproachShare = 0.05;

struct SheetColumn {
  std::string header;
  std::function<std::string(std::size_t)> cell;
};

/// Six significant digits: far finer than any axis is set or read.
std::string cell_text(double value) { return text::fixed_text(std::stod(fmt::format("{:.9g}", value)), 9); }

bool any_nonzero(const model::Column& column) { return (column != 0).any(); }

class Sheet {
 public:
  explicit Sheet(const Plan& plan) : rows_(plan.rows) {
    drivers_ = drivers_of(std::vector<const FittedHypothesis*>{&plan.a, &plan.b});
    const std::vector<model::Axis>& axes = plan.machine.axes;
    for (std::size_t a = 0; a < axes.size(); ++a)
      add(format::axis_heading(format::AxisQuantity::kPosition, axes[a].name, axes[a].rotary),
          rows_.states.axis[a]);
    for (std::size_t a = 0; a < axes.size(); ++a) motion(a, axes[a]);
    namespace names = format::columns;
    if (any_nonzero(rows_.states.feed)) add(format::heading(names::kFeed), rows_.states.feed);
    if (any_nonzero(rows_.states.curvature)) add(format::heading(names::kCurvature), rows_.states.curvature);
    if (rows_.has_recorded(names::kTime)) add(format::heading(names::kTime), rows_.states.time);
    for (std::size_t i = 0; i < plan.machine.inputs.size(); ++i)
      add(format::heading(plan.machine.inputs[i].name, plan.machine.inputs[i].unit), rows_.states.input[i]);
    for (const model::CandidateInput& candidate : rows_.candidates)
      if (drivers_.inputs.contains(candidate.name))
        add(format::heading(candidate.name, candidate.unit), candidate.value);
  }

  std::vector<SheetColumn> columns;

  void add_readings() {
    std::set<model::ObservationKind> kinds;
    std::set<format::ReadingForm> forms;
    for (const model::Observation& o : rows_.observations) {
      kinds.insert(o.kind);
      forms.insert(format::form_of(o.kind));
    }
    for (const format::ColumnGroup& group : format::column_groups()) {
      if (group.use != format::ColumnUse::kReading || !forms.contains(group.form)) continue;
      for (const char* const name : group.list()) {
        const auto kind = format::kind_named(name);
        if (format::entry_of(group.form).together || (kind && kinds.contains(*kind)))
          columns.push_back({format::heading(name), [](std::size_t) { return std::string(); }});
      }
    }
    add_things();
    if (forms.contains(format::ReadingForm::kLength)) add_points(format::columns::kCentre, rows_.centre);
    if (forms.contains(format::ReadingForm::kDeviation)) {
      add_points(format::columns::kNominalPoint, rows_.nominal_point);
      for (std::size_t i = 0; i < 3; ++i) add(format::columns::kNormal[i], rows_.states.normal[i]);
    }
    if (forms.contains(format::ReadingForm::kDistance))
      columns.push_back({format::columns::kFrom, [this](std::size_t row) {
                           const std::size_t end = rows_.other_end[row];
                           return end == model::kNoRow ? std::string() : std::to_string(end + 1);
                         }});
    if (any_nonzero(rows_.uncertainty))
      add(format::heading(format::columns::kUncertainty), rows_.uncertainty);
    columns.push_back({format::columns::kRun, [](std::size_t) { return std::string(kPlanRun); }});
  }

 private:
  /// The columns `same` and `on` name what a row meets: they are given, not filled in.
  void add_things() {
    for (SheetColumn& column : columns)
      for (const auto& [name, form] : {std::pair(format::columns::kSame, format::ReadingForm::kSame),
                                       std::pair(format::columns::kOn, format::ReadingForm::kOn)})
        if (column.header == name)
          column.cell = [this, wanted = form](std::size_t row) {
            const std::size_t thing = rows_.thing_of(row);
            const bool met = thing != model::kNoThing && rows_.things[thing].form == wanted;
            return met ? rows_.things[thing].label : std::string();
          };
  }

  void add(const std::string& header, const model::Column& column) {
    columns.push_back(
        {header, [&column](std::size_t row) { return cell_text(column[static_cast<Eigen::Index>(row)]); }});
  }

  void add_points(const std::array<const char*, 3>& names, const Eigen::Matrix3Xd& points) {
    for (Eigen::Index i = 0; i < 3; ++i)
      columns.push_back({format::heading(names[static_cast<std::size_t>(i)]), [&points, i](std::size_t row) {
                           return cell_text(points(i, static_cast<Eigen::Index>(row)));
                         }});
  }

  void motion(std::size_t a, const model::Axis& axis) {
    using format::AxisQuantity;
    const auto column = [&](AxisQuantity quantity, const model::Column& values) {
      add(format::axis_heading(quantity, axis.name, axis.rotary), values);
    };
    if (any_nonzero(rows_.states.direction[a])) column(AxisQuantity::kSense, rows_.states.direction[a]);
    if (any_nonzero(rows_.states.velocity[a])) column(AxisQuantity::kSpeed, rows_.states.velocity[a]);
    if (any_nonzero(rows_.states.acceleration[a]))
      column(AxisQuantity::kAcceleration, rows_.states.acceleration[a]);
    if ((rows_.states.since[a] < model::kLongWay).all()) column(AxisQuantity::kSince, rows_.states.since[a]);
  }

  const model::Measurement& rows_;
  Drivers drivers_;
};

/// Writes one row's moves.
class MoveWriter {
 public:
  MoveWriter(const model::Machine& machine, const model::States& states, std::string& out)
      : machine_(machine), states_(states), out_(out) {}

  void write(std::size_t row) {
    const auto at = static_cast<Eigen::Index>(row);
    const model::States& s = states_;
    std::vector<double> from, to, through;
    double speed = 0;
    for (std::size_t a = 0; a < machine_.axes.size(); ++a) {
      const double q = s.axis[a][at], way = way_of(a, at);
      const double v = s.velocity[a][at];
      speed += v * v;
      from.push_back(inside(a, q - s.direction[a][at] * way));
      to.push_back(q);
    }
    speed = std::sqrt(speed);
    for (std::size_t a = 0; a < to.size() && speed > 0; ++a) {
      const double along = s.velocity[a][at] / speed * run_up(at);
      from[a] = s.velocity[a][at] != 0 ? inside(a, to[a] - along) : from[a];
      through.push_back(inside(a, to[a] + along));
    }
    const double feed = s.feed[at] > 0 ? s.feed[at] : speed > 0 ? 60 * speed : kApproachFeed;
    out_ += fmt::format("G1{} F{}\n", words(from), cell_text(std::max(feed, kApproachFeed)));
    if (speed > 0 && turned(from, to, at)) {
      // The axes at rest first come from their required side.
      std::vector<double> ready = to;
      for (std::size_t a = 0; a < to.size(); ++a)
        if (s.velocity[a][at] != 0) ready[a] = from[a];
      out_ += fmt::format("G1{} F{}\n", words(ready), cell_text(kApproachFeed));
    }
    out_ += fmt::format("G1{} F{} ; point {}{}\n", words(to), cell_text(feed), row + 1,
                        speed > 0 ? ": read in passing" : "");
    if (speed > 0)
      out_ += fmt::format("G1{} F{}\n", words(through), cell_text(feed));
    else
      out_ += "G4 P2 ; read\n";
  }

 private:
  double inside(std::size_t a, double q) const {
    const model::Axis& axis = machine_.axes[a];
    if (axis.rollover) return q;
    return std::clamp(q, axis.min.value_or(-1e300), axis.max.value_or(1e300));
  }

  double span(std::size_t a) const {
    const model::Axis& axis = machine_.axes[a];
    const model::Column& q = states_.axis[a];
    return axis.min && axis.max ? *axis.max - *axis.min : q.maxCoeff() - q.minCoeff();
  }

  double way_of(std::size_t a, Eigen::Index at) const {
    const double since = states_.since[a][at];
    return since < model::kLongWay ? since : kApproachShare * span(a);
  }

  /// Way before and behind a point that is passed: the least that any moving axis is given.
  double run_up(Eigen::Index at) const {
    double way = 1e300;
    for (std::size_t a = 0; a < machine_.axes.size(); ++a)
      if (states_.velocity[a][at] != 0) way = std::min(way, way_of(a, at));
    return way;
  }

  bool turned(const std::vector<double>& from, const std::vector<double>& to, Eigen::Index at) const {
    for (std::size_t a = 0; a < to.size(); ++a)
      if (states_.velocity[a][at] == 0 && from[a] != to[a]) return true;
    return false;
  }

  std::string words(const std::vector<double>& q) const {
    std::string text;
    for (std::size_t a = 0; a < q.size(); ++a)
      text += " " + machine_.axes[a].name + fmt::format("{:.4f}", q[a]);
    return text;
  }

  const model::Machine& machine_;
  const model::States& states_;
  std::string& out_;
};

/// Settings that a person makes before a row: inputs of the two effects.
std::string settings(const Plan& plan, const Drivers& drivers, std::size_t row) {
  std::string text;
  const auto add = [&](const std::string& name, const std::string& unit, double value) {
    if (drivers.inputs.contains(name))
      text += fmt::format("{}{} = {:.4g}{}", text.empty() ? "" : ", ", name, value,
                          unit.empty() ? "" : " " + unit);
  };
  const auto at = static_cast<Eigen::Index>(row);
  for (std::size_t i = 0; i < plan.machine.inputs.size(); ++i)
    add(plan.machine.inputs[i].name, plan.machine.inputs[i].unit, plan.rows.states.input[i][at]);
  for (const model::CandidateInput& candidate : plan.rows.candidates)
    add(candidate.name, candidate.unit, candidate.value[at]);
  return text;
}

}  // namespace

std::string plan_csv(const Plan& plan) {
  Sheet sheet(plan);
  sheet.add_readings();
  std::string text = "# " + plan.sentence + "\n";
  if (!plan.rows.correction.empty())
    text += fmt::format(
        "# Measure with the correction off (or give the active correction in columns {} and so on)\n",
        format::axis_column(format::AxisQuantity::kCorrection, plan.machine.axes.front().name));
  for (std::size_t i = 0; i < sheet.columns.size(); ++i) text += (i ? "," : "") + sheet.columns[i].header;
  text += "\n";
  for (std::size_t row = 0; row < plan.rows.rows(); ++row) {
    for (std::size_t i = 0; i < sheet.columns.size(); ++i)
      text += (i ? "," : "") + sheet.columns[i].cell(row);
    text += "\n";
  }
  return text;
}

std::string plan_gcode(const Plan& plan) {
  std::string text = "; " + plan.sentence + "\n; check clearances before running\nG21 G90 G94\n";
  const Drivers drivers = drivers_of(std::vector<const FittedHypothesis*>{&plan.a, &plan.b});
  const bool timed = drivers.kinds.contains(model::SymbolKind::kTime);
  MoveWriter writer(plan.machine, plan.rows.states, text);
  const bool tethered =
      std::any_of(plan.rows.observations.begin(), plan.rows.observations.end(),
                  [](const model::Observation& o) { return o.kind == model::ObservationKind::kLength; });
  std::string before;
  double time = -1e300, step = 0;
  for (std::size_t row = 0; row < plan.rows.rows(); ++row) {
    const std::string now = settings(plan, drivers, row);
    const double t = plan.rows.states.time[static_cast<Eigen::Index>(row)];
    if (now != before)
      text += fmt::format("M0 ; set {}\n", now);
    else if (timed && t - time > 2 * step + 1)
      text += fmt::format("M0 ; wait until t = {:.0f} s\n", t);
    if (row > 0) step = t - time;
    before = now;
    time = t;
    // A bar between tool and centre bears its short stroke only, not the straight way to the next point.
    if (tethered) text += "M0 ; take the bar off before this move, put it on again at its end\n";
    writer.write(row);
  }
  return text + "M30\n";
}

std::string poses_gcode(const model::Machine& machine, const model::States& states,
                        const std::string& remark) {
  std::string text = "; " + remark + "\n; check clearances before running\nG21 G90 G94\n";
  MoveWriter writer(machine, states, text);
  for (std::size_t row = 0; row < states.count; ++row) writer.write(row);
  return text + "M30\n";
}

std::string plan_table(const Plan& plan) {
  const Sheet sheet(plan);
  std::string text;
  for (const SheetColumn& column : sheet.columns) text += fmt::format("{:>14}", column.header);
  text += "\n";
  for (std::size_t row = 0; row < plan.rows.rows(); ++row) {
    for (const SheetColumn& column : sheet.columns)
      text += fmt::format("{:>14}", fmt::format("{:.6g}", std::stod(column.cell(row))));
    text += "\n";
  }
  return text;
}

}  // namespace vernier::plan
