// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/fit/coverage/pose_readings.h"

#include <algorithm>
#include <optional>

#include "tools/maths/factors.h"
#include "tools/maths/hand_eye.h"

namespace vernier::fit {
namespace {

using Kind = model::ObservationKind;

Eigen::Vector3d vector_at(const model::Measurement& m, std::size_t first) {
  return {m.observations[first].value, m.observations[first + 1].value, m.observations[first + 2].value};
}

void set_vector(model::Measurement& m, std::size_t first, const Eigen::Vector3d& value) {
  for (std::size_t k = 0; k < 3; ++k) m.observations[first + k].value = value[static_cast<Eigen::Index>(k)];
}

/// Index of the first of three readings of one row, of which the first has this kind; nullopt: one is
/// missing.
std::optional<std::size_t> three_of(const model::Measurement& m, std::size_t first, std::size_t last,
                                    Kind kind) {
  while (first < last && m.observations[first].kind != kind) ++first;
  if (first + 3 > last) return std::nullopt;
  for (std::size_t k = 1; k < 3; ++k)  // the kinds are in order
    if (static_cast<std::size_t>(m.observations[first + k].kind) != static_cast<std::size_t>(kind) + k)
      return std::nullopt;
  return first;
}

}  // namespace

std::vector<SixReadings> complete_poses(const model::Measurement& m) {
  std::vector<SixReadings> poses;
  const std::size_t end = m.observations.size();
  for (std::size_t first = 0, last = 0; first < end; first = last) {
    while (last < end && m.observations[last].row == m.observations[first].row) ++last;
    for (const bool of_board : {true, false}) {
      const auto point = three_of(m, first, last, of_board ? Kind::kBoardX : Kind::kX);
      const auto turn = three_of(m, first, last, of_board ? Kind::kBoardRx : Kind::kRx);
      if (!point || !turn) continue;
      poses.push_back({*point, *turn, of_board});
      break;
    }
  }
  return poses;
}

maths::RigidMotion motion_read(const model::Measurement& m, const SixReadings& pose) {
  return {maths::rotation_of(vector_at(m, pose.turn) / maths::kDegPerRad), vector_at(m, pose.point)};
}

void invert_poses(model::Measurement& m, bool of_board) {
  for (const SixReadings& pose : complete_poses(m)) {
    if (pose.of_board != of_board) continue;
    const maths::RigidMotion inverse = maths::inverse_of(motion_read(m, pose));
    set_vector(m, pose.point, inverse.translation);
    set_vector(m, pose.turn, -vector_at(m, pose.turn));
  }
}

}  // namespace vernier::fit
