// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <Eigen/Core>
#include <array>
#include <memory>
#include <utility>
#include <vector>

#include "tools/model/chain/chain_rows.h"
#include "tools/model/chain/things.h"
#include "tools/model/machine.h"
#include "tools/model/measurement.h"
#include "tools/model/parameters.h"

namespace vernier::model {

/// Adjacent parameters whose derivatives are one common factor (weight) times successive rows of
/// RowLinear::gradient. The parameters are the free columns of a table (one
/// weight for each station that contributes at a row), statics, or the components of a BaseShift or a
/// ToolShift (weight 1).
struct ParameterGroup {
  Eigen::Index slot = 0, width = 0;                           // slot, width: first row and number of rows of
                                                              // RowLinear::gradient
  std::vector<std::pair<Eigen::Index, double>> first_weight;  // index of the parameter in the first column,
                                                              // and its weight
};

/// The linearised prediction of one row of a measurement: d predicted(o) / d parameter(first + k) = sum over
/// the groups of weight * gradient(slot + k, o).
struct RowLinear {
  std::size_t first_observation = 0;
  Eigen::VectorXd predicted;           // predicted observations of the row, mm or deg
  Eigen::MatrixXd gradient;            // observations x slots
  std::vector<ParameterGroup> groups;  // in the order of increasing parameter index
};

/// Linearises the rows of a measurement one by one. A station table is represented by a few station weights
/// times six columns. Data that do not depend on the values of the parameters (stations and weights of every
/// row) are computed once. The Linearizer keeps a reference to `measurement`.
class Linearizer {
 public:
  Linearizer(const Machine& machine, const Measurement& measurement, const ParameterSet& parameters);

  /// Calls visit(const RowLinear&) for every row that has an observation. `machine` is the machine of the
  /// constructor with other parameter values. Throws InputError if the value of an expression is not finite.
  template <class Visit>
  void each_row(const Machine& machine, const Visit& visit) const {
    each_row(machine, visit, [](const ThingsAt&) {});
  }
  /// Works as the function each_row with two arguments, and then calls end(const ThingsAt&) with the
  /// estimates of the touched objects for this machine. The derivatives of the rows are for fixed values of
  /// the touched objects.
  template <class Visit, class End>
  void each_row(const Machine& machine, const Visit& visit, const End& end) const {
    Pass pass(*this, machine);
    while (pass.next()) visit(pass.row());
    end(pass.things());
  }
  const Things& things() const { return things_; }

 private:
  struct TableGroup {
    std::size_t axis = 0;
    ParameterGroup group;                                  // first_weight is set for each row
    std::vector<std::size_t> start;                        // index of the first weight of each row in
                                                           // `weights`
    std::vector<std::pair<Eigen::Index, double>> weights;  // index of the first parameter of the station, and
                                                           // weight of the station
  };
  class Pass {
   public:
    Pass(const Linearizer& all, const Machine& machine);
    bool next();
    const RowLinear& row() const { return is_joined_ ? joined_ : row_; }
    const ThingsAt& things() const { return things_; }

   private:
    /// Computes the derivatives of a row's observations with respect to the pose of row `at`. `at` is `row`
    /// itself, or the row at the other end of a distance reading. `other_end`: position of the other end of
    /// the distance, at which nothing is evaluated.
    void fill(std::size_t row, std::size_t at, const Eigen::Vector3d& other_end);
    Eigen::Vector3d point_at(std::size_t row) const;
    /// Adds the influence of the pose at the other end of a distance reading. After join_other_end(), every
    /// parameter of both rows has a separate slot.
    void join_other_end(std::size_t row, std::size_t other);
    const SetUpOfRow& set_up_of(std::size_t row) const {
      const States& states = all_.measurement_.states;
      return set_ups_[states.of(states.setup, row)];
    }
    /// Adds the group of six set-up parameters that begins at `slot`. If the set-up parameters are
    /// fixed, no group of parameters is added.
    void add_set_up(const std::vector<std::array<Eigen::Index, 6>>& parameters,
                    const std::vector<BaseShift>& shifts, const BaseShift* shift, Eigen::Index slot);

    const Linearizer& all_;
    const Machine& machine_;
    ChainRows chain_;
    ThingsAt things_;
    std::vector<Eigen::Index> slot_of_key_;
    std::vector<SetUpOfRow> set_ups_;
    std::vector<Twist> twists_;
    std::size_t at_ = 0;
    RowLinear row_, joined_;
    bool is_joined_ = false;
  };

  const Measurement& measurement_;
  Things things_;
  std::vector<std::size_t> start_;         // index of the first observation of each row
  std::vector<char> active_;               // flags of the requested derivatives, by key of Evaluator
  std::vector<Eigen::Index> slot_of_key_;  // slot of each parameter, by key of Evaluator
  std::vector<ParameterGroup> static_groups_;
  std::vector<TableGroup> tables_;
  std::vector<std::array<Eigen::Index, 6>> base_parameter_,
      tool_parameter_;      // for each BaseShift and ToolShift: index of the parameter of each component; -1:
                            // fixed
  Eigen::Index slots_ = 0;  // number of slots without the twelve slots of the set-up
};

}  // namespace vernier::model
