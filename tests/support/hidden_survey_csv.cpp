// SPDX-License-Identifier: GPL-3.0-or-later
#include "tests/support/hidden_survey_csv.h"

#include <fmt/format.h>

#include <Eigen/Geometry>

#include <cmath>
#include <numbers>

#include "tests/support/hidden_survey_inputs.h"
#include "tools/model/chain/chain.h"
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
    case Reading::kZ:
      text += "z[mm]";
      break;
    case Reading::kDirection:
      text += "ax,ay,az";
      break;
    case Reading::kTurn:
      text += "rz[deg]";
      break;
  }
  if (t.with_u)
    text += t.options.reading == Reading::kDirection ? ",ua[arcsec]"
            : is_angular(t.options.reading)          ? ",u[arcsec]"
                                                     : ",u[mm]";
  return text + ",run,role\n";
}

Poses nominal_poses(const SurveyTable& t) {
  const Machine machine = nominal_machine(parse_machine(t.geometry.text, "family.xml"));
  std::vector<double> references;
  for (const Input& input : machine.inputs) references.push_back(input.hidden_axis ? 10 : input.reference);
  States states = make_states(t.rows.size(), machine.axes.size(), references);
  for (std::size_t r = 0; r < t.rows.size(); ++r)
    for (std::size_t i = 0; i < machine.axes.size(); ++i)
      states.axis[i][static_cast<Eigen::Index>(r)] = t.rows[r].q[i];
  return forward(machine, states);
}

/// The direction that is off the nominal one by two angles, deg, across it.
std::string direction_text(const Eigen::Vector3d& along, double first, double second) {
  const Eigen::Vector3d across = along.unitOrthogonal();
  const Eigen::Vector3d turn =
      (first * across + second * along.cross(across)) * std::numbers::pi / 180;  // the way it is off, rad
  const double angle = turn.norm();
  const Eigen::Vector3d off =
      angle > 0 ? Eigen::Vector3d(std::cos(angle) * along + std::sin(angle) / angle * turn) : along;
  return fmt::format("{},{},{}", number(off.x(), 11), number(off.y(), 11), number(off.z(), 11));
}

std::string reading_text(const SurveyTable& t, std::size_t row, const Eigen::VectorXd& readings,
                         const Poses& nominal) {
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
      const Eigen::Vector3d p = nominal.position.col(static_cast<Eigen::Index>(row));
      return fmt::format("{},{},{},{},{},{},{}", at(row), r.normal[0], r.normal[1], r.normal[2],
                         number(p.x(), 6), number(p.y(), 6), number(p.z(), 6));
    }
    case Reading::kDirection: {
      const auto angle = [&](std::size_t k) {
        return readings.size() == 0 ? 0 : readings[static_cast<Eigen::Index>(2 * row + k)];
      };
      return direction_text(nominal.rotation[row].col(2), angle(0), angle(1));
    }
    case Reading::kX:
    case Reading::kZ:
    case Reading::kTurn:
      break;
  }
  return at(row);
}

}  // namespace

Eigen::Matrix3Xd nominal_points(const SurveyTable& t) { return nominal_poses(t).position; }

std::string survey_csv(const SurveyTable& t, const Eigen::VectorXd& readings) {
  std::string text = header(t);
  const bool by_nominal = t.options.reading == Reading::kD || t.options.reading == Reading::kDirection;
  const Poses nominal = by_nominal ? nominal_poses(t) : Poses();
  const double u = is_angular(t.options.reading) ? 3600 * angle_deg(t.u_mm) : t.u_mm;
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
    if (t.with_u) text += fmt::format(",{}", t.growing_u.empty() ? u : u * t.growing_u[i]);
    text += fmt::format(",{},{}\n", run_label(row.run), row.check ? "check" : "fit");
  }
  return text;
}

}  // namespace vernier::support
