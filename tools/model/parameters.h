// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <Eigen/Core>
#include <string>
#include <vector>

#include "tools/model/machine.h"

namespace vernier::model {

enum class ParameterKind : std::uint8_t { kStatic, kScaleFactor, kStation, kBaseShift, kToolShift };

/// True for the parameters of an instrument's set-up. Parameters of an instrument's set-up are not errors of
/// the machine.
constexpr bool is_set_up(ParameterKind kind) {
  return kind == ParameterKind::kBaseShift || kind == ParameterKind::kToolShift;
}

/// A number in the machine file that a fit may change.
struct Parameter {
  std::string name,
      unit;  // name as in the JSON result: `alpha`, `scalefactor.X`, `table.X[100].rY`, `BaseShift[s2].rZ`
  ParameterKind kind = ParameterKind::kStatic;
  std::size_t item = 0;     // index of the static, axis, table, BaseShift or ToolShift
  std::size_t station = 0;  // index of the station, for kStation
  std::size_t column = 0;   // for kStation, kBaseShift and kToolShift: 0..5 = X Y Z rX rY rZ
};

/// Returns the name of a parameter without its station: `table.X.rY` for `table.X[100].rY`. The other names
/// stay as they are.
std::string without_station(std::string parameter);

/// A group of parameters that a fit frees or fixes together: a constant (static), a scale factor, a column of
/// a table, a BaseShift, a ToolShift.
class Freedom {
 public:
  Freedom(ParameterKind kind, std::string name, bool& flag)
      : kind_(kind), name_(std::move(name)), flag_(flag) {}

  ParameterKind kind() const { return kind_; }
  /// Returns the name of the group: `alpha`, `scalefactor.X`, `table.X.rY`, `BaseShift`, `BaseShift[s2]`,
  /// `ToolShift`.
  const std::string& name() const { return name_; }
  /// Returns true if a fit may change this group. The flag of statics, BaseShifts and ToolShifts has the
  /// meaning "hidden"; the flag of other groups has the meaning "free".
  bool is_free() const { return flag_ != says_hidden(); }
  void set_free(bool free) { flag_ = free != says_hidden(); }

 private:
  bool says_hidden() const { return kind_ == ParameterKind::kStatic || is_set_up(kind_); }

  ParameterKind kind_;
  std::string name_;
  bool& flag_;
};

/// Returns all groups of parameters that a fit could free, in the order of ParameterSet. This function
/// contains the only list of the parameter groups. The returned objects contain references to the machine.
std::vector<Freedom> freedoms_of(Machine& machine);

/// The free parameters of a machine, in a fixed order: statics, scale factors, stations, BaseShifts,
/// ToolShifts.
class ParameterSet {
 public:
  ParameterSet() = default;
  /// Constructs the set of all parameters that are free by the rules of FORMATS: statics and BaseShifts
  /// without Hide, and table columns that the attribute `fit` names. A BaseShift for a run that is not in
  /// `runs` is excluded. A BaseShift without `run` and `setup` is excluded if every run has its own
  /// BaseShift. The last station of a periodic table repeats the first station and is not a parameter.
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

/// Returns the index of the BaseShift of a run: its own BaseShift, otherwise the BaseShift without `run` and
/// `setup`. If neither BaseShift exists, the result is nullopt (identity).
std::optional<std::size_t> base_shift_of(const Machine& machine, const std::string& run);
/// Returns the index of the ToolShift of a set-up, by the same rule as base_shift_of().
std::optional<std::size_t> tool_shift_of(const Machine& machine, const std::string& run);

/// BaseShift and ToolShift of the set-up of a row; null means identity.
struct SetUpOfRow {
  const BaseShift* base = nullptr;
  const BaseShift* tool = nullptr;
};
/// Returns the BaseShift and the ToolShift for each set-up name. The returned pointers are valid while the
/// machine exists.
std::vector<SetUpOfRow> set_ups_of(const Machine& machine, const std::vector<std::string>& names);

}  // namespace vernier::model
