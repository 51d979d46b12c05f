// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/results/detail.h"
#include "tools/format/columns.h"
#include "tools/results/ball_bar_table.h"

#include <algorithm>
#include <cmath>
#include <set>
#include <utility>

#include "tools/maths/factors.h"
#include "tools/results/circles.h"
#include "tools/text/optional_json.h"

namespace vernier::results {
namespace {

using nlohmann::ordered_json;

constexpr std::size_t kWorstRows = 25;  // that a person looks up

double in_report_unit(model::ObservationKind kind, double value) {
  return value * (model::is_rotation(kind) ? maths::kUradPerDeg : maths::kUmPerMm);
}

/// Six significant digits are more than a plot shows and a third of the size.
ordered_json compact(const model::Column& column) {
  ordered_json list = ordered_json::array();
  for (const double value : column) {
    if (!std::isfinite(value)) {
      list.push_back(nullptr);
      continue;
    }
    const double size = value == 0 ? 1 : std::pow(10, 6 - std::ceil(std::log10(std::abs(value))));
    list.push_back(std::round(value * size) / size);
  }
  return list;
}

void add_columns(ordered_json& detail, const model::Machine& machine, const model::Measurement& m) {
  detail["columns"] = ordered_json::array();
  detail["column_data"] = ordered_json::array();
  each_column(
      machine, m,
      [&](const std::string& name, const std::string& unit, const char* kind, const model::Column& data) {
        detail["columns"].push_back({{"name", name}, {"unit", unit}, {"kind", kind}});
        detail["column_data"].push_back(compact(data));
      });
}

void add_observations(ordered_json& detail, const model::Measurement& m, const Eigen::VectorXd& residual) {
  ordered_json kinds = ordered_json::array(), units = kinds, row = kinds, kind = kinds, scaled = kinds,
               measured = kinds, model = kinds;
  std::array<int, format::kReadingKindCount> slot;
  slot.fill(-1);
  for (std::size_t i = 0; i < m.observations.size(); ++i) {
    const model::Observation& o = m.observations[i];
    int& at = slot[static_cast<std::size_t>(o.kind)];
    if (at < 0) {
      at = static_cast<int>(kinds.size());
      kinds.push_back(format::name_of(o.kind));
      units.push_back(format::report_unit_of(o.kind));
    }
    const double r = residual[static_cast<Eigen::Index>(i)];
    row.push_back(o.row);
    kind.push_back(at);
    scaled.push_back(std::round(in_report_unit(o.kind, r) * 1e3) / 1e3);
    measured.push_back(std::round(o.value * 1e6) / 1e6);
    model.push_back(std::round((o.value - r) * 1e6) / 1e6);
  }
  detail["observations"] = {{"kind", kinds},      {"unit", units},      {"row", row},
                            {"kind_index", kind}, {"residual", scaled}, {"measured", measured},
                            {"model", model}};
}

void add_worst(ordered_json& detail, const model::Measurement& m, const Eigen::VectorXd& residual) {
  std::vector<std::size_t> order(m.observations.size());
  for (std::size_t i = 0; i < order.size(); ++i) order[i] = i;
  const auto size = [&](std::size_t i) {
    return std::abs(in_report_unit(m.observations[i].kind, residual[static_cast<Eigen::Index>(i)]));
  };
  const std::size_t count = std::min(kWorstRows, order.size());
  std::partial_sort(order.begin(), order.begin() + static_cast<std::ptrdiff_t>(count), order.end(),
                    [&](std::size_t a, std::size_t b) { return size(a) > size(b); });
  detail["worst"] = ordered_json::array();
  for (std::size_t k = 0; k < count; ++k) {
    const model::Observation& o = m.observations[order[k]];
    detail["worst"].push_back(
        {{"row", o.row},
         {"file", m.files[m.file[o.row]]},
         {"line", m.line[o.row]},
         {"run", m.states.run_names[m.states.run[o.row]]},
         {"role", m.check[o.row] != 0 ? "check" : "fit"},
         {"kind", format::name_of(o.kind)},
         {"unit", format::report_unit_of(o.kind)},
         {"residual", in_report_unit(o.kind, residual[static_cast<Eigen::Index>(order[k])])}});
  }
}

ordered_json hysteresis(const std::optional<importer::Hysteresis>& value, bool angle) {
  return value ? ordered_json(angle ? value->deg : value->um) : ordered_json(nullptr);
}

/// The ISO 230-4 numbers of a circle, without the curves.
ordered_json circle_summary(const Circle& circle, const model::Measurement& m) {
  const importer::CircularResult result = analyse(circle, m);
  ordered_json json = {
      {"plane", {std::string(1, "XYZ"[circle.plane[0]]), std::string(1, "XYZ"[circle.plane[1]])}},
      {"centre", circle.centre_mm},
      {"nominal_radius_mm", circle.nominal_radius_mm},
      {"runs", ordered_json::array()}};
  for (const importer::CircularPassResult& pass : result.passes)
    json["runs"].push_back({{"label", pass.label},
                            {"direction", pass.direction},
                            {"centre_mm", {pass.centre_a_mm, pass.centre_b_mm}},
                            {"radius_mm", pass.radius_mm},
                            {"feed_mm_min", text::or_null(pass.feed_mm_min)},
                            {"circular_deviation_um", pass.circular_deviation_um},
                            {"max_radial_um", pass.max_radial_um},
                            {"max_radial_deg", pass.max_deg},
                            {"min_radial_um", pass.min_radial_um},
                            {"min_radial_deg", pass.min_deg}});
  json["bidirectional_um"] = text::or_null(result.bidirectional_um);
  json["hysteresis_um"] = hysteresis(result.hysteresis, false);
  json["hysteresis_deg"] = hysteresis(result.hysteresis, true);
  json["hysteresis_by_angle_um"] = hysteresis(result.hysteresis_by_angle, false);
  json["hysteresis_by_angle_deg"] = hysteresis(result.hysteresis_by_angle, true);
  json["diagnostics"] = ball_bar_table(circle, m);
  return json;
}

void add_curves(ordered_json& json, const Circle& circle, const model::Measurement& m,
                const Eigen::VectorXd& residual) {
  for (std::size_t k = 0; k < circle.runs.size(); ++k) {
    const CircleRun& run = circle.runs[k];
    ordered_json angle = ordered_json::array(), measured = angle, model = angle, check = angle;
    for (std::size_t i = 0; i < run.observation.size(); ++i) {
      const model::Observation& o = m.observations[run.observation[i]];
      const double deviation = maths::kUmPerMm * (o.value - circle.nominal_radius_mm);
      const double r = maths::kUmPerMm * residual[static_cast<Eigen::Index>(run.observation[i])];
      angle.push_back(std::round(run.angle_deg[i] * 1e3) / 1e3);
      measured.push_back(std::round(deviation * 100) / 100);
      model.push_back(std::round((deviation - r) * 100) / 100);
      check.push_back(m.check[o.row] != 0 ? 1 : 0);
    }
    json["runs"][k]["angle_deg"] = angle;
    json["runs"][k]["measured_um"] = measured;
    json["runs"][k]["model_um"] = model;
    json["runs"][k]["check"] = check;
  }
}

/// Circles with at least three fit rows in every run; the others have no numbers of the standard.
std::vector<Circle> circles_with_numbers(const model::Machine& machine, const model::Measurement& m) {
  std::vector<Circle> circles = find_circles(machine, m);
  std::erase_if(circles, [&](const Circle& circle) {
    return std::any_of(circle.runs.begin(), circle.runs.end(), [&](const CircleRun& run) {
      const auto fit_rows = std::count_if(run.observation.begin(), run.observation.end(),
                                          [&](std::size_t i) { return m.check[m.observations[i].row] == 0; });
      return fit_rows < 8;
    });
  });
  return circles;
}

}  // namespace

void each_column(const model::Machine& machine, const model::Measurement& m, const VisitColumn& visit) {
  const model::States& s = m.states;
  for (std::size_t i = 0; i < machine.axes.size(); ++i)
    visit(machine.axes[i].name, machine.axes[i].rotary ? "deg" : "mm", "axis", model::commanded(m, i));
  for (std::size_t i = 0; i < machine.axes.size(); ++i) {
    const std::string& axis = machine.axes[i].name;
    const auto motion = [&](format::AxisQuantity quantity, const char* kind, const model::Column& data) {
      const std::string name = format::axis_column(quantity, axis);
      if (m.has_recorded(name)) visit(name, format::unit_of(quantity, machine.axes[i].rotary), kind, data);
    };
    motion(format::AxisQuantity::kSense, "direction", s.direction[i]);
    motion(format::AxisQuantity::kSpeed, "motion", s.velocity[i]);
    motion(format::AxisQuantity::kAcceleration, "motion", s.acceleration[i]);
    motion(format::AxisQuantity::kSince, "motion", s.since[i]);
  }
  namespace columns = format::columns;
  const auto path = [&](const char* name, const char* kind, const model::Column& data) {
    if (m.has_recorded(name)) visit(name, format::column_unit(name), kind, data);
  };
  path(columns::kFeed, "motion", s.feed);
  path(columns::kCurvature, "motion", s.curvature);
  path(columns::kTime, "time", s.time);
  visit(columns::kVisit, format::column_unit(columns::kVisit), columns::kVisit, s.visit);
  for (std::size_t i = 0; i < machine.inputs.size(); ++i)
    visit(machine.inputs[i].name, machine.inputs[i].unit, "input", s.input[i]);
  for (const model::CandidateInput& candidate : m.candidates)
    visit(candidate.name, candidate.unit, "candidate", candidate.value);
}

ordered_json circular_detail(const model::Machine& machine, const model::Measurement& m,
                             const Eigen::VectorXd& residual, bool with_rows) {
  ordered_json list = ordered_json::array();
  for (const Circle& circle : circles_with_numbers(machine, m)) {
    list.push_back(circle_summary(circle, m));
    add_curves(list.back(), circle, m, residual);
    for (std::size_t k = 0; with_rows && k < circle.runs.size(); ++k) {
      list.back()["runs"][k]["row"] = ordered_json::array();
      for (const std::size_t i : circle.runs[k].observation)
        list.back()["runs"][k]["row"].push_back(m.observations[i].row);
    }
  }
  return list;
}

ordered_json circular_json(const model::Machine& machine, const model::Measurement& m) {
  ordered_json list = ordered_json::array();
  for (const Circle& circle : circles_with_numbers(machine, m)) list.push_back(circle_summary(circle, m));
  return list;
}

void add_detail(ordered_json& result, const model::Machine& machine, const model::Measurement& m,
                const Eigen::VectorXd& residual) {
  ordered_json detail;
  add_columns(detail, machine, m);
  detail["runs"] = m.states.run_names;
  detail["row_run"] = m.states.run;
  detail["row_check"] = ordered_json::array();
  for (const char check : m.check) detail["row_check"].push_back(check != 0 ? 1 : 0);
  detail["row_line"] = m.line;
  add_observations(detail, m, residual);
  detail["circular"] = circular_detail(machine, m, residual);
  add_worst(detail, m, residual);
  result["detail"] = std::move(detail);
}

namespace {

constexpr std::size_t kMostPictures = 3, kMostPoints = 4000;
constexpr double kLeastShare = 0.05;  // of the variance, from which on a column shows a pattern

/// One picture: the residuals of one kind of reading against a column.
ordered_json picture(const std::string& observation, const std::string& column, const std::string& unit,
                     const model::Column& x, const model::Measurement& m, const Eigen::VectorXd& before,
                     const Eigen::VectorXd& after) {
  std::vector<std::size_t> rows;
  for (std::size_t i = 0; i < m.observations.size(); ++i)
    if (format::name_of(m.observations[i].kind) == observation) rows.push_back(i);
  ordered_json json = {{"observation", observation},
                       {"unit", ""},
                       {"column", column},
                       {"column_unit", unit},
                       {"x", {}},
                       {"before", {}},
                       {"after", {}},
                       {"check", {}}};
  for (std::size_t k = 0; k < rows.size(); k += 1 + rows.size() / kMostPoints) {
    const model::Observation& o = m.observations[rows[k]];
    const auto at = static_cast<Eigen::Index>(rows[k]);
    json["unit"] = format::report_unit_of(o.kind);
    json["x"].push_back(x[static_cast<Eigen::Index>(o.row)]);
    json["before"].push_back(in_report_unit(o.kind, before[at]));
    json["after"].push_back(in_report_unit(o.kind, after[at]));
    json["check"].push_back(m.check[o.row]);
  }
  return json;
}

}  // namespace

ordered_json before_after_pictures(const ordered_json& findings, const model::Machine& machine,
                                   const model::Measurement& m, const Eigen::VectorXd& before,
                                   const Eigen::VectorXd& after) {
  ordered_json list = ordered_json::array();
  std::set<std::pair<std::string, std::string>> shown;
  const auto add = [&](const std::string& observation, const std::string& wanted) {
    if (list.size() >= kMostPictures || !shown.emplace(observation, wanted).second) return;
    each_column(machine, m,
                [&](const std::string& name, const std::string& unit, const char*, const model::Column& x) {
                  if (name == wanted) list.push_back(picture(observation, name, unit, x, m, before, after));
                });
  };
  for (const ordered_json& finding : findings)
    if (finding["column"].is_string() && finding["share_alone"].get<double>() >= kLeastShare)
      add(finding["observation"].get<std::string>(), finding["column"].get<std::string>());
  if (!list.empty()) return list;
  const model::Column row =
      model::Column::LinSpaced(static_cast<Eigen::Index>(m.rows()), 1, static_cast<double>(m.rows()));
  std::set<std::string> kinds;
  for (const model::Observation& o : m.observations)
    if (list.size() < kMostPictures && kinds.insert(format::name_of(o.kind)).second)
      list.push_back(picture(format::name_of(o.kind), "row", "", row, m, before, after));
  return list;
}

}  // namespace vernier::results
