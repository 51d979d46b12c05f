// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/results/circles.h"

#include <algorithm>
#include <cmath>

#include "tools/maths/factors.h"
#include "tools/model/chain/chain.h"

namespace vernier::results {
namespace {

/// How far the nominal radius may vary, and the point may leave the plane, as a share of the radius.
constexpr double kFlatness = 1e-3;
constexpr double kLeastArcDeg = 90;
constexpr std::size_t kLeastPoints = 16;

struct RunPoints {
  std::vector<std::size_t> observation;
  std::vector<Eigen::Vector3d> arm;  // nominal tool point minus centre, mm
  Eigen::Vector3d centre;
};

double wrapped_deg(double angle) { return angle - 360 * std::floor(angle / 360); }

/// The coordinate that stays put, if the points lie on a circle in a coordinate plane: 0..2, else 3.
std::size_t normal_of(const RunPoints& points, double radius) {
  for (const Eigen::Vector3d& arm : points.arm)
    if (std::abs(arm.norm() - radius) > kFlatness * radius) return 3;
  for (int k = 0; k < 3; ++k) {
    double most = 0;
    for (const Eigen::Vector3d& arm : points.arm) most = std::max(most, std::abs(arm[k]));
    if (most <= kFlatness * radius) return static_cast<std::size_t>(k);
  }
  return 3;
}

/// Mean direction and span of the angles; a run that goes to and fro has no direction.
CircleRun run_of(const RunPoints& points, std::array<std::size_t, 2> plane) {
  CircleRun run;
  run.observation = points.observation;
  double travelled = 0, total = 0;
  for (std::size_t i = 0; i < points.arm.size(); ++i) {
    const auto a = static_cast<Eigen::Index>(plane[0]), b = static_cast<Eigen::Index>(plane[1]);
    run.angle_deg.push_back(wrapped_deg(maths::kDegPerRad * std::atan2(points.arm[i][b], points.arm[i][a])));
    if (i == 0) continue;
    const double step = wrapped_deg(run.angle_deg[i] - run.angle_deg[i - 1] + 180) - 180;
    travelled += step;
    total += std::abs(step);
  }
  const bool one_way = std::abs(travelled) > 0.9 * total && total >= kLeastArcDeg;
  run.direction = !one_way ? 0 : travelled > 0 ? 1 : -1;
  return run;
}

}  // namespace

std::vector<Circle> find_circles(const model::Machine& machine, const model::Measurement& m) {
  std::vector<RunPoints> runs(m.states.run_names.size());
  const bool any = std::any_of(m.observations.begin(), m.observations.end(), [](const model::Observation& o) {
    return o.kind == model::ObservationKind::kLength;
  });
  if (!any) return {};
  const model::Poses nominal = model::forward(model::nominal_machine(machine), model::commanded_states(m));
  for (std::size_t i = 0; i < m.observations.size(); ++i) {
    const model::Observation& o = m.observations[i];
    if (o.kind != model::ObservationKind::kLength) continue;
    RunPoints& points = runs[m.states.run[o.row]];
    const auto at = static_cast<Eigen::Index>(o.row);
    if (points.observation.empty()) points.centre = m.centre.col(at);
    points.observation.push_back(i);
    points.arm.emplace_back(nominal.position.col(at) - m.centre.col(at));
  }
  std::vector<Circle> circles;
  for (std::size_t r = 0; r < runs.size(); ++r) {
    if (runs[r].arm.size() < kLeastPoints) continue;
    const double radius = runs[r].arm.front().norm();
    const std::size_t normal = radius > 0 ? normal_of(runs[r], radius) : 3;
    if (normal > 2) continue;
    Circle circle;
    circle.plane = {(normal + 1) % 3, (normal + 2) % 3};
    circle.nominal_radius_mm = radius;
    for (std::size_t k = 0; k < 3; ++k) circle.centre_mm[k] = runs[r].centre[static_cast<Eigen::Index>(k)];
    CircleRun run = run_of(runs[r], circle.plane);
    run.label = m.states.run_names[r];
    if (run.direction == 0) continue;
    auto same = std::find_if(circles.begin(), circles.end(), [&](const Circle& other) {
      return other.plane == circle.plane && other.centre_mm == circle.centre_mm &&
             std::abs(other.nominal_radius_mm - radius) <= kFlatness * radius;
    });
    if (same == circles.end()) same = circles.insert(circles.end(), circle);
    same->runs.push_back(std::move(run));
  }
  return circles;
}

importer::CircularResult analyse(const Circle& circle, const model::Measurement& m) {
  std::vector<importer::CircularPass> passes;
  for (const CircleRun& run : circle.runs) {
    importer::CircularPass pass;
    pass.label = run.label;
    pass.direction = run.direction;
    for (std::size_t i = 0; i < run.observation.size(); ++i) {
      const model::Observation& o = m.observations[run.observation[i]];
      if (m.check[o.row] != 0) continue;
      if (pass.angle_deg.empty() && m.states.feed[static_cast<Eigen::Index>(o.row)] > 0)
        pass.feed_mm_min = m.states.feed[static_cast<Eigen::Index>(o.row)];
      pass.angle_deg.push_back(run.angle_deg[i]);
      pass.deviation_mm.push_back(o.value - circle.nominal_radius_mm);
    }
    passes.push_back(std::move(pass));
  }
  return importer::analyse_circle(circle.nominal_radius_mm, passes);
}

}  // namespace vernier::results
