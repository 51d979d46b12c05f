// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <Eigen/Core>
#include <string>
#include <vector>

#include "tools/model/machine.h"

namespace vernier::model {

enum class ParameterKind : std::uint8_t { kStatic, kScaleFactor, kStation, kBaseShift, kToolShift };

/// True for parameters of the set-up of an instrument: they are no errors of the machine.
constexpr bool is_set_up(ParameterKind kind) {
  return kind == ParameterKind::kBaseShift || kind == ParameterKind::kToolShift;
}

/// One number of a machine that a fit may change.
struct Parameter {
  std::string name,
      unit;  // as in the JSON result: `alpha`, `scalefactor.X`, `table.X[100].rY`, `BaseShift[s2].rZ`
  ParameterKind kind = ParameterKind::kStatic;
  std::size_t item = 0;     // index of the static, axis, table, BaseShift or ToolShift
  std::size_t station = 0;  // kStation
  std::size_t column = 0;   // kStation, kBaseShift, kToolShift: 0..5 = X Y Z rX rY rZ
};

/// A group of parameters that a fit frees or fixes together: a constant (static), a scale factor, a column of
/// a table, a BaseShift, a ToolShift.
class Freedom {
 public:
  Freedom(ParameterKind kind, std::string name, bool& flag)
      : kind_(kind), name_(std::move(name)), flag_(flag) {}

  ParameterKind kind() const { return kind_; }
  /// `alpha`, `scalefactor.X`, `table.X.rY`, `BaseShift`, `BaseShift[s2]`, `ToolShift`.
  const std::string& name() const { return name_; }
  /// Statics and BaseShifts store whether they are hidden; the other units store whether they are free.
  bool is_free() const { return flag_ != says_hidden(); }
  void set_free(bool free) { flag_ = free != says_hidden(); }

 private:
  bool says_hidden() const { return kind_ == ParameterKind::kStatic || is_set_up(kind_); }

  ParameterKind kind_;
  std::string name_;
  bool& flag_;
};

/// Returns all units that a fit could free, in the order of ParameterSet. freedoms_of is the only list of
/// such units. The entries point into the machine.
std::vector<Freedom> freedoms_of(Machine& machine);

/// The free parameters of a machine, in a fixed order: statics, scale factors, stations, BaseShifts,
/// ToolShifts.
class ParameterSet {
 public:
  ParameterSet() = default;
  /// Contains all parameters that are free by FORMATS: statics and BaseShifts without Hide, table columns
  /// named by `fit`. A BaseShift whose run is not in `runs` is excluded. The BaseShift without `run` and
  /// `setup` is excluded if every run has a separate BaseShift. In a periodic table the last station repeats
  /// the first station and is not a parameter.
  ParameterSet(const Machine& machine, const std::vector<std::string>& runs);

  std::size_t size() const { return list_.size(); }
  const Parameter& operator[](std::size_t i) const { return list_[i]; }
  auto begin() const { return list_.begin(); }
  auto end() const { return list_.end(); }

  Eigen::VectorXd get(const Machine& machine) const;
  void set(Machine& machine, const Eigen::VectorXd& values) const;

 private:
  std::vector<Parameter> list_;
};

/// Returns the BaseShift of a run: the BaseShift for this run, or else the BaseShift without `run` and
/// `setup`, or else nullopt (identity).
std::optional<std::size_t> base_shift_of(const Machine& machine, const std::string& run);
/// Returns the ToolShift of a set-up, as base_shift_of() returns its BaseShift.
std::optional<std::size_t> tool_shift_of(const Machine& machine, const std::string& run);

/// The two places of an instrument in the set-up of a row; null: identity.
struct SetUpOfRow {
  const BaseShift* base = nullptr;
  const BaseShift* tool = nullptr;
};
/// Returns the places for each set-up name. The pointers point into the machine.
std::vector<SetUpOfRow> set_ups_of(const Machine& machine, const std::vector<std::string>& names);

}  // namespace vernier::model
