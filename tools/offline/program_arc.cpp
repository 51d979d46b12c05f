// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/offline/program_arc.h"

#include <cmath>
#include <numbers>

namespace vernier::offline {
namespace {

using Eigen::Vector2d;

constexpr double kWhole = 2 * std::numbers::pi, kSameAngle = 1e-9;

/// The lesser arc for a positive radius, on the left of the chord for a turn to the left.
Vector2d centre_by_radius(double radius, bool clockwise, const Vector2d& start, const Vector2d& end,
                          const text::Place& place) {
  const Vector2d chord = end - start;
  const double half = chord.norm() / 2, height = radius * radius - half * half;
  if (half <= 0 || height < -1e-6 * radius * radius)
    throw text::InputError(place, "R", "no arc of this radius connects the two ends");
  const double side = (clockwise ? -1 : 1) * (radius > 0 ? 1 : -1);
  return start + chord / 2 +
         side * std::sqrt(std::max(height, 0.0)) * Vector2d(-chord.y(), chord.x()) / (2 * half);
}

Vector2d centre_by_letters(const std::vector<Word>& words, const ArcReading& reading, const Vector2d& start,
                           const text::Place& place) {
  Vector2d centre = start;
  for (std::size_t k = 0; k < 2; ++k) {
    const char letter = static_cast<char>('I' + (plane_letters(reading.plane)[k] - 'X'));
    const auto given = value_of(words, letter);
    const auto row = static_cast<Eigen::Index>(k);
    if (!reading.absolute_centre)
      centre[row] += given.value_or(0) * reading.unit;
    else if (given)
      centre[row] = *given * reading.unit + reading.zero[k];
    else
      throw text::InputError(place, std::string(1, letter), "with G90.1 the arc needs both centre words");
  }
  return centre;
}

}  // namespace

Eigen::VectorXd ProgramArc::at(double share) const {
  Eigen::VectorXd point = from + share * (to - from);
  const double out = radius + share * (radius_at_end - radius), a = angle(share);
  point[axis[0]] = centre.x() + out * std::cos(a);
  point[axis[1]] = centre.y() + out * std::sin(a);
  return point;
}

bool ProgramArc::whole() const { return std::abs(turn) > kWhole - kSameAngle; }

std::array<char, 2> plane_letters(int plane) {
  return plane == 17 ? std::array{'X', 'Y'} : plane == 18 ? std::array{'Z', 'X'} : std::array{'Y', 'Z'};
}

ProgramArc arc_of(const std::vector<Word>& words, const ArcReading& reading, const Eigen::VectorXd& from,
                  const Eigen::VectorXd& to, const text::Place& place) {
  if (const auto turns = value_of(words, 'P'); turns && *turns != 1)
    throw text::InputError(place, "P",
                           "an arc of several turns is not supported: write one arc for each turn");
  const Vector2d start(from[reading.axis[0]], from[reading.axis[1]]);
  const Vector2d end(to[reading.axis[0]], to[reading.axis[1]]);
  const auto radius = value_of(words, 'R');
  ProgramArc arc;
  arc.from = from, arc.to = to, arc.axis = reading.axis;
  arc.centre = radius ? centre_by_radius(*radius * reading.unit, reading.clockwise, start, end, place)
                      : centre_by_letters(words, reading, start, place);
  const Vector2d out = start - arc.centre, in = end - arc.centre;
  constexpr double kOff = 0.05;  // mm, and a thousandth of the radius: as controls allow
  if (out.norm() <= 0 || std::abs(out.norm() - in.norm()) > kOff + 1e-3 * out.norm())
    throw text::InputError(place, words.front().text,
                           "the start and the end of the arc have different distances from the centre");
  arc.radius = out.norm(), arc.radius_at_end = in.norm();
  arc.begin = std::atan2(out.y(), out.x());
  const double sense = reading.clockwise ? -1 : 1;
  arc.turn = std::atan2(out.x() * in.y() - out.y() * in.x(), out.dot(in));
  if (sense * arc.turn <= kSameAngle) arc.turn += sense * kWhole;
  return arc;
}

}  // namespace vernier::offline
