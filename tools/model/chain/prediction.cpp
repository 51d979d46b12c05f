// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/model/chain/prediction.h"

#include <cmath>

#include "tools/model/chain/chain_rows.h"
#include "tools/model/chain/linearizer.h"
#include "tools/model/chain/observation_model.h"
#include "tools/model/chain/things.h"

namespace vernier::model {
namespace {

/// Derivatives of the unknown values of a cluster by the parameters, k x parameters: their estimates follow
/// the parameters (Golub and Pereyra 1973, variable projection, in the form of Kaufman).
Eigen::MatrixXd follows(const Things& things, const ThingsAt& at, std::size_t cluster,
                        const SparseRows& raw) {
  const Measurement& m = things.measurement();
  Eigen::MatrixXd mixed = Eigen::MatrixXd::Zero(things.unknowns(cluster), raw.cols());
  for (const std::size_t i : things.readings(cluster)) {
    const double square = std::pow(things.weight(i), 2);
    if (square == 0) continue;
    const ThingsAt::Reading reading = at.read(m.observations[i]);
    for (SparseRows::InnerIterator entry(raw, static_cast<Eigen::Index>(i)); entry; ++entry)
      for (const UnknownSlope& one : reading.by_unknown)
        mixed.col(entry.col()).segment(one.first, one.slope.size()) += square * entry.value() * one.slope;
  }
  return -(pseudo_inverse(at.normal(cluster)) * mixed);
}

/// Replaces the derivatives at fixed things by those at things that follow the parameters.
void eliminate(const Things& things, const ThingsAt& at, Linearisation& linear) {
  const Measurement& m = things.measurement();
  const Eigen::Index n = linear.jacobian.cols();
  std::vector<Eigen::MatrixXd> of_cluster;
  std::vector<double> known;
  std::vector<Eigen::VectorXd> known_rows;
  for (std::size_t cluster = 0; cluster < things.clusters(); ++cluster) {
    of_cluster.push_back(follows(things, at, cluster, linear.jacobian));
    const ThingsAt::Known held = at.known(cluster);
    for (Eigen::Index k = 0; k < held.off.size(); ++k) {
      if (held.precision[k] == 0) continue;
      const double weight = std::sqrt(held.precision[k]);
      known.push_back(weight * held.off[k]);
      known_rows.emplace_back(weight * of_cluster.back().row(k).transpose());
    }
  }
  std::vector<int> outer{0}, columns;
  std::vector<double> values;
  for (std::size_t i = 0; i < m.observations.size(); ++i) {
    const std::size_t cluster = things.cluster_of(m.observations[i]);
    Eigen::VectorXd dense;
    if (cluster != kNoThing) {
      dense = Eigen::VectorXd::Zero(n);
      for (const UnknownSlope& one : at.read(m.observations[i]).by_unknown)
        dense += of_cluster[cluster].middleRows(one.first, one.slope.size()).transpose() * one.slope;
    }
    for (SparseRows::InnerIterator entry(linear.jacobian, static_cast<Eigen::Index>(i)); entry; ++entry) {
      if (dense.size() > 0) {
        dense[entry.col()] += entry.value();
        continue;
      }
      columns.push_back(static_cast<int>(entry.col()));
      values.push_back(entry.value());
    }
    for (Eigen::Index k = 0; k < dense.size(); ++k) {
      if (dense[k] == 0) continue;
      columns.push_back(static_cast<int>(k));
      values.push_back(dense[k]);
    }
    outer.push_back(static_cast<int>(columns.size()));
  }
  const SparseRows projected =
      Eigen::Map<const SparseRows>(linear.jacobian.rows(), n, static_cast<Eigen::Index>(columns.size()),
                                   outer.data(), columns.data(), values.data());
  linear.jacobian = projected;
  linear.known_residual.resize(static_cast<Eigen::Index>(known.size()));
  linear.known_jacobian.resize(static_cast<Eigen::Index>(known.size()), n);
  for (std::size_t k = 0; k < known.size(); ++k) {
    linear.known_residual[static_cast<Eigen::Index>(k)] = known[k];
    linear.known_jacobian.row(static_cast<Eigen::Index>(k)) = known_rows[k].transpose();
  }
}

}  // namespace

Prediction predict_with_things(const Machine& machine, const Measurement& m) {
  const ChainRows chain(machine, m.states);
  const Things things(machine, m);
  const ThingsAt at(things, machine, chain);
  const std::vector<SetUpOfRow> set_ups = set_ups_of(machine, m.states.names(m.states.setup));
  Prediction result;
  result.predicted.resize(static_cast<Eigen::Index>(m.observations.size()));
  for (std::size_t k = 0; k < m.observations.size();) {
    const std::size_t row = m.observations[k].row;
    const Frame pose = chain.pose(row);
    ObservationModel model(m, machine.gravity, set_ups[m.states.of(m.states.setup, row)], pose);
    if (const std::size_t other = m.other_end.empty() ? kNoRow : m.other_end[row]; other != kNoRow) {
      const Frame there = chain.pose(other);
      model.set_other_end(
          ObservationModel(m, machine.gravity, set_ups[m.states.of(m.states.setup, other)], there).point());
    }
    for (; k < m.observations.size() && m.observations[k].row == row; ++k) {
      const Observation& o = m.observations[k];
      result.predicted[static_cast<Eigen::Index>(k)] =
          things.cluster_of(o) == kNoThing ? model.predicted(o) : at.read(o).predicted;
    }
  }
  result.known_cost = at.known_cost();
  return result;
}

Eigen::VectorXd predict(const Machine& machine, const Measurement& m) {
  return predict_with_things(machine, m).predicted;
}

Linearisation linearise(const Machine& machine, const Measurement& m, const ParameterSet& parameters) {
  return linearise(machine, Linearizer(machine, m, parameters), m.observations.size(), parameters.size());
}

namespace {

/// Linearises all rows at fixed things, then calls end(things, result).
template <class End>
Linearisation linearised(const Machine& machine, const Linearizer& linearizer, std::size_t observations,
                         std::size_t parameters, const End& end) {
  Linearisation result;
  result.predicted.resize(static_cast<Eigen::Index>(observations));
  std::vector<int> outer{0}, columns;
  std::vector<double> values;
  const auto take = [&](const RowLinear& row) {
    for (Eigen::Index o = 0; o < row.predicted.size(); ++o) {
      result.predicted[static_cast<Eigen::Index>(row.first_observation) + o] = row.predicted[o];
      for (const ParameterGroup& group : row.groups)
        for (const auto& [first, weight] : group.first_weight)
          for (Eigen::Index k = 0; k < group.width; ++k) {
            columns.push_back(static_cast<int>(first + k));
            values.push_back(weight * row.gradient(group.slot + k, o));
          }
      outer.push_back(static_cast<int>(columns.size()));
    }
  };
  linearizer.each_row(machine, take, [&](const ThingsAt& at) {
    result.jacobian = Eigen::Map<const SparseRows>(
        static_cast<Eigen::Index>(observations), static_cast<Eigen::Index>(parameters),
        static_cast<Eigen::Index>(columns.size()), outer.data(), columns.data(), values.data());
    if (!linearizer.things().empty()) end(at, result);
  });
  return result;
}

}  // namespace

Linearisation linearise(const Machine& machine, const Linearizer& linearizer, std::size_t observations,
                        std::size_t parameters) {
  return linearised(machine, linearizer, observations, parameters,
                    [&](const ThingsAt& at, Linearisation& raw) { eliminate(linearizer.things(), at, raw); });
}

HeldLinearisation linearise_held(const Machine& machine, const Measurement& m,
                                 const ParameterSet& parameters) {
  HeldLinearisation result;
  const Linearizer linearizer(machine, m, parameters);
  const Things& things = linearizer.things();
  std::vector<Eigen::Index> first;  // of the unknown values of each cluster
  Eigen::Index count = 0;
  for (std::size_t cluster = 0; cluster < things.clusters(); ++cluster) {
    first.push_back(count);
    count += things.unknowns(cluster);
  }
  result.by_unknown = Eigen::MatrixXd::Zero(static_cast<Eigen::Index>(m.observations.size()), count);
  result.precision = Eigen::VectorXd::Zero(count);
  const auto take = [&](const ThingsAt& at, const Linearisation&) {
    for (std::size_t cluster = 0; cluster < things.clusters(); ++cluster) {
      result.precision.segment(first[cluster], things.unknowns(cluster)) = at.known(cluster).precision;
      for (const std::size_t i : things.readings(cluster))
        for (const UnknownSlope& one : at.read(m.observations[i]).by_unknown)
          result.by_unknown.row(static_cast<Eigen::Index>(i))
              .segment(first[cluster] + one.first, one.slope.size()) += one.slope.transpose();
    }
  };
  result.linear = linearised(machine, linearizer, m.observations.size(), parameters.size(), take);
  return result;
}

std::vector<EstimatedThing> estimate_things(const Machine& machine, const Measurement& m,
                                            const ParameterSet& parameters) {
  std::vector<EstimatedThing> list;
  const Linearizer linearizer(machine, m, parameters);
  const Things& things = linearizer.things();
  std::vector<std::size_t> touches(m.things.size(), 0);
  for (const Observation& o : m.observations)
    if (is_of_thing(o.kind) && format::component_of(o.kind) == 0 && m.check[o.row] == 0)
      ++touches[m.thing[o.row]];
  const auto take = [&](const ThingsAt& at, const Linearisation& raw) {
    for (std::size_t cluster = 0; cluster < things.clusters(); ++cluster) {
      const Eigen::MatrixXd own = pseudo_inverse(at.normal(cluster));
      const Eigen::MatrixXd follow = follows(things, at, cluster, raw.jacobian);
      for (const std::size_t thing : things.things(cluster)) {
        if (touches[thing] == 0) continue;
        const std::vector<Eigen::Index>& values = things.unknowns_of_thing(thing);
        list.push_back(
            {thing, touches[thing], at.shape(thing), own(values, values), follow(values, Eigen::all)});
      }
    }
  };
  linearised(machine, linearizer, m.observations.size(), parameters.size(), take);
  return list;
}

}  // namespace vernier::model
