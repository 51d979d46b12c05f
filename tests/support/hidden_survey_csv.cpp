// SPDX-License-Identifier: GPL-3.0-or-later
#include "tests/support/hidden_survey_csv.h"

#include <fmt/format.h>

#include <cmath>

#include "tests/support/hidden_survey_inputs.h"
#include "tools/model/chain.h"
#include "tools/model/machine_reader.h"
#include "tools/text/numbers.h"

namespace vernier::support {

using namespace vernier::model;
using namespace vernier::text;
namespace {

std::string number(double value, int decimals) {
  const double step = std::pow(10, decimals);
  return number_text(std::round(value * step) / step + 0.0);
}

std::string header(const SurveyTable& t) {
  std::string text;
  for (const AxisPlace& a : t.geometry.axes) text += fmt::format("{}[{}],", a.name, a.rotary ? "deg" : "mm");
  for (const AxisPlace& a : t.geometry.axes)
    text += fmt::format("dir{0},since{0}[{1}],", a.name, a.rotary ? "deg" : "mm");
  if (t.options.manner != Manner::kAtRest)
    for (const AxisPlace& a : t.geometry.axes)
      text += fmt::format("v{0}[{1}/s],a{0}[{1}/s^2],", a.name, a.rotary ? "deg" : "mm");
  if (t.options.manner == Manner::kMoving) text += "curv[1/mm],";
  text += "feed[mm/min],t[s],";
  for (const auto& [name, value] : t.geometry.held) text += name + ",";
  for (const LoggedColumn& c : t.columns) text += c.name + (c.unit.empty() ? "," : "[" + c.unit + "],");
  switch (t.options.reading) {
    case Reading::kPoint:
      text += "x[mm],y[mm],z[mm]";
      break;
    case Reading::kLength:
      text += "length[mm],cx[mm],cy[mm],cz[mm]";
      break;
    case Reading::kD:
      text += "d[mm],nx,ny,nz,px[mm],py[mm],pz[mm]";
      break;
    case Reading::kX:
      text += "x[mm]";
      break;
  }
  return text + ",u[mm],run,role\n";
}

Eigen::Matrix3Xd nominal_points(const SurveyTable& t) {
  const Machine machine = nominal_machine(parse_machine(t.geometry.text, "family.xml"));
  std::vector<double> references;
  for (const Input& input : machine.inputs) references.push_back(input.hidden_axis ? 10 : input.reference);
  States states = make_states(t.rows.size(), machine.axes.size(), references);
  for (std::size_t r = 0; r < t.rows.size(); ++r)
    for (std::size_t i = 0; i < machine.axes.size(); ++i)
      states.axis[i][static_cast<Eigen::Index>(r)] = t.rows[r].q[i];
  return forward(machine, states).position;
}

std::string reading_text(const SurveyTable& t, std::size_t row, const Eigen::VectorXd& readings,
                         const Eigen::Matrix3Xd& nominal) {
  const auto at = [&](std::size_t i) {
    return readings.size() == 0 ? std::string("0") : number(readings[static_cast<Eigen::Index>(i)], 7);
  };
  const MotionRow& r = t.rows[row];
  switch (t.options.reading) {
    case Reading::kPoint:
      return at(3 * row) + "," + at(3 * row + 1) + "," + at(3 * row + 2);
    case Reading::kLength:
      return fmt::format("{},{},{},{}", at(row), r.centre[0], r.centre[1], r.centre[2]);
    case Reading::kD: {
      const Eigen::Vector3d p = nominal.col(static_cast<Eigen::Index>(row));
      return fmt::format("{},{},{},{},{},{},{}", at(row), r.normal[0], r.normal[1], r.normal[2],
                         number(p.x(), 6), number(p.y(), 6), number(p.z(), 6));
    }
    case Reading::kX:
      break;
  }
  return at(row);
}

}  // namespace

std::string survey_csv(const SurveyTable& t, const Eigen::VectorXd& readings) {
  std::string text = header(t);
  const Eigen::Matrix3Xd nominal = t.options.reading == Reading::kD ? nominal_points(t) : Eigen::Matrix3Xd();
  for (std::size_t i = 0; i < t.rows.size(); ++i) {
    const MotionRow& row = t.rows[i];
    for (const double q : row.q) text += number(q, 4) + ",";
    for (std::size_t a = 0; a < row.q.size(); ++a)
      text += number(row.direction[a], 0) + "," + number(row.since[a], 4) + ",";
    if (t.options.manner != Manner::kAtRest)
      for (std::size_t a = 0; a < row.q.size(); ++a)
        text += number(row.v[a], 5) + "," + number(row.a[a], 4) + ",";
    if (t.options.manner == Manner::kMoving) text += number(row.curvature, 9) + ",";
    text += number(row.feed, 3) + "," + number(row.t, 3) + ",";
    for (const auto& [name, value] : t.geometry.held) text += number(value, 0) + ",";
    for (const LoggedColumn& c : t.columns) text += number(c.value[i], 5) + ",";
    text += reading_text(t, i, readings, nominal);
    text += fmt::format(",{},{},{}\n", t.u_mm, run_label(row.run), row.check ? "check" : "fit");
  }
  return text;
}

}  // namespace vernier::support
