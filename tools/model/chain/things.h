// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <Eigen/Core>
#include <vector>

#include "tools/model/chain/chain_rows.h"
#include "tools/model/chain/thing_shape.h"
#include "tools/model/machine.h"
#include "tools/model/measurement.h"

namespace vernier::model {

/// Returns the weight of a reading: 1/u, or 1 if u is absent. The residual of a reading is
/// multiplied by its weight.
double weight_of(const Measurement& measurement, const Observation& observation);

/// Derivative of one reading by the unknown values of one touched object.
struct UnknownSlope {
  Eigen::Index first = 0;  // index of the first of these values among the unknown values of the cluster
  ThingUnknowns slope;
};

/// The touched objects of a measurement (`same`, `on`), and the readings of each object. Touched objects that
/// a known length connects are estimated together. A group of objects that known lengths connect is called a
/// cluster. The positions of one artefact in several set-ups are also one cluster if the radius has an
/// uncertainty, because they have the same radius. The object Things keeps a reference to the measurement.
class Things {
 public:
  Things(const Machine& machine, const Measurement& measurement);

  bool empty() const { return measurement_.things.empty(); }
  std::size_t clusters() const { return clusters_.size(); }
  /// Returns the index of the cluster to which a reading belongs; kNoThing if the reading is not of a touched
  /// object.
  std::size_t cluster_of(const Observation& observation) const;
  Eigen::Index unknowns(std::size_t cluster) const { return clusters_[cluster].unknowns; }
  const std::vector<std::size_t>& things(std::size_t cluster) const { return clusters_[cluster].things; }
  /// Returns the indices of the unknown values of a touched object within its cluster, in their order. The
  /// indices are consecutive, except for a radius that several positions of the artefact have in common.
  const std::vector<Eigen::Index>& unknowns_of_thing(std::size_t thing) const { return at_[thing]; }
  /// Returns the indices of the readings of a cluster, in their order.
  const std::vector<std::size_t>& readings(std::size_t cluster) const { return clusters_[cluster].readings; }
  /// Returns the index of the static with the radius of the tip that touches the object; kNoThing if there is
  /// no such static.
  std::size_t tip_of(std::size_t thing) const { return tip_[thing]; }
  /// Returns the weight of a reading in the estimate of its touched object. A check row has a weight only if
  /// no fit row touched the object.
  double weight(std::size_t observation) const { return weight_[static_cast<Eigen::Index>(observation)]; }
  /// Returns the number of unknown values that the fit rows determine. The degrees of freedom of a fit
  /// decrease by the number of unknown values of touched objects.
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
  std::vector<std::size_t> cluster_, tip_;  // for each touched object
  std::vector<std::vector<Eigen::Index>> at_;
  std::vector<Cluster> clusters_;
  Eigen::VectorXd weight_;
};

/// Returns the pseudo-inverse of a symmetric matrix without negative eigenvalues (normal equations with
/// unknowns of unequal scales).
Eigen::MatrixXd pseudo_inverse(const Eigen::MatrixXd& matrix);

/// Returns the tool point of each row that touched an object, in the frame of the object, mm; zero for other
/// rows.
std::vector<Eigen::Vector3d> points_at_things(const Machine& machine, const Measurement& measurement,
                                              const ChainRows& chain);

/// The touched objects of a measurement for one machine. Every unknown value has its best estimate for this
/// machine.
class ThingsAt {
 public:
  /// `chain`: the chain of the machine, evaluated at the states of the measurement.
  ThingsAt(const Things& things, const Machine& machine, const ChainRows& chain);

  struct Reading {
    double predicted = 0;                                // predicted reading, mm
    Eigen::Vector3d by_point = Eigen::Vector3d::Zero();  // derivative by the tool point, in the frame of the
                                                         // touched object
    double by_tip = 0;
    std::vector<UnknownSlope> by_unknown;
  };
  /// Returns the predicted reading of a touched object (`same`, `on`), or of a distance between two unknown
  /// points.
  Reading read(const Observation& observation) const;
  /// Returns the predicted reading of a touched object for another tool point (in the frame of the object,
  /// mm). The touched object does not move.
  TouchReading read_at(const Observation& observation, const Eigen::Vector3d& point) const;

  const ThingShape& shape(std::size_t thing) const { return shapes_[thing]; }
  /// Returns the normal matrix of a cluster's unknown values: the sum over its readings of w^2 b b^T, plus
  /// the precision of the known values, k x k.
  Eigen::MatrixXd normal(std::size_t cluster) const;
  /// Known values minus their estimates (`off`), and their precision, for all unknown values of a cluster.
  struct Known {
    Eigen::VectorXd precision, off;
  };
  Known known(std::size_t cluster) const;
  /// Returns the contribution of the known values to the cost: the weighted sum of squares of (known value -
  /// estimate).
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
  std::vector<Eigen::Vector3d> point_;  // tool point of each row that touched an object, in the frame of the
                                        // object
  std::vector<ThingShape> shapes_;
};

}  // namespace vernier::model
