// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <cstddef>
#include <unordered_map>
#include <utility>
#include <vector>

#include "tools/model/machine.h"
#include "tools/model/states.h"
#include "tools/model/station_table.h"

namespace vernier::model {

/// A value of an expression: a number for each state, or one number for all states.
class Value {
 public:
  Value() = default;
  explicit Value(double all) : all_(all) {}
  explicit Value(Column each) : each_(std::move(each)), varies_(true) {}
  bool varies() const { return varies_; }
  double operator[](std::size_t i) const { return varies_ ? each_[static_cast<Eigen::Index>(i)] : all_; }
  bool is_zero() const { return !varies_ && all_ == 0; }
  bool all_finite() const;
  Column column(std::size_t count) const;

 private:
  double all_ = 0;
  Column each_;
  bool varies_ = false;
};

/// A value and its derivatives with respect to the quantities that a fit may change. Each derivative has a
/// key, which identifies the parameter. The key of a static is its index. The key of a table value is
/// statics.size() + axis * 6 + column. The station weights of a table are applied later, because
/// all columns of the table have the same weights. The key of a scale factor is statics.size() + 6
/// * axes.size() + axis.
struct ValueAndSlopes {
  Value value;
  std::vector<std::pair<std::size_t, Value>> by;
};

/// Evaluates expressions of one machine at all states together, with derivatives if the caller requests them.
/// The evaluation is column by column, because the function lag needs all rows of a run.
class Evaluator {
 public:
  /// `active`: flag for each key; true if the derivative by this parameter is requested. If `active` is
  /// empty, no derivatives are computed.
  Evaluator(const Machine& machine, const States& states, std::vector<char> active = {});

  ValueAndSlopes operator()(const Expr& expr);

  std::size_t table_key(std::size_t table_value) const { return machine_.statics.size() + table_value; }
  std::size_t scale_key(std::size_t axis) const {
    return machine_.statics.size() + 6 * machine_.axes.size() + axis;
  }

 private:
  ValueAndSlopes symbol(const Symbol& symbol);
  Value table_value(std::size_t index);
  Value run_is(const std::string& label) const;
  ValueAndSlopes lag(const ValueAndSlopes& input, const ValueAndSlopes& tau) const;
  bool active(std::size_t key) const { return key < active_.size() && active_[key] != 0; }

  const Machine& machine_;
  const States& states_;
  std::vector<char> active_;
  std::unordered_map<std::size_t, std::vector<Column>> table_columns_;  // the six columns of each axis' table
};

/// Returns the value of an expression of the machine at every state.
Column evaluate(const Machine& machine, const Expr& expr, const States& states);

/// True if an expression of the machine uses the function lag. The rows of a machine with lag must be
/// evaluated together, in time order.
bool uses_lag(const Machine& machine);

}  // namespace vernier::model
