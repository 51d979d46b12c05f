// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/fit/noise/contradicting_rows.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <map>
#include <tuple>

#include "tools/maths/factors.h"
#include "tools/maths/median.h"

namespace vernier::fit {
namespace {

using Eigen::Index;
using Eigen::Vector3d;

/// Times the standard uncertainty of a difference, and times the usual difference of repeated poses: chance
/// does not reach it in any survey.
constexpr double kFar = 10;
/// A machine that drifts, heats up or has play between two visits of a pose moves by less, mm.
constexpr double kLeast_mm = 0.1;
/// The same where neither u nor other repeated poses show the noise of the instrument, mm.
constexpr double kLeastUnknown_mm = 0.5;
/// Repeated poses that show what is usual.
constexpr std::size_t kPoses = 4;

/// Everything that has to be equal in two rows at one pose; numbers as of rounded_values().
struct Pose {
  std::size_t file = 0, setup = 0, thing = 0;
  std::vector<std::int64_t> numbers;
  std::string image;
  bool operator<(const Pose& other) const {
    return std::tie(file, setup, thing, numbers, image) <
           std::tie(other.file, other.setup, other.thing, other.numbers, other.image);
  }
};

Pose pose_of(const model::Measurement& m, const std::vector<model::Column>& commanded, std::size_t row) {
  const model::States& s = m.states;
  Pose pose{
      m.file[row], s.of(s.setup, row), m.thing_of(row), {}, m.corrected.empty() ? "" : m.corrected[row]};
  for (const auto& list : {std::cref(commanded), std::cref(s.direction), std::cref(s.input)})
    for (const std::int64_t value : rounded_values(list.get(), row)) pose.numbers.push_back(value);
  return pose;
}

/// The measured points; a coordinate without a reading is NaN.
std::vector<Vector3d> points_of(const model::Measurement& m) {
  std::vector<Vector3d> points(m.rows(), Vector3d::Constant(std::nan("")));
  for (const model::Observation& one : m.observations) {
    constexpr int kX = static_cast<int>(model::ObservationKind::kX);
    const int k = static_cast<int>(one.kind) - kX;
    if (k >= 0 && k < 3) points[one.row][k] = one.value;
  }
  return points;
}

double apart_mm(const Vector3d& a, const Vector3d& b) {
  double squares = 0;
  for (int k = 0; k < 3; ++k)
    if (std::isfinite(a[k]) && std::isfinite(b[k])) squares += (a[k] - b[k]) * (a[k] - b[k]);
  return std::sqrt(squares);
}

Vector3d median_of(const std::vector<Vector3d>& points, const std::vector<std::size_t>& rows) {
  Vector3d median = Vector3d::Constant(std::nan(""));
  for (int k = 0; k < 3; ++k) {
    std::vector<double> values;
    for (const std::size_t row : rows)
      if (std::isfinite(points[row][k])) values.push_back(points[row][k]);
    if (!values.empty()) median[k] = maths::median(std::move(values));
  }
  return median;
}

/// A row and the row that it is compared with.
struct Repeat {
  ContradictingRows rows;
  double usual_mm = 0;  // of the other rows at this pose; 0: there are none
  double u_mm = 0;      // 0: not stated
};

void add_repeats(const model::Measurement& m, const std::vector<Vector3d>& points,
                 const std::vector<std::size_t>& rows, std::vector<Repeat>& list) {
  const auto u = [&](std::size_t row) { return m.uncertainty[static_cast<Index>(row)]; };
  if (rows.size() == 2) {
    list.push_back({{rows[1], rows[0], maths::kUmPerMm * apart_mm(points[rows[0]], points[rows[1]])},
                    0,
                    std::hypot(u(rows[0]), u(rows[1]))});
    return;
  }
  const Vector3d median = median_of(points, rows);
  std::vector<double> far;
  for (const std::size_t row : rows) far.push_back(apart_mm(points[row], median));
  const std::size_t nearest =
      rows[static_cast<std::size_t>(std::min_element(far.begin(), far.end()) - far.begin())];
  const double usual = maths::median(far);
  for (const std::size_t row : rows)
    if (row != nearest)
      list.push_back(
          {{row, nearest, maths::kUmPerMm * apart_mm(points[row], points[nearest])}, usual, u(row)});
}

}  // namespace

std::vector<std::int64_t> rounded_values(const std::vector<model::Column>& columns, std::size_t row) {
  constexpr double kSame = 1e4;  // 0.1 um, 0.0001 deg
  std::vector<std::int64_t> values;
  for (const model::Column& column : columns)
    values.push_back(std::llround(kSame * column[static_cast<Index>(row)]));
  return values;
}

std::vector<ContradictingRows> contradicting_rows(const model::Measurement& m) {
  std::vector<model::Column> commanded;
  for (std::size_t a = 0; a < m.states.axis.size(); ++a) commanded.push_back(model::commanded(m, a));
  const std::vector<Vector3d> points = points_of(m);
  std::map<Pose, std::vector<std::size_t>> poses;
  for (std::size_t row = 0; row < m.rows(); ++row)
    if (!points[row].array().isNaN().all()) poses[pose_of(m, commanded, row)].push_back(row);
  std::vector<Repeat> repeats;
  std::vector<double> usual;
  for (const auto& [pose, rows] : poses) {
    if (rows.size() < 2) continue;
    const std::size_t first = repeats.size();
    add_repeats(m, points, rows, repeats);
    std::vector<double> apart;
    for (std::size_t k = first; k < repeats.size(); ++k)
      apart.push_back(repeats[k].rows.apart_um / maths::kUmPerMm);
    usual.push_back(maths::median(std::move(apart)));
  }
  const std::size_t n_poses = usual.size();
  const double usual_mm = n_poses >= kPoses ? maths::median(std::move(usual)) : 0;
  std::vector<ContradictingRows> list;
  for (const Repeat& one : repeats) {
    const bool known = one.u_mm > 0 || one.usual_mm > 0 || n_poses >= kPoses;
    const double limit_mm = std::max(
        {known ? kLeast_mm : kLeastUnknown_mm, kFar * one.u_mm, kFar * one.usual_mm, kFar * usual_mm});
    if (one.rows.apart_um > maths::kUmPerMm * limit_mm) list.push_back(one.rows);
  }
  std::stable_sort(list.begin(), list.end(),
                   [](const auto& a, const auto& b) { return a.apart_um > b.apart_um; });
  return list;
}

std::string contradiction_in_words(const model::Measurement& m, const std::vector<ContradictingRows>& list) {
  if (list.empty()) return {};
  const ContradictingRows& worst = list.front();
  const std::string more =
      list.size() > 1 ? fmt::format(" ({} more rows contradict their pose in this way)", list.size() - 1)
                      : "";
  return fmt::format(
      "The rows in lines {} and {} of {} have the same commanded position, and their points are {:.4g} um "
      "apart, far more than the noise{}: one of them was probably written to the wrong pose. Correct it or "
      "delete its row.",
      std::min(m.line[worst.row], m.line[worst.other]), std::max(m.line[worst.row], m.line[worst.other]),
      m.files[m.file[worst.row]], worst.apart_um, more);
}

}  // namespace vernier::fit
