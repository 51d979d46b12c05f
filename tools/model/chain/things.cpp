// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/model/chain/things.h"

#include <cmath>
#include <limits>
#include <map>
#include <numeric>
#include <string>

#include "tools/maths/decompositions.h"
#include "tools/model/parameters.h"

namespace vernier::model {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::Vector3d;
using Eigen::VectorXd;

/// Below this share of the largest, an eigenvalue of scaled normal equations is rounding.
constexpr double kUnseenShare = 1e-12;
/// Steps of one estimate, at most. A mean needs one, a sphere five.
constexpr int kMostSteps = 60;
/// Of the cost and of one reading: a smaller decrease moves no value by more than a billionth of its
/// standard uncertainty.
constexpr double kNegligibleDecrease = 1e-18;

/// Shares of one root: things that a length connects.
std::size_t root_of(std::vector<std::size_t>& parent, std::size_t at) {
  while (parent[at] != at) at = parent[at] = parent[parent[at]];
  return at;
}

/// Slopes of unknown values at these indices: in one piece, or with the last one apart.
std::vector<UnknownSlope> slopes(const std::vector<Index>& at, const ThingUnknowns& slope) {
  const Index count = slope.size();
  if (count == 0) return {};
  if (at.back() == at.front() + count - 1) return {{at.front(), slope}};
  return {{at.front(), slope.head(count - 1)}, {at.back(), slope.tail(1)}};
}

}  // namespace

double weight_of(const Measurement& m, const Observation& o) {
  const double u = uncertainty_of(m, o);
  return u > 0 ? 1 / u : 1;
}

MatrixXd pseudo_inverse(const MatrixXd& matrix) {
  if (matrix.size() == 0) return matrix;
  const VectorXd shrink =
      matrix.diagonal().unaryExpr([](double d) { return d > 0 ? 1 / std::sqrt(d) : 0.0; });
  const MatrixXd scaled = shrink.asDiagonal() * matrix * shrink.asDiagonal();
  const Eigen::SelfAdjointEigenSolver<MatrixXd> solver(scaled);
  const VectorXd& values = solver.eigenvalues();
  const double least = kUnseenShare * std::max(1e-300, values.size() > 0 ? values[values.size() - 1] : 0);
  const VectorXd inverse = values.unaryExpr([&](double v) { return v > least ? 1 / v : 0.0; });
  return shrink.asDiagonal() * solver.eigenvectors() * inverse.asDiagonal() *
         solver.eigenvectors().transpose() * shrink.asDiagonal();
}

Things::Things(const Machine& machine, const Measurement& m) : measurement_(m) {
  if (empty()) return;
  for (const Thing& thing : m.things) {
    const auto tip = thing.artefact.tip.empty() ? std::nullopt : machine.find_static(thing.artefact.tip);
    tip_.push_back(tip.value_or(kNoThing));
  }
  connect();
  for (std::size_t i = 0; i < m.observations.size(); ++i)
    if (const std::size_t cluster = cluster_of(m.observations[i]); cluster != kNoThing)
      clusters_[cluster].readings.push_back(i);
  weigh();
}

