// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/results/result_json.h"
#include "tools/kinematics/rotations.h"

#include <fmt/format.h>

#include <cmath>
#include <numbers>

namespace vernier::results {
namespace {

using Json = nlohmann::ordered_json;

Json three(const Eigen::Vector3d& v) { return {v.x(), v.y(), v.z()}; }

Eigen::Vector3d rotation_deg(const model::Poses& poses) {
  return kinematics::rotation_vector(poses.rotation[0]) * (180 / std::numbers::pi);
}

}  // namespace

Json axes_json(const model::Machine& machine, const model::States& states) {
  Json result = Json::object();
  for (std::size_t i = 0; i < machine.axes.size(); ++i) result[machine.axes[i].name] = states.axis[i][0];
  return result;
}

Json pose_json(const model::Poses& poses) {
  return {{"position_mm", three(poses.position.col(0))},
          {"rotation_deg", three(rotation_deg(poses))},
          {"direction", three(poses.rotation[0].col(2))}};
}

Json inverse_json(const model::Machine& machine, const kinematics::Inverse& proof) {
  return {{"converged", proof.converged},
          {"fault", proof.converged ? Json(nullptr) : Json(kinematics::name_of(proof.fault))},
          {"axis", proof.fault == kinematics::InverseFault::kBeyondRange ? Json(machine.axes[proof.axis].name)
                                                                         : Json(nullptr)},
          {"iterations", proof.iterations},
          {"residual_mm", proof.residual_mm},
          {"residual_deg", proof.residual_deg},
          {"condition", proof.condition}};
}

Json correction_json(const model::Machine& machine, const kinematics::CorrectionResult& result) {
  Json offset = Json::object();
  for (std::size_t i = 0; i < machine.axes.size(); ++i) offset[machine.axes[i].name] = result.offset[i][0];
  return {{"offset", offset},
          {"left_um", three(1000 * result.after.col(0))},
          {"tilt_left_deg", result.tilt_after[0]},
          {"proof", inverse_json(machine, result.each[0])}};
}

Eigen::Vector3d without_minus_zero(const Eigen::Vector3d& values, int decimals) {
  const double least = 0.5 * std::pow(10.0, -decimals);
  return values.unaryExpr([&](double value) { return std::abs(value) < least ? 0.0 : value; });
}

void print_pose(std::FILE* out, const char* what, const model::Poses& poses) {
  const Eigen::Vector3d p = without_minus_zero(poses.position.col(0), 6),
                        r = without_minus_zero(rotation_deg(poses), 7);
  fmt::print(out, "{:<10} {:.6f} {:.6f} {:.6f} mm   rotation {:.7f} {:.7f} {:.7f} deg\n", what, p.x(), p.y(),
             p.z(), r.x(), r.y(), r.z());
}

}  // namespace vernier::results
