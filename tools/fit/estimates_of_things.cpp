// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/fit/estimates_of_things.h"

#include <cmath>

#include "tools/maths/factors.h"
#include "tools/model/chain/prediction.h"

namespace vernier::fit {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;

Eigen::Vector3d stds(const MatrixXd& covariance) { return covariance.diagonal().cwiseMax(0).cwiseSqrt(); }

}  // namespace

std::vector<ThingEstimate> estimates_of_things(const FitResult& result, const model::Measurement& m) {
  std::vector<ThingEstimate> list;
  for (const model::EstimatedThing& one : model::estimate_things(result.machine, m, result.parameters)) {
    const model::Thing& thing = m.things[one.thing];
    const model::Artefact& artefact = thing.artefact;
    MatrixXd covariance = result.variance_factor * one.own;
    if (result.covariance.size() > 0) covariance += one.follows * result.covariance * one.follows.transpose();
    ThingEstimate estimate;
    estimate.name = thing.label;
    estimate.setup = thing.setup;
    estimate.type =
        thing.is_unknown_point() ? "same" : model::kArtefactTypes[static_cast<std::size_t>(artefact.type)];
    estimate.in_measuring_frame = thing.in_measuring_frame();
    estimate.touches = one.touches;
    estimate.place_mm = one.shape.point;
    const auto places = model::place_directions(artefact, one.shape);
    const Index count = places.cols();
    estimate.u_place_mm = stds(places * covariance.topLeftCorner(count, count) * places.transpose());
    Index at = count;
    if (artefact.has_direction()) {
      estimate.direction = one.shape.axes.col(2);
      estimate.u_direction_deg = 0;
      if (!artefact.direction) {
        estimate.u_direction_deg =
            maths::kDegPerRad * std::sqrt(std::max({0.0, covariance(at, at), covariance(at + 1, at + 1)}));
        at += 2;
      }
    }
    if (artefact.has_radius()) {
      estimate.radius_mm = one.shape.radius;
      estimate.u_radius_mm = at < covariance.rows() ? std::sqrt(std::max(0.0, covariance(at, at))) : 0;
    }
    list.push_back(std::move(estimate));
  }
  return list;
}

}  // namespace vernier::fit
