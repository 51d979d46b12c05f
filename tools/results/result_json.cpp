// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/results/result_json.h"
#include "tools/kinematics/rotations.h"

#include <fmt/format.h>

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

void print_pose(std::FILE* out, const char* what, const model::Poses& poses) {
  const Eigen::Vector3d p = poses.position.col(0), r = rotation_deg(poses);
  fmt::print(out, "{:<10} {:.6f} {:.6f} {:.6f} mm   rotation {:.7f} {:.7f} {:.7f} deg\n", what, p.x(), p.y(),
             p.z(), r.x(), r.y(), r.z());
}

}  // namespace vernier::results
