// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <array>
#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "tools/model/artefact.h"
#include "tools/model/expression.h"
#include "tools/model/reading_uncertainty.h"
#include "tools/text/error.h"

namespace vernier::model {

/// Names of the six components in tables, BaseShifts and sixdof transforms: X Y Z in mm, rX rY rZ in deg.
inline constexpr std::array<const char*, 6> kSixDofNames = {"X", "Y", "Z", "rX", "rY", "rZ"};
/// The attributes of a DH transform in the order of Transform::dof.
inline constexpr std::array<const char*, 4> kDhNames = {"theta", "d", "a", "alpha"};

struct Static {
  std::string name;
  double value = 0;
  std::optional<double> nominal;
  std::string unit, note;
  bool hidden = false;          // true: a fit does not change this static
  std::optional<double> scale;  // plausible size of (value - nominal), in the unit of the static: the prior
                                // of a fit
  std::size_t line = 0;
};

struct Axis {
  std::string name;
  bool rotary = false;
  std::optional<double> min, max;                  // limits of the position, mm or deg
  std::optional<double> max_correction, max_slew;  // max_correction: unit of the axis; max_slew: unit of the
                                                   // axis per s
  bool rollover = false;
  double scale_factor = 0;
  bool scale_free = false;  // true: the scale factor is a parameter of a fit (a caller sets this flag, not an
                            // attribute of the file)
  std::size_t line = 0;
};

/// An input is a measured quantity that is not an axis. An axis with the attribute Hide is an input too
/// (`hidden_axis`). Role of a logged column, for example a temperature. kGuessed: the role follows from the
/// unit of the column, or from its name if the column has no unit.
enum class InputRole : std::uint8_t { kGuessed, kTemperature, kLoad, kVibration, kSetpoint, kOther };
inline constexpr std::array<const char*, 6> kInputRoleNames = {"",          "temperature", "load",
                                                               "vibration", "set-point",   "other"};
/// Returns the input role with the name `name`; nullopt if no role has this name.
std::optional<InputRole> input_role_named(std::string_view name);

struct Input {
  std::string name, unit;
  double reference = 0;
  std::optional<double> min, max;
  bool hidden_axis = false;
  std::size_t line = 0;
  InputRole role = InputRole::kGuessed;
};

struct Station {
  double loc = 0;
  std::string loc_text;  // text of `loc` in the machine file, for the names of parameters
  std::array<double, 6> value{};
};

enum class Interpolation : std::uint8_t { kLinear, kCubic };

struct Table {
  std::size_t axis = 0;
  Interpolation interpolation = Interpolation::kLinear;
  bool periodic = false;                         // true: the axis has rollover, so that the table repeats
                                                 // after its last station
  std::array<bool, 6> free{};                    // true for each column that a fit may change
  std::array<std::optional<double>, 6> scale{};  // scale of each column, as for a static; mm or deg
  std::vector<Station> stations;                 // `loc` of the stations is strictly increasing
  std::size_t line = 0;
};

/// Position and orientation of an instrument or of its target. A BaseShift in Machine::base_shifts is the
/// base of the chain in the measuring frame. A BaseShift in Machine::tool_shifts is the measured object or
/// the camera in the frame of the tool.
struct BaseShift {
  std::optional<std::string> run;  // label of the run or set-up; no value: a BaseShift without label
  bool of_setup = false;           // true: the machine file has the attribute setup=, not run=
  std::array<double, 6> value{};   // mm, deg
  bool hidden = false;
  std::size_t line = 0;
};

/// A named tool of the machine. `point` is the position of the tool in the frame at the end of the tool
/// branch. The default tool of the machine file is at the origin of that frame and has no name.
struct Tool {
  std::string name;
  std::array<double, 3> point{};  // mm
  std::size_t line = 0;
};

/// The range of positions of an axis in which the machine works.
struct WorkRange {
  std::size_t axis = 0;
  double min = 0, max = 0;  // mm or deg
};

enum class TransformKind : std::uint8_t { kSixDof, kDh };

struct Transform {
  TransformKind kind = TransformKind::kSixDof;
  int n = 0;
  /// Six expressions for sixdof, four for DH (kDhNames); these pointers are never null
  std::array<ExprPtr, 6> dof{};
  std::array<std::string, 6> text{};  // text of each expression as written; "0" if it is absent
  std::size_t line = 0;
  std::size_t dof_count() const { return kind == TransformKind::kSixDof ? 6 : 4; }
  const char* dof_name(std::size_t i) const {
    return kind == TransformKind::kSixDof ? kSixDofNames[i] : kDhNames[i];
  }
};

struct FitRecord;

/// The content of a machine file: chain, statics, axes, inputs, tables. Machine is a value type, which can be
/// copied. The expressions of a Machine are resolved for this Machine.
struct Machine {
  std::string name, file;
  std::array<double, 3> gravity{0, 0, -1};  // unit vector in the chain's base frame
  std::vector<Static> statics;
  std::vector<Axis> axes;
  std::vector<Input> inputs;
  std::vector<Table> tables;
  std::vector<BaseShift> base_shifts;
  /// Mountings of the objects that the tool carries for a measurement: a camera, a board, a reflector. A
  /// mounting is a part of the instrument's set-up and not a part of the chain.
  std::vector<BaseShift> tool_shifts;
  std::vector<Transform> tool, workpiece;
  std::vector<Tool> tools;                       // named tools, in addition to the default tool of the file
  std::vector<Artefact> artefacts;               // objects that a tool point may touch (column `on`)
  std::vector<WorkRange> volume;                 // working ranges of the axes that <volume> names
  std::optional<ReadingUncertainty> instrument;  // uncertainty of the instrument, for measurement files
                                                 // without u
  bool correct_orientation =
      false;  // true: the direction of the tool is corrected too (correct="position orientation")
  std::shared_ptr<const FitRecord> fitted;  // record of the last fit; null if the machine was never fitted
  std::vector<std::string> notes;           // parts of the file that were read but ignored (`multiply` and
                                            // others)

