// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <Eigen/Core>
#include <vector>

#include "tools/model/chain/chain_rows.h"
#include "tools/model/chain/thing_shape.h"
#include "tools/model/machine.h"
#include "tools/model/measurement.h"

namespace vernier::model {

/// Returns the weight of a reading: 1/u, 1 if u is absent. It multiplies the residual.
double weight_of(const Measurement& measurement, const Observation& observation);

/// Derivative of one reading by the unknown values of one touched object.
struct UnknownSlope {
  Eigen::Index first = 0;  // among the unknown values of the cluster
  ThingUnknowns slope;
};

/// The touched objects of a measurement (`same`, `on`), and the readings of each object. Touched objects that
/// are connected by a known length are estimated together: a cluster. So are the places of one artefact whose
/// radius has an uncertainty: they have one radius. Keeps a reference to the measurement.
class Things {
 public:
  Things(const Machine& machine, const Measurement& measurement);

  bool empty() const { return measurement_.things.empty(); }
  std::size_t clusters() const { return clusters_.size(); }
  /// Index of the cluster of the reading; kNoThing: the reading is of no touched object.
  std::size_t cluster_of(const Observation& observation) const;
  Eigen::Index unknowns(std::size_t cluster) const { return clusters_[cluster].unknowns; }
  const std::vector<std::size_t>& things(std::size_t cluster) const { return clusters_[cluster].things; }
  /// Indices of the unknown values of a touched object within its cluster, in their order. They follow each
  /// other; only a radius may be elsewhere, because another place of the artefact has it.
  const std::vector<Eigen::Index>& unknowns_of_thing(std::size_t thing) const { return at_[thing]; }
  /// Indices of the readings of a cluster, in their order.
  const std::vector<std::size_t>& readings(std::size_t cluster) const { return clusters_[cluster].readings; }
  /// Index of the constant (static) with the radius of the tip that touches the object; kNoThing: no such
  /// constant.
  std::size_t tip_of(std::size_t thing) const { return tip_[thing]; }
  /// Weight of a reading in the estimate of its object: check rows count only for an object that no fit row
  /// touched.
  double weight(std::size_t observation) const { return weight_[static_cast<Eigen::Index>(observation)]; }
  /// Number of unknown values that the fit rows determine: they cost degrees of freedom.
  std::size_t eliminated() const;
  const Measurement& measurement() const { return measurement_; }

 private:
  struct Cluster {
    std::vector<std::size_t> things, readings;
    Eigen::Index unknowns = 0;
  };
  void connect();
  void weigh();

  const Measurement& measurement_;
  std::vector<std::size_t> cluster_, tip_;  // of each thing
  std::vector<std::vector<Eigen::Index>> at_;
  std::vector<Cluster> clusters_;
  Eigen::VectorXd weight_;
};

/// Returns the pseudo-inverse of a symmetric matrix without negative eigenvalues (normal equations of unequal
/// scales).
Eigen::MatrixXd pseudo_inverse(const Eigen::MatrixXd& matrix);

/// Returns the tool point of each row that touched an object, in the frame of the object, mm; zero for other
/// rows.
std::vector<Eigen::Vector3d> points_at_things(const Machine& machine, const Measurement& measurement,
                                              const ChainRows& chain);

/// The touched objects of a measurement for one machine: every unknown value has its best estimate for this
/// machine.
class ThingsAt {
 public:
  /// chain: the chain of the machine at the states of the measurement.
  ThingsAt(const Things& things, const Machine& machine, const ChainRows& chain);

  struct Reading {
    double predicted = 0;                                // mm
    Eigen::Vector3d by_point = Eigen::Vector3d::Zero();  // in the frame of the thing
    double by_tip = 0;
    std::vector<UnknownSlope> by_unknown;
  };
  /// Reading of a touched object (`same`, `on`), or a distance between two unknown points.
  Reading read(const Observation& observation) const;
  /// Reading of a touched object with the tool point elsewhere (in the frame of the object, mm). The object
  /// stays.
  TouchReading read_at(const Observation& observation, const Eigen::Vector3d& point) const;

  const ThingShape& shape(std::size_t thing) const { return shapes_[thing]; }
  /// Sum over the readings of w^2 b b^T and of the precision of the known values: k x k.
  Eigen::MatrixXd normal(std::size_t cluster) const;
  /// Known values minus their estimates, and their precision, for all unknown values of a cluster.
  struct Known {
    Eigen::VectorXd precision, off;
  };
  Known known(std::size_t cluster) const;
  /// Contribution of the known values to the cost: weighted sum of the squares of (known value - estimate).
  double known_cost() const;

 private:
  double tip(std::size_t thing) const;
  double cost(std::size_t cluster) const;
  void estimate(std::size_t cluster);
  void descend(std::size_t cluster);
  void move(std::size_t cluster, const Eigen::VectorXd& step);
  std::vector<ThingShape> shapes_of(std::size_t cluster) const;
  void restore(std::size_t cluster, const std::vector<ThingShape>& shapes);

  const Things& things_;
  const Machine& machine_;
  std::vector<Eigen::Vector3d> point_;  // of each row that met a thing, in the frame of the thing
  std::vector<ThingShape> shapes_;
};

}  // namespace vernier::model
