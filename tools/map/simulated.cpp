// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/map/simulated.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <numbers>
#include <optional>

#include "tools/format/columns.h"
#include "tools/format/csv_file.h"
#include "tools/format/units.h"
#include "tools/import/ballbar/circular.h"
#include "tools/maths/decompositions.h"
#include "tools/maths/factors.h"
#include "tools/text/files.h"
#include "tools/text/numbers.h"

namespace vernier::map {
namespace {

using Eigen::Index;
using Eigen::Matrix3Xd;
using Eigen::Vector3d;
using Json = nlohmann::ordered_json;

constexpr int kCirclePoints = 360;  // one per degree
const char* const kPlaneNames[] = {"XY", "YZ", "ZX"};

double range(const Eigen::VectorXd& v) { return v.maxCoeff() - v.minCoeff(); }

/// Slope and offset of a least-squares line through (t, v).
Eigen::Vector2d line_fit(const Eigen::VectorXd& t, const Eigen::VectorXd& v) {
  Eigen::MatrixXd a(t.size(), 2);
  a.col(0) = t;
  a.col(1).setOnes();
  return maths::least_squares(a, v);
}

/// Worst range across a line about its least-squares line, mm. `off`: actual - nominal.
double straightness(const Matrix3Xd& nominal, const Matrix3Xd& off, const Vector3d& along) {
  const Eigen::VectorXd t = (nominal.colwise() - Vector3d(nominal.col(0))).transpose() * along;
  const Vector3d a = along.unitOrthogonal(), b = along.cross(a);
  double worst = 0;
  for (const Vector3d& across : {a, b}) {
    const Eigen::VectorXd v = off.transpose() * across;
    const Eigen::Vector2d fit = line_fit(t, v);
    worst = std::max(worst, range(v - fit[0] * t - Eigen::VectorXd::Constant(t.size(), fit[1])));
  }
  return worst;
}

Matrix3Xd points_between(const Vector3d& from, const Vector3d& to, int count) {
  Matrix3Xd points(3, count);
  for (int i = 0; i < count; ++i) points.col(i) = from + (to - from) * i / (count - 1);
  return points;
}

Vector3d middle(const Bench& bench) {
  return bench.point_at(Eigen::VectorXd::Constant(static_cast<Index>(bench.axes().size()), 0.5));
}

Matrix3Xd circle_points(const Vector3d& centre, double radius, int plane, int sense) {
  Matrix3Xd points(3, kCirclePoints + 1);
  for (int i = 0; i <= kCirclePoints; ++i) {
    const double angle = sense * 2 * std::numbers::pi * i / kCirclePoints;
    points.col(i) = centre;
    points(plane, i) += radius * std::cos(angle);
    points((plane + 1) % 3, i) += radius * std::sin(angle);
  }
  return points;
}

/// Returns the largest radius (mm) of a circle that the axes reach, minus a tenth; nullopt if they
/// do not move in that plane.
std::optional<double> fitting_radius(const Bench& bench, const Vector3d& centre, int plane) {
  double low = 0, high = 1e-3;
  const auto reach = [&](double r) { return bench.reaches(circle_points(centre, r, plane, 1)); };
  if (!reach(high)) return std::nullopt;
  while (high < 1e6 && reach(high)) {
    low = high;
    high *= 2;
  }
  for (int i = 0; i < 40; ++i) (reach((low + high) / 2) ? low : high) = (low + high) / 2;
  return 0.9 * low;
}

importer::CircularPass measured_circle(const Bench& bench, const Vector3d& centre, double radius, int plane,
                                       int sense) {
  const Matrix3Xd points = circle_points(centre, radius, plane, sense);
  // A lap before the evaluated one, so that directions and travel since reversal are those of
  // steady motion.
  Matrix3Xd laps(3, 2 * kCirclePoints + 1);
  laps << points.leftCols(kCirclePoints), points;
  const Matrix3Xd actual = bench.measure(laps).rightCols(kCirclePoints);
  importer::CircularPass pass;
  pass.label = sense > 0 ? "CCW" : "CW";
  pass.direction = sense;
  for (int i = 0; i < kCirclePoints; ++i) {
    const double angle = sense * 360.0 * (i + 1) / kCirclePoints;
    pass.angle_deg.push_back(angle < 0 ? angle + 360 : angle);
    const Vector3d from_centre = actual.col(i) - centre;
    pass.deviation_mm.push_back(std::hypot(from_centre[plane], from_centre[(plane + 1) % 3]) - radius);
  }
  return pass;
}

/// Adds the line if the nominal chain can follow it. If axes rotate the tool point, that is not
/// certain.
void add_line(const Bench& bench, const std::string& name, const Eigen::VectorXd& from,
              const Eigen::VectorXd& to, std::vector<LineResult>& lines) {
  const Vector3d first = bench.point_at(from), last = bench.point_at(to);
  if (bench.meets(points_between(first, last, kLinePositions)))
    lines.push_back(measure_line(bench, name, first, last));
}

void add_diagonal(const model::Machine& machine, const Bench& bench, const std::vector<Index>& moving,
                  unsigned signs, std::vector<LineResult>& lines) {
  const auto count = static_cast<Index>(bench.axes().size());
  // Faces at the low end of the axes that do not move.
  Eigen::VectorXd from = Eigen::VectorXd::Zero(count), to = from;
  std::string name;
  for (std::size_t i = 0; i < moving.size(); ++i) {
    const bool up = (signs >> i & 1u) == 0;
    (up ? to : from)[moving[i]] = 1;
    name += (up ? "+" : "-") + machine.axes[bench.axes()[static_cast<std::size_t>(moving[i])]].name;
  }
  add_line(bench, name, from, to, lines);
}

}  // namespace

LineResult measure_line(const Bench& bench, const std::string& name, const Vector3d& from, const Vector3d& to,
                        int positions) {
  const Matrix3Xd there = points_between(from, to, positions);
  Matrix3Xd both(3, 2 * positions);
  both << there, there.rowwise().reverse();
  const Matrix3Xd off = bench.measure(both) - both;
  const Vector3d along = (to - from).normalized();
  LineResult line{name, from, to, {}, {}, {}};
  const double start = along.dot(off.col(0));
  constexpr double kBeyond = std::numeric_limits<double>::infinity();  // of every axis
  double mean_low = kBeyond, mean_high = -kBeyond, low = kBeyond, high = -kBeyond;
  for (int i = 0; i < positions; ++i) {
    const double f = maths::kUmPerMm * (along.dot(off.col(i)) - start);
    const double r = maths::kUmPerMm * (along.dot(off.col(2 * positions - 1 - i)) - start);
    line.distance_mm.push_back((there.col(i) - from).norm());
    line.forward_um.push_back(f);
    line.reverse_um.push_back(r);
    low = std::min({low, f, r});
    high = std::max({high, f, r});
    mean_low = std::min(mean_low, (f + r) / 2);
    mean_high = std::max(mean_high, (f + r) / 2);
    // At the end the motion reverses without passing it, so the directions do not differ there.
    if (i + 1 < positions) line.reversal_um = std::max(line.reversal_um, std::abs(f - r));
  }
  line.error_um = high - low;
  line.mean_um = mean_high - mean_low;
  line.straightness_um = maths::kUmPerMm * straightness(there, off.leftCols(positions), along);
  return line;
}

std::vector<LineResult> axis_lines(const model::Machine& machine, const Bench& bench) {
  std::vector<LineResult> lines;
  for (std::size_t k = 0; k < bench.axes().size(); ++k) {
    Eigen::VectorXd from = Eigen::VectorXd::Constant(static_cast<Index>(bench.axes().size()), 0.5), to = from;
    from[static_cast<Index>(k)] = 0;
    to[static_cast<Index>(k)] = 1;
    add_line(bench, machine.axes[bench.axes()[k]].name, from, to, lines);
  }
  return lines;
}

std::vector<LineResult> diagonals(const model::Machine& machine, const Bench& bench) {
  std::vector<LineResult> lines;
  const auto count = static_cast<Index>(bench.axes().size());
  if (count == 3)
    for (unsigned signs : {0u, 1u, 2u, 4u}) add_diagonal(machine, bench, {0, 1, 2}, signs, lines);
  for (Index a = 0; a < count; ++a)
    for (Index b = a + 1; b < count; ++b)
      for (unsigned signs : {0u, 2u}) add_diagonal(machine, bench, {a, b}, signs, lines);
  return lines;
}

Json circles_json(const Bench& bench) {
  Json list = Json::array();
  const Vector3d centre = middle(bench);
  for (int plane = 0; plane < 3; ++plane) {
    const auto radius = fitting_radius(bench, centre, plane);
    if (!radius) continue;
    const importer::CircularResult result =
        importer::analyse_circle(*radius, {measured_circle(bench, centre, *radius, plane, 1),
                                           measured_circle(bench, centre, *radius, plane, -1)});
    list.push_back(
        {{"plane", kPlaneNames[plane]},
         {"radius_mm", *radius},
         {"circular_deviation_ccw_um", result.passes[0].circular_deviation_um},
         {"circular_deviation_cw_um", result.passes[1].circular_deviation_um},
         {"bidirectional_um", result.bidirectional_um.value_or(0)},
         {"hysteresis_um", result.hysteresis_by_angle ? result.hysteresis_by_angle->um : 0},
         {"max_radial_um", std::max(result.passes[0].max_radial_um, result.passes[1].max_radial_um)},
         {"min_radial_um", std::min(result.passes[0].min_radial_um, result.passes[1].min_radial_um)}});
  }
  return list;
}

Json squares_json(const Bench& bench) {
  Json list = Json::array();
  const Vector3d centre = middle(bench);
  for (int plane = 0; plane < 3; ++plane) {
    const auto radius = fitting_radius(bench, centre, plane);
    if (!radius) continue;
    const double half = *radius / std::sqrt(2.0);  // its corners lie on the circle
    constexpr int kSide = 21;                      // points of a square's side, as in ISO 230-1
    const double corner[5][2] = {{-1, -1}, {1, -1}, {1, 1}, {-1, 1}, {-1, -1}};
    double slope[4] = {}, straight = 0;
    Json sides = Json::array();
    for (int s = 0; s < 4; ++s) {
      Vector3d from = centre, to = centre;
      for (int c = 0; c < 2; ++c) {
        from[(plane + c) % 3] += half * corner[s][c];
        to[(plane + c) % 3] += half * corner[s + 1][c];
      }
      const Matrix3Xd nominal = points_between(from, to, kSide);
      const Matrix3Xd actual = bench.measure(nominal), off = actual - nominal;
      const Vector3d along = (to - from).normalized();
      Vector3d normal = Vector3d::Zero();
      normal[(plane + 2) % 3] = 1;
      const Vector3d left = normal.cross(along);
      const Eigen::VectorXd t = (nominal.colwise() - from).transpose() * along;
      slope[s] = line_fit(t, off.transpose() * left)[0];  // rad, anticlockwise
      straight = std::max(straight, straightness(nominal, off, along));
      sides.push_back(maths::kUmPerMm * ((actual.col(kSide - 1) - actual.col(0)).norm() - 2 * half));
    }
    // Side 0 is along the first axis, side 1 along the second. The opposite sides have the
    // opposite direction.
    const double square = (slope[1] + slope[3]) / 2 - (slope[0] + slope[2]) / 2;
    list.push_back({{"plane", kPlaneNames[plane]},
                    {"side_mm", 2 * half},
                    {"angle_um_per_m", 1e6 * square},
                    {"side_length_deviation_um", sides},
                    {"straightness_um", maths::kUmPerMm * straight}});
  }
  return list;
}

Json cylinder_json(const Bench& bench) {
  const Vector3d centre = middle(bench);
  const auto radius = fitting_radius(bench, centre, 0);
  if (!radius) return nullptr;
  double half = 1e6;
  const auto circle_at = [&](double z) { return circle_points(centre + Vector3d(0, 0, z), *radius, 0, 1); };
  while (half > 1e-3 && !(bench.reaches(circle_at(half)) && bench.reaches(circle_at(-half)))) half *= 0.9;
  if (half <= 1e-3) return nullptr;
  constexpr int kHeights = 5;  // of a cylinder
  std::vector<Eigen::Matrix<double, 5, 1>> rows;
  std::vector<double> radii;
  for (int h = 0; h < kHeights; ++h) {
    const double z = half * (2.0 * h / (kHeights - 1) - 1);
    const Matrix3Xd actual = bench.measure(circle_at(z));
    for (Index i = 0; i < actual.cols(); ++i) {
      const Vector3d p = actual.col(i) - centre;
      const double r = std::hypot(p.x(), p.y());
      radii.push_back(r);
      rows.push_back({1, p.x() / r, p.y() / r, p.z() * p.x() / r, p.z() * p.y() / r});
    }
  }
  // r = radius + shift and tilt of the axis in the radial direction. It is linear, like the
  // analysis of the circle.
  Eigen::MatrixXd a(static_cast<Index>(rows.size()), 5);
  for (std::size_t i = 0; i < rows.size(); ++i) a.row(static_cast<Index>(i)) = rows[i].transpose();
  const Eigen::VectorXd r = Eigen::Map<const Eigen::VectorXd>(radii.data(), static_cast<Index>(radii.size()));
  const Eigen::VectorXd fit = maths::least_squares(a, r);
  return {{"radius_mm", *radius},
          {"height_mm", 2 * half},
          {"cylindricity_um", maths::kUmPerMm * range(r - a * fit)},
          {"radius_deviation_um", maths::kUmPerMm * (fit[0] - *radius)},
          {"axis_tilt_um_per_m", {1e6 * fit[3], 1e6 * fit[4]}}};
}

Json free_lines_json(const Bench& bench, const std::string& path) {
  const format::CsvFile csv = format::parse_csv(text::read_file(path), path);
  std::map<std::string, std::size_t> column;
  for (std::size_t i = 0; i < csv.columns.size(); ++i) column[csv.columns[i].name] = i;
  std::map<std::string, std::vector<Vector3d>> lines;
  for (std::size_t i = 0; i < csv.rows.size(); ++i) {
    Vector3d point;
    for (int c = 0; c < 3; ++c) {
      const std::string name(1, "xyz"[c]);
      const auto found = column.find(name);
      if (found == column.end() ||
          format::find_unit(csv.columns[found->second].unit)->dimension != format::Dimension::kLength)
        throw text::InputError({path, csv.header_line}, name,
                               "free lines are points " + format::headings(format::columns::kPoint) + "," +
                                   format::columns::kRun);
      const auto value = text::parse_number(csv.rows[i][found->second]);
      if (!value) throw text::InputError({path, csv.line[i]}, csv.rows[i][found->second], "not a number");
      point[c] = *value * format::find_unit(csv.columns[found->second].unit)->factor;
    }
    if (!bench.reaches(point))
      throw text::InputError({path, csv.line[i]}, "", "this point is outside the working volume");
    lines[column.contains(format::columns::kRun) ? csv.rows[i][column[format::columns::kRun]] : ""].push_back(
        point);
  }
  Json list = Json::array();
  for (const auto& [name, points] : lines) {
    if (points.size() < 2) throw text::InputError({path, 0}, name, "a line needs at least two points");
    Matrix3Xd nominal(3, static_cast<Index>(points.size()));
    for (std::size_t i = 0; i < points.size(); ++i) nominal.col(static_cast<Index>(i)) = points[i];
    const Matrix3Xd actual = bench.measure(nominal);
    const Index last = nominal.cols() - 1;
    const Vector3d along = nominal.col(last) - nominal.col(0);
    if (along.norm() == 0) throw text::InputError({path, 0}, name, "a line needs two different ends");
    list.push_back(
        {{"run", name},
         {"points", points.size()},
         {"length_mm", along.norm()},
         {"length_deviation_um",
          maths::kUmPerMm * ((actual.col(last) - actual.col(0)).norm() - along.norm())},
         {"straightness_um", maths::kUmPerMm * straightness(nominal, actual - nominal, along.normalized())},
         {"max_deviation_um", maths::kUmPerMm * (actual - nominal).colwise().norm().maxCoeff()}});
  }
  return list;
}

Json line_json(const LineResult& line) {
  return {{"name", line.name},
          {"from_mm", {line.from.x(), line.from.y(), line.from.z()}},
          {"to_mm", {line.to.x(), line.to.y(), line.to.z()}},
          {"length_mm", (line.to - line.from).norm()},
          {"E_um", line.error_um},
          {"M_um", line.mean_um},
          {"B_um", line.reversal_um},
          {"straightness_um", line.straightness_um},
          {"distance_mm", line.distance_mm},
          {"forward_um", line.forward_um},
          {"reverse_um", line.reverse_um}};
}

}  // namespace vernier::map
