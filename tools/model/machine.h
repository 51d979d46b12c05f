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

/// X Y Z rX rY rZ in mm and deg: the columns of a table, of BaseShift, of a sixdof transform.
inline constexpr std::array<const char*, 6> kSixDofNames = {"X", "Y", "Z", "rX", "rY", "rZ"};
/// The attributes of a DH transform in the order of Transform::dof.
inline constexpr std::array<const char*, 4> kDhNames = {"theta", "d", "a", "alpha"};

struct Static {
  std::string name;
  double value = 0;
  std::optional<double> nominal;
  std::string unit, note;
  bool hidden = false;          // not free in a fit
  std::optional<double> scale;  // plausible size of value - nominal, own unit: the prior of a fit
  std::size_t line = 0;
};

struct Axis {
  std::string name;
  bool rotary = false;
  std::optional<double> min, max;                  // mm or deg
  std::optional<double> max_correction, max_slew;  // axis unit; axis unit per s
  bool rollover = false;
  double scale_factor = 0;
  bool scale_free = false;  // the scale factor is a parameter of a fit (set by a caller, not by an attribute)
  std::size_t line = 0;
};

/// A measured quantity that is no axis. An axis with Hide is an input too (`hidden_axis`). Role of a logged
/// column. kGuessed: the role follows from the unit, or from the name if there is no unit.
enum class InputRole : std::uint8_t { kGuessed, kTemperature, kLoad, kVibration, kSetpoint, kOther };
inline constexpr std::array<const char*, 6> kInputRoleNames = {"",          "temperature", "load",
                                                               "vibration", "set-point",   "other"};
/// Returns the role of that name, or nullopt for another word.
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
  std::string loc_text;  // as written, for parameter names
  std::array<double, 6> value{};
};

enum class Interpolation : std::uint8_t { kLinear, kCubic };

struct Table {
  std::size_t axis = 0;
  Interpolation interpolation = Interpolation::kLinear;
  bool periodic = false;                         // the axis has rollover: periodic over first..last station
  std::array<bool, 6> free{};                    // columns freed in a fit
  std::array<std::optional<double>, 6> scale{};  // as of a static, one per column; mm or deg
  std::vector<Station> stations;                 // loc strictly increasing
  std::size_t line = 0;
};

/// Place of an instrument. In Machine::base_shifts: chain base in the measuring frame. In
/// Machine::tool_shifts: the measured object or the camera, in the frame of the tool.
struct BaseShift {
  std::optional<std::string> run;  // label of its set-up; no value: the plain BaseShift
  bool of_setup = false;           // the file says setup=, not run=
  std::array<double, 6> value{};   // mm, deg
  bool hidden = false;
  std::size_t line = 0;
};

/// A tool with a name. `point` is the position of the tool in the frame at the end of the tool branch. The
/// tool of the file is at the origin of that frame and has no name.
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
  std::array<ExprPtr, 6> dof{};  // six for sixdof, the first four for DH (kDhNames); never null for those
  std::array<std::string, 6> text{};  // as written ("0" where absent)
  std::size_t line = 0;
  std::size_t dof_count() const { return kind == TransformKind::kSixDof ? 6 : 4; }
  const char* dof_name(std::size_t i) const {
    return kind == TransformKind::kSixDof ? kSixDofNames[i] : kDhNames[i];
  }
};

struct FitRecord;

/// A machine file: chain, statics, axes, inputs, tables. Machine is a value type. Expressions are resolved
/// against the machine that contains them.
struct Machine {
  std::string name, file;
  std::array<double, 3> gravity{0, 0, -1};  // unit vector in the chain's base frame
  std::vector<Static> statics;
  std::vector<Axis> axes;
  std::vector<Input> inputs;
  std::vector<Table> tables;
  std::vector<BaseShift> base_shifts;
  /// Mounting of what the tool carries for a measurement: a camera, a board, a reflector. It is part of the
  /// set-up of the instrument and not of the chain.
  std::vector<BaseShift> tool_shifts;
  std::vector<Transform> tool, workpiece;
  std::vector<Tool> tools;                       // in addition to the tool of the file
  std::vector<Artefact> artefacts;               // what a tool point may touch: column `on`
  std::vector<WorkRange> volume;                 // of the axes that <volume> names
  std::optional<ReadingUncertainty> instrument;  // for files that state no u
  bool correct_orientation =
      false;  // correct="position orientation": the direction of the tool is corrected too
  std::shared_ptr<const FitRecord> fitted;  // result of its last fit; null: never fitted
  std::vector<std::string> notes;           // what was read but ignored (`multiply` and the like)

  std::optional<std::size_t> find_static(std::string_view n) const;
  std::optional<std::size_t> find_axis(std::string_view n) const;
  std::optional<std::size_t> find_input(std::string_view n) const;
  const Table* table_of(std::size_t axis) const;
};

/// Returns the machine with another tool: the tool branch gets one more shift at its end, by `point` (mm, in
/// its last frame).
Machine with_tool(const Machine& machine, const std::array<double, 3>& point);

/// Returns the working range of an axis: <volume>, else its min and max. work_range returns nullopt if the
/// file has neither.
std::optional<std::array<double, 2>> work_range(const Machine& machine, std::size_t axis);

/// Returns the meaning of a name in expressions of this machine; kUnresolved if the name has no meaning.
Symbol resolve_name(const Machine& machine, std::string_view name);
/// Parses and resolves an expression for this machine. Throws ExpressionError with the unknown name.
ExprPtr parse_expression_for(const Machine& machine, std::string_view text);
/// Returns the name of a symbol as expressions write it.
std::string symbol_name(const Machine& machine, const Symbol& symbol);
/// Returns the unit of a symbol ("mm", "deg/s", ...), for reports and unit checks.
std::string symbol_unit(const Machine& machine, const Symbol& symbol);

/// Returns the machine of the nominal chain. Statics are at `nominal` (a hidden static without `nominal` at
/// its value); tables and scalefactor are 0. Inputs and motion are unchanged. BaseShift is the identity.
Machine nominal_machine(const Machine& machine);

}  // namespace vernier::model