void Things::connect() {
  const Measurement& m = measurement_;
  std::vector<std::size_t> parent(m.things.size());
  std::iota(parent.begin(), parent.end(), 0);
  for (const Observation& o : m.observations)
    if (o.kind == ObservationKind::kDistance && m.is_between_things(o.row))
      parent[root_of(parent, m.thing[o.row])] = root_of(parent, m.thing[m.other_end[o.row]]);
  std::map<std::string, std::size_t> place_of;  // first place of each artefact whose radius is uncertain
  std::vector<std::size_t> radius_of(m.things.size(), kNoThing);
  for (std::size_t thing = 0; thing < m.things.size(); ++thing) {
    if (m.things[thing].artefact.u_radius <= 0) continue;
    const auto [first, is_new] = place_of.try_emplace(m.things[thing].label, thing);
    if (is_new) continue;
    radius_of[thing] = first->second;
    parent[root_of(parent, thing)] = root_of(parent, first->second);
  }
  std::vector<std::size_t> number(parent.size(), kNoThing);
  for (std::size_t thing = 0; thing < parent.size(); ++thing) {
    std::size_t& at = number[root_of(parent, thing)];
    if (at == kNoThing) {
      at = clusters_.size();
      clusters_.emplace_back();
    }
    Cluster& cluster = clusters_[at];
    cluster_.push_back(at);
    cluster.things.push_back(thing);
    std::vector<Index> places(static_cast<std::size_t>(unknowns_of(m.things[thing].artefact)));
    std::iota(places.begin(), places.end(), cluster.unknowns);
    cluster.unknowns += static_cast<Index>(places.size());
    if (radius_of[thing] != kNoThing) places.back() = at_[radius_of[thing]].back(), --cluster.unknowns;
    at_.push_back(std::move(places));
  }
}

void Things::weigh() {
  const Measurement& m = measurement_;
  std::vector<char> in_fit(m.things.size(), 0);
  for (const Observation& o : m.observations)
    if (is_of_thing(o.kind) && m.check[o.row] == 0) in_fit[m.thing[o.row]] = 1;
  weight_ = VectorXd::Zero(static_cast<Index>(m.observations.size()));
  for (const Cluster& cluster : clusters_)
    for (const std::size_t i : cluster.readings) {
      const Observation& o = m.observations[i];
      const bool alone = is_of_thing(o.kind) && in_fit[m.thing[o.row]] == 0;
      if (m.check[o.row] == 0 || alone) weight_[static_cast<Index>(i)] = weight_of(m, o);
    }
}

std::size_t Things::eliminated() const {
  std::size_t sum = 0;
  for (const Cluster& cluster : clusters_) {
    std::size_t fitted = 0, unknown = 0;
    for (const std::size_t i : cluster.readings)
      fitted += measurement_.check[measurement_.observations[i].row] == 0 ? 1 : 0;
    for (const std::size_t thing : cluster.things) {
      const Artefact& artefact = measurement_.things[thing].artefact;
      unknown += static_cast<std::size_t>((known_values(artefact, {}).precision.array() == 0).count());
    }
    sum += std::min(fitted, unknown);
  }
  return sum;
}

std::size_t Things::cluster_of(const Observation& o) const {
  const bool between = o.kind == ObservationKind::kDistance && measurement_.is_between_things(o.row);
  return is_of_thing(o.kind) || between ? cluster_[measurement_.thing[o.row]] : kNoThing;
}

std::vector<Vector3d> points_at_things(const Machine& machine, const Measurement& m, const ChainRows& chain) {
  std::vector<Vector3d> point(m.rows(), Vector3d::Zero());
  for (std::size_t row = 0; row < m.rows(); ++row) {
    if (m.thing[row] == kNoThing) continue;
    point[row] = chain.pose(row).origin;
    if (!m.things[m.thing[row]].in_measuring_frame()) continue;
    const auto shift =
        base_shift_of(machine, m.states.names(m.states.setup)[m.states.of(m.states.setup, row)]);
    if (!shift) continue;
    const Frame base = sixdof_frame(machine.base_shifts[*shift].value);
    point[row] = base.rotation * point[row] + base.origin;
  }
  return point;
}

ThingsAt::ThingsAt(const Things& things, const Machine& machine, const ChainRows& chain)
    : things_(things), machine_(machine) {
  if (things.empty()) return;
  const Measurement& m = things.measurement();
  point_ = points_at_things(machine, m, chain);
  shapes_.resize(m.things.size());
  for (std::size_t cluster = 0; cluster < things.clusters(); ++cluster) estimate(cluster);
}

double ThingsAt::tip(std::size_t thing) const {
  const std::size_t item = things_.tip_of(thing);
  return item == kNoThing ? 0 : machine_.statics[item].value;
}

