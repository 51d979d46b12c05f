// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/import/logs/nominal_points.h"

#include <algorithm>
#include <utility>

#include "tools/format/columns.h"
#include "tools/import/logs/pairing.h"
#include "tools/maths/alignment.h"

namespace vernier::importer {
namespace {

/// The tool points for a reflector at this place.
Eigen::Matrix3Xd positions_at(const model::Poses& nominal, const Eigen::Vector3d& place) {
  Eigen::Matrix3Xd positions = nominal.position;
  for (Eigen::Index i = 0; i < positions.cols(); ++i)
    positions.col(i) += nominal.rotation[static_cast<std::size_t>(i)] * place;
  return positions;
}

/// Place of a reflector in the frame of the tool: the place and the rigid motion that agree best with the
/// points `to`, each found for the other in turn.
Eigen::Vector3d reflector_place(const model::Poses& nominal, const Eigen::Matrix3Xd& to) {
  constexpr int kMostTurns = 500;  // each reduces the difference by the spread of the orientations
  constexpr double kSettled_mm = 1e-4;
  Eigen::Vector3d place = Eigen::Vector3d::Zero();
  for (int turn = 0; turn < kMostTurns; ++turn) {
    const maths::RigidMotion motion = maths::align(positions_at(nominal, place), to);
    Eigen::Vector3d next = Eigen::Vector3d::Zero();
    for (Eigen::Index i = 0; i < to.cols(); ++i)
      next += nominal.rotation[static_cast<std::size_t>(i)].transpose() *
              (motion.rotation.transpose() * (to.col(i) - motion.translation) - nominal.position.col(i));
    next /= static_cast<double>(to.cols());
    const bool settled = (next - place).norm() < kSettled_mm;
    place = next;
    if (settled) break;
  }
  return place;
}

/// The poses of the points that have one, and these points.
std::pair<model::Poses, Eigen::Matrix3Xd> paired(const model::Poses& nominal, const Eigen::Matrix3Xd& points,
                                                 const Pairing& pairing) {
  model::Poses poses;
  std::vector<Eigen::Index> from, to;
  for (std::size_t i = 0; i < pairing.dwell.size(); ++i) {
    if (!pairing.dwell[i]) continue;
    from.push_back(static_cast<Eigen::Index>(*pairing.dwell[i]));
    to.push_back(static_cast<Eigen::Index>(i));
    poses.rotation.push_back(nominal.rotation[*pairing.dwell[i]]);
  }
  poses.position = nominal.position(Eigen::indexing::all, from);
  return {poses, points(Eigen::indexing::all, to)};
}

bool has_points(const ImportTable& table) {
  return std::all_of(
      std::begin(format::columns::kPoint), std::end(format::columns::kPoint), [&](const char* name) {
        const ImportTable::Column* const column = table.find(name);
        return column != nullptr && std::none_of(column->cells.begin(), column->cells.end(),
                                                 [](const std::string& cell) { return cell.empty(); });
      });
}

}  // namespace

model::Poses nominal_poses(const ImportTable& table, const model::Machine& machine) {
  model::States states = model::make_states(table.line.size(), machine);
  model::make_one_run(states, "list");
  for (std::size_t a = 0; a < machine.axes.size(); ++a) {
    const std::vector<double> values = table.numbers(machine.axes[a].name);
    states.axis[a] =
        Eigen::Map<const Eigen::VectorXd>(values.data(), static_cast<Eigen::Index>(values.size()));
  }
  return model::forward(model::nominal_machine(machine), states);
}

std::optional<Eigen::Matrix3Xd> measured_points(const ImportTable& table) {
  if (!has_points(table)) return std::nullopt;
  Eigen::Matrix3Xd points(3, static_cast<Eigen::Index>(table.line.size()));
  Eigen::Index row = 0;
  for (const char* name : format::columns::kPoint) {
    const std::vector<double> values = table.numbers(name);
    points.row(row++) = Eigen::Map<const Eigen::RowVectorXd>(values.data(), points.cols());
  }
  return points;
}

std::vector<std::size_t> poses_in_order(const model::Poses& nominal, const Eigen::Matrix3Xd& points,
                                        ToolPlace place, double tolerance_mm) {
  constexpr double kCells = 4e6;        // of the alignment: 2000 points of 2000 poses
  constexpr double kToReflector = 150;  // mm: usual distance from the flange
  constexpr int kTurns = 3;             // the place of the reflector, and the pairs with it
  if (static_cast<double>(points.cols()) * static_cast<double>(nominal.position.cols()) > kCells) return {};
  PairingInput input;
  input.dwells.resize(static_cast<std::size_t>(nominal.position.cols()));
  input.stand = nominal.position;
  input.point = points;
  input.distance_tolerance_mm = place == ToolPlace::kUnknown ? kToReflector : tolerance_mm;
  Pairing pairing = pair_points(input);
  input.distance_tolerance_mm = tolerance_mm;
  for (int turn = 0; place == ToolPlace::kUnknown && turn < kTurns; ++turn) {
    const auto [poses, seen] = paired(nominal, points, pairing);
    if (!maths::fixes_motion(poses.position)) return {};
    input.stand = positions_at(nominal, reflector_place(poses, seen));
    pairing = pair_points(input);
  }
  std::vector<std::size_t> rows;
  for (const auto& pose : pairing.dwell) {
    if (!pose) return {};
    rows.push_back(*pose);
  }
  return rows;
}

Eigen::VectorXd distances_from_nominal(const ImportTable& table, const model::Machine& machine,
                                       ToolPlace place) {
  const std::optional<Eigen::Matrix3Xd> to = measured_points(table);
  if (!to) return {};
  const model::Poses nominal = nominal_poses(table, machine);
  if (!maths::fixes_motion(nominal.position)) return {};
  const Eigen::Matrix3Xd from = place == ToolPlace::kOfTheMachine
                                    ? nominal.position
                                    : positions_at(nominal, reflector_place(nominal, *to));
  return maths::aligned_error(maths::align(from, *to), from, *to).colwise().norm();
}

}  // namespace vernier::importer