  std::optional<std::size_t> find_static(std::string_view n) const;
  std::optional<std::size_t> find_axis(std::string_view n) const;
  std::optional<std::size_t> find_input(std::string_view n) const;
  const Table* table_of(std::size_t axis) const;
};

/// Returns a copy of the machine with another tool. The tool branch has one more shift at its end, by `point`
/// (mm, in its last frame).
Machine with_tool(const Machine& machine, const std::array<double, 3>& point);

/// Returns the working range of an axis: its range in <volume>, otherwise its min and max. The
/// function work_range() returns nullopt if the machine file has neither <volume> nor min and max
/// for the axis.
std::optional<std::array<double, 2>> work_range(const Machine& machine, std::size_t axis);

/// Returns the meaning of a name in the expressions of a machine; kUnresolved if the name is unknown.
Symbol resolve_name(const Machine& machine, std::string_view name);
/// Parses an expression and resolves its names for a machine. Throws ExpressionError with the unknown name if
/// a name is unknown.
ExprPtr parse_expression_for(const Machine& machine, std::string_view text);
/// Returns the name of a symbol as it is written in expressions.
std::string symbol_name(const Machine& machine, const Symbol& symbol);
/// Returns the unit of a symbol ("mm", "deg/s", ...), for reports and unit checks.
std::string symbol_unit(const Machine& machine, const Symbol& symbol);

/// Returns the machine of the nominal chain (the chain without errors). In the nominal chain, statics have
/// the value `nominal`, and tables and scale factors are 0. A hidden static without `nominal` keeps its
/// value. Inputs and motion are the same as in the given machine. Every BaseShift of the nominal chain is the
/// identity.
Machine nominal_machine(const Machine& machine);

}  // namespace vernier::model