TouchReading ThingsAt::read_at(const Observation& o, const Vector3d& point) const {
  const std::size_t thing = things_.measurement().thing[o.row];
  return touch(things_.measurement().things[thing].artefact, shapes_[thing], point, tip(thing),
               format::component_of(o.kind));
}

ThingsAt::Reading ThingsAt::read(const Observation& o) const {
  const Measurement& m = things_.measurement();
  Reading reading;
  const std::size_t thing = m.thing[o.row];
  if (o.kind == ObservationKind::kDistance) {
    const std::size_t other = m.thing[m.other_end[o.row]];
    const Vector3d arm = shapes_[thing].point - shapes_[other].point;
    reading.predicted = arm.norm();
    const Vector3d along = arm.stableNormalized();
    reading.by_unknown = {{things_.unknowns_of_thing(thing).front(), along},
                          {things_.unknowns_of_thing(other).front(), -along}};
    return reading;
  }
  const TouchReading one = read_at(o, point_[o.row]);
  reading.predicted = one.value;
  reading.by_point = one.by_point;
  reading.by_tip = one.by_tip;
  reading.by_unknown = slopes(things_.unknowns_of_thing(thing), one.by_unknown);
  return reading;
}

ThingsAt::Known ThingsAt::known(std::size_t cluster) const {
  const Index k = things_.unknowns(cluster);
  Known all{VectorXd::Zero(k), VectorXd::Zero(k)};
  for (const std::size_t thing : things_.things(cluster)) {
    const KnownValues one = known_values(things_.measurement().things[thing].artefact, shapes_[thing]);
    all.precision(things_.unknowns_of_thing(thing)) = one.precision;
    all.off(things_.unknowns_of_thing(thing)) = one.off;
  }
  return all;
}

double ThingsAt::known_cost() const {
  double sum = 0;
  for (std::size_t cluster = 0; cluster < things_.clusters(); ++cluster) {
    const Known one = known(cluster);
    sum += one.off.cwiseAbs2().dot(one.precision);
  }
  return sum;
}

double ThingsAt::cost(std::size_t cluster) const {
  const Measurement& m = things_.measurement();
  const Known one = known(cluster);
  double sum = one.off.cwiseAbs2().dot(one.precision);
  for (const std::size_t i : things_.readings(cluster))
    sum += std::pow(things_.weight(i) * (m.observations[i].value - read(m.observations[i]).predicted), 2);
  return sum;
}

MatrixXd ThingsAt::normal(std::size_t cluster) const {
  const Measurement& m = things_.measurement();
  MatrixXd sum = known(cluster).precision.asDiagonal();
  for (const std::size_t i : things_.readings(cluster)) {
    const double square = std::pow(things_.weight(i), 2);
    if (square == 0) continue;
    const Reading reading = read(m.observations[i]);
    for (const UnknownSlope& a : reading.by_unknown)
      for (const UnknownSlope& b : reading.by_unknown)
        sum.block(a.first, b.first, a.slope.size(), b.slope.size()) += square * a.slope * b.slope.transpose();
  }
  return sum;
}

void ThingsAt::move(std::size_t cluster, const VectorXd& step) {
  for (const std::size_t thing : things_.things(cluster)) {
    const Artefact& artefact = things_.measurement().things[thing].artefact;
    const ThingUnknowns own = step(things_.unknowns_of_thing(thing));
    move_thing(artefact, own, shapes_[thing]);
  }
}

