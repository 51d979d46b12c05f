// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/fit/coverage/bow_of_plane.h"

#include <array>
#include <cmath>
#include <optional>
#include <vector>

#include "tools/fit/coverage/reading_direction.h"
#include "tools/maths/decompositions.h"
#include "tools/model/chain/chain_rows.h"
#include "tools/model/chain/observation_model.h"
#include "tools/model/parameters.h"

namespace vernier::fit {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::Vector3d;
using model::Measurement;

/// Readings that read along the normal: one row for each.
struct Heights {
  std::vector<Vector3d> bow;                  // slope of the reading by the three second-order terms
  std::vector<std::vector<double>> nuisance;  // slope by height and tilt of each set-up, then by the
                                              // height of each touched object
};

/// Coordinates in the plane: -1 to 1 over the touched region.
class PlaneFrame {
 public:
  PlaneFrame(const std::vector<Vector3d>& touched, const Vector3d& normal)
      : normal_(normal), across_{normal.unitOrthogonal(), normal.cross(normal.unitOrthogonal())} {
    for (std::size_t k = 0; k < 2; ++k) {
      double least = across_[k].dot(touched.front()), most = least;
      for (const Vector3d& point : touched) {
        least = std::min(least, across_[k].dot(point));
        most = std::max(most, across_[k].dot(point));
      }
      constexpr double kSmallest_mm = 1e-6;  // touches on one line have no bow across it
      middle_[k] = (least + most) / 2, half_[k] = std::max((most - least) / 2, kSmallest_mm);
    }
  }

  const Vector3d& normal() const { return normal_; }
  Vector3d plane_terms(const Vector3d& point) const { return {1, at(point, 0), at(point, 1)}; }
  Vector3d bow_terms(const Vector3d& point) const {
    const double u = at(point, 0), v = at(point, 1);
    return {u * u, u * v, v * v};
  }

 private:
  double at(const Vector3d& point, std::size_t k) const {
    return (across_[k].dot(point) - middle_[k]) / half_[k];
  }

  Vector3d normal_;
  std::array<Vector3d, 2> across_;
  std::array<double, 2> middle_{}, half_{};
};

bool is_unknown_plane(const model::Thing& thing) {
  return thing.artefact.type == model::ArtefactType::kPlane && !thing.in_measuring_frame();
}

/// The readings of the fit rows, except touches of planes of unknown position.
Heights heights_of(const model::Machine& machine, const Measurement& m, const model::ChainRows& chain,
                   const PlaneFrame& frame) {
  const std::vector<model::SetUpOfRow> set_ups = model::set_ups_of(machine, m.states.names(m.states.setup));
  const std::size_t tilts = 3 * set_ups.size();
  Heights list;
  for (const model::Observation& o : m.observations) {
    const std::size_t row = o.row, thing = m.thing_of(row), set_up = m.states.of(m.states.setup, row);
    if (m.check[row] != 0 || model::is_rotation(o.kind)) continue;
    const bool of_thing = thing != model::kNoThing && o.kind != model::ObservationKind::kDistance;
    if (of_thing && is_unknown_plane(m.things[thing])) continue;
    const model::Frame pose = chain.pose(row);
    Vector3d direction = of_thing ? reading_direction(machine, m, o) : Vector3d::Zero();
    std::optional<Vector3d> other;
    if (of_thing && direction.norm() == 0) direction = frame.normal();  // a touch may read along the normal
    if (!of_thing) {
      model::ObservationModel model(m, machine.gravity, set_ups[set_up], pose);
      const std::size_t end = m.other_end.empty() ? model::kNoRow : m.other_end[row];
      if (o.kind == model::ObservationKind::kDistance) {
        if (end == model::kNoRow) continue;
        const model::Frame there = chain.pose(end);
        other = there.origin;
        model.set_other_end(
            model::ObservationModel(m, machine.gravity, set_ups[m.states.of(m.states.setup, end)], there)
                .point());
      }
      direction = model.base_rotation().transpose() * model.gradient(o).point;
    }
    const double share = direction.dot(frame.normal());
    Vector3d bow = share * frame.bow_terms(pose.origin), tilt = share * frame.plane_terms(pose.origin);
    if (other) bow -= share * frame.bow_terms(*other), tilt -= share * frame.plane_terms(*other);
    std::vector<double> nuisance(tilts + m.things.size(), 0.0);
    for (std::size_t k = 0; k < 3; ++k) nuisance[3 * set_up + k] = tilt[static_cast<Index>(k)];
    if (of_thing && !m.things[thing].in_measuring_frame()) nuisance[tilts + thing] = share;
    list.bow.push_back(bow);
    list.nuisance.push_back(std::move(nuisance));
  }
  return list;
}

}  // namespace

bool bow_is_read(const model::Machine& machine, const Measurement& rows, const std::string& plane,
                 const Vector3d& normal) {
  const model::ChainRows chain(machine, rows.states);
  std::vector<Vector3d> touched;
  for (std::size_t row = 0; row < rows.rows(); ++row) {
    const std::size_t thing = rows.thing_of(row);
    if (rows.check[row] == 0 && thing != model::kNoThing && rows.things[thing].label == plane)
      touched.push_back(chain.pose(row).origin);
  }
  if (touched.empty()) return true;
  const Heights heights = heights_of(machine, rows, chain, PlaneFrame(touched, normal));
  if (heights.bow.empty()) return false;
  const auto n = static_cast<Index>(heights.bow.size());
  MatrixXd bow(n, 3), nuisance(n, static_cast<Index>(heights.nuisance.front().size()));
  for (Index i = 0; i < n; ++i) {
    const auto at = static_cast<std::size_t>(i);
    bow.row(i) = heights.bow[at].transpose();
    nuisance.row(i) = Eigen::Map<const Eigen::RowVectorXd>(heights.nuisance[at].data(), nuisance.cols());
  }
  constexpr double kRounding = 1e-9;  // slopes that differ by rounding alone are one slope
  const MatrixXd basis = maths::range_of(nuisance, kRounding);
  bow -= basis * (basis.transpose() * bow);
  // Sum of squares of the slopes of the readings by the least visible bow. Nine heights on a grid of 3 x 3
  // points over the region have 2, and on a region of half the size 0.13: the standard uncertainty of such a
  // bow is three times that of a reading.
  constexpr double kLeast = 0.1;
  return Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d>(Eigen::Matrix3d(bow.transpose() * bow),
                                                        Eigen::EigenvaluesOnly)
             .eigenvalues()[0] >= kLeast;
}

}  // namespace vernier::fit
