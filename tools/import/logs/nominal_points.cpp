// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/import/logs/nominal_points.h"

#include <algorithm>

#include "tools/format/columns.h"
#include "tools/maths/alignment.h"
#include "tools/model/chain/chain.h"

namespace vernier::importer {
namespace {

/// Positions of a reflector at an unknown place on the tool: the place in the frame of the tool and the rigid
/// motion that agree best with the points `to`, each found for the other in turn.
Eigen::Matrix3Xd reflector_positions(const model::Poses& nominal, const Eigen::Matrix3Xd& to) {
  constexpr int kMostTurns = 500;  // each reduces the difference by the spread of the orientations
  constexpr double kSettled_mm = 1e-4;
  Eigen::Vector3d place = Eigen::Vector3d::Zero();
  Eigen::Matrix3Xd from = nominal.position;
  for (int turn = 0; turn < kMostTurns; ++turn) {
    const maths::RigidMotion motion = maths::align(from, to);
    Eigen::Vector3d next = Eigen::Vector3d::Zero();
    for (Eigen::Index i = 0; i < to.cols(); ++i)
      next += nominal.rotation[static_cast<std::size_t>(i)].transpose() *
              (motion.rotation.transpose() * (to.col(i) - motion.translation) - nominal.position.col(i));
    next /= static_cast<double>(to.cols());
    const bool settled = (next - place).norm() < kSettled_mm;
    place = next;
    for (Eigen::Index i = 0; i < to.cols(); ++i)
      from.col(i) = nominal.position.col(i) + nominal.rotation[static_cast<std::size_t>(i)] * place;
    if (settled) break;
  }
  return from;
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

Eigen::VectorXd distances_from_nominal(const ImportTable& table, const model::Machine& machine,
                                       ToolPlace place) {
  if (!has_points(table)) return {};
  const auto count = static_cast<Eigen::Index>(table.line.size());
  model::States states = model::make_states(table.line.size(), machine);
  model::make_one_run(states, "list");
  for (std::size_t a = 0; a < machine.axes.size(); ++a) {
    const std::vector<double> values = table.numbers(machine.axes[a].name);
    states.axis[a] = Eigen::Map<const Eigen::VectorXd>(values.data(), count);
  }
  const model::Poses nominal = model::forward(model::nominal_machine(machine), states);
  Eigen::Matrix3Xd to(3, count);
  Eigen::Index row = 0;
  for (const char* name : format::columns::kPoint) {
    const std::vector<double> values = table.numbers(name);
    to.row(row++) = Eigen::Map<const Eigen::RowVectorXd>(values.data(), count);
  }
  if (!maths::fixes_motion(nominal.position)) return {};
  const Eigen::Matrix3Xd from =
      place == ToolPlace::kOfTheMachine ? nominal.position : reflector_positions(nominal, to);
  return maths::aligned_error(maths::align(from, to), from, to).colwise().norm();
}

}  // namespace vernier::importer