/// Starts every thing from the tool points that touched it, and keeps the start with the lowest cost.
void ThingsAt::estimate(std::size_t cluster) {
  const Measurement& m = things_.measurement();
  const Vector3d down(machine_.gravity[0], machine_.gravity[1], machine_.gravity[2]);
  std::vector<std::vector<ThingShape>> starts;
  std::size_t most = 1;
  for (const std::size_t thing : things_.things(cluster)) {
    std::vector<Vector3d> points, all;
    for (const std::size_t i : things_.readings(cluster)) {
      const Observation& o = m.observations[i];
      if (m.thing[o.row] != thing || !is_of_thing(o.kind) || format::component_of(o.kind) != 0) continue;
      all.push_back(point_[o.row]);
      if (things_.weight(i) > 0) points.push_back(point_[o.row]);
    }
    if (points.empty()) points = all;
    if (points.empty()) points = {Vector3d::Zero()};  // only named by rows that were left out
    starts.push_back(thing_starts(m.things[thing].artefact, points, tip(thing), down));
    most = std::max(most, starts.back().size());
  }
  double least = std::numeric_limits<double>::infinity();
  std::vector<ThingShape> best;
  for (std::size_t start = 0; start < most; ++start) {
    for (std::size_t k = 0; k < starts.size(); ++k)
      shapes_[things_.things(cluster)[k]] = starts[k][std::min(start, starts[k].size() - 1)];
    descend(cluster);
    const double now = most > 1 ? cost(cluster) : 0;
    // A lower cost by rounding does not choose another start.
    if (!best.empty() && !(now < least * (1 - 1e-6) - 1e-9)) continue;
    least = now;
    best = shapes_of(cluster);
  }
  restore(cluster, best);
}

/// Gauss-Newton, damped (Levenberg-Marquardt) if a step fails.
void ThingsAt::descend(std::size_t cluster) {
  const Index k = things_.unknowns(cluster);
  if (k == 0) return;
  const Measurement& m = things_.measurement();
  double now = cost(cluster), damping = 0;
  // Of the equations (Levenberg): the first damping, its step, and the damping at which no step is left.
  constexpr double kFirstDamping = 1e-3, kTimesDamping = 10, kMostDamping = 1e12;
  for (int i = 0; i < kMostSteps; ++i) {
    const MatrixXd equations = normal(cluster);
    const Known held = known(cluster);
    VectorXd gradient = held.precision.cwiseProduct(held.off);
    for (const std::size_t at : things_.readings(cluster)) {
      const Observation& o = m.observations[at];
      const double square = std::pow(things_.weight(at), 2);
      if (square == 0) continue;
      const Reading reading = read(o);
      for (const UnknownSlope& one : reading.by_unknown)
        gradient.segment(one.first, one.slope.size()) += square * (o.value - reading.predicted) * one.slope;
    }
    bool moved = false;
    while (!moved && damping <= kMostDamping) {
      MatrixXd damped = equations;
      damped.diagonal() *= 1 + damping;
      const VectorXd step = pseudo_inverse(damped) * gradient;
      const double decrease = gradient.dot(step);
      const std::vector<ThingShape> before = shapes_of(cluster);
      move(cluster, step);
      const double next = cost(cluster);
      const bool done = decrease <= kNegligibleDecrease * (now + 1);
      if (next <= now || done) {
        moved = true;
        now = std::min(now, next);
        damping = damping > kFirstDamping ? damping / kTimesDamping : 0;
        if (done) return;
        continue;
      }
      restore(cluster, before);
      // Rounding of a large sum: the step is as good as its predecessor.
      if (decrease <= 1e-12 * now) return;
      damping = damping > 0 ? damping * kTimesDamping : kFirstDamping;
    }
    if (!moved) return;
  }
}

std::vector<ThingShape> ThingsAt::shapes_of(std::size_t cluster) const {
  std::vector<ThingShape> shapes;
  for (const std::size_t thing : things_.things(cluster)) shapes.push_back(shapes_[thing]);
  return shapes;
}

void ThingsAt::restore(std::size_t cluster, const std::vector<ThingShape>& shapes) {
  for (std::size_t k = 0; k < shapes.size(); ++k) shapes_[things_.things(cluster)[k]] = shapes[k];
}

}  // namespace vernier::model
