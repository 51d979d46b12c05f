// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/import/ballbar/ballbar_motion.h"

#include <cmath>
#include <numbers>

#include "tools/maths/factors.h"

namespace vernier::importer {
namespace {

double samples_in_arc(const BallbarRun& run) { return static_cast<double>(run.end - run.start + 1); }
double arc_deg(const BallbarRun& run) { return run.last_deg - run.first_deg; }

double wrapped(double angle_deg) { return angle_deg - 360 * std::floor(angle_deg / 360); }

// Motion of one axis with position R cos(phase), the phase growing with time: it reverses where the phase
// passes 0 and 180.
struct AxisMotion {
  int direction;
  double since_mm;
};

AxisMotion axis_motion(double radius_mm, double phase_deg) {
  // A sample that falls exactly on the reversal still belongs to the motion that led there: half-open from
  // above.
  const double phase = wrapped(phase_deg);
  const bool falling = phase > 0 && phase <= 180;
  const double position = radius_mm * std::cos(phase * maths::kRadPerDeg);
  return falling ? AxisMotion{-1, radius_mm - position} : AxisMotion{+1, radius_mm + position};
}

double turned_deg(const BallbarRun& run, std::size_t index) {
  if (run.clock) return run.clock->turned_deg[index];
  const double step = static_cast<double>(index) - static_cast<double>(run.start) + 0.5;
  return step * arc_deg(run) / samples_in_arc(run);
}

}  // namespace

double actual_feed_mm_min(const BallbarFile& file, const BallbarRun& run) {
  if (run.clock)
    return file.radius_mm * 2 * std::numbers::pi / (run.clock->turn_samples / run.sample_rate_hz) * 60;
  const double path_mm = file.radius_mm * arc_deg(run) * maths::kRadPerDeg;
  return path_mm / (samples_in_arc(run) / run.sample_rate_hz) * 60;
}

CirclePoint circle_point(const BallbarFile& file, const BallbarRun& run, std::size_t index) {
  const double turned = turned_deg(run, index);
  const double angle_deg = run.direction > 0 ? run.first_deg + turned : run.last_deg - turned;
  const double angle = angle_deg * maths::kRadPerDeg, c = std::cos(angle), s = std::sin(angle);
  const double speed = actual_feed_mm_min(file, run) / 60, radius = file.radius_mm;
  const double centripetal = speed * speed / radius;
  CirclePoint point;
  point.angle_deg = wrapped(angle_deg);
  point.position_mm[0] = radius * c;
  point.position_mm[1] = radius * s;
  point.velocity_mm_s[0] = -run.direction * speed * s;
  point.velocity_mm_s[1] = run.direction * speed * c;
  point.acceleration_mm_s2[0] = -centripetal * c;
  point.acceleration_mm_s2[1] = -centripetal * s;
  // A = R cos(angle), B = R cos(angle - 90); run backwards, the phases change their sign and the cosines do
  // not.
  const double phase_deg[2] = {run.direction * angle_deg, run.direction * (angle_deg - 90)};
  for (int axis = 0; axis < 2; ++axis) {
    const AxisMotion motion = axis_motion(radius, phase_deg[axis]);
    point.direction[axis] = motion.direction;
    point.since_mm[axis] = motion.since_mm;
  }
  return point;
}

std::vector<CircularPass> circular_passes(const BallbarFile& file) {
  std::vector<CircularPass> passes;
  for (const auto& run : file.runs) {
    CircularPass pass;
    pass.label = run.label;
    pass.direction = run.direction;
    pass.feed_mm_min = actual_feed_mm_min(file, run);
    for (std::size_t i = run.start; i <= run.end; ++i) {
      pass.angle_deg.push_back(circle_point(file, run, i).angle_deg);
      pass.deviation_mm.push_back(file.nominal_length_mm - file.radius_mm + run.reading_mm[i]);
    }
    passes.push_back(std::move(pass));
  }
  return passes;
}

}  // namespace vernier::importer
