// SPDX-License-Identifier: GPL-3.0-or-later
// What the units of this room hand to each other: the derived error equation, the fixed-point program, its
// bounds, the compiled machine.
#pragma once
#include <array>
#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "comp/shares.h"
#include "tools/compile/symbolic/graph.h"

namespace vernier::compile {

using NodeVector = std::array<NodeId, 3>;

/// A part of the exact deviation that the equation omits, with its bound over the declared ranges.
struct Neglected {
  std::string what;                // "second order of rZ in transform 3 (tool)"
  double bound_mm;                 // norm
  std::array<double, 3> along_mm;  // each component in the frame of the deviation
};

/// The deviation along one axis. Moving the axis by `value` has the same effect on the tool point as the
/// deviation.
struct AxisDeviation {
  std::size_t axis;
  NodeId value;  // mm or deg
  std::array<double, 3>
      row;          // converts the components of a vector in the frame of the deviation into one, at most
  double row_norm;  // converts a norm in the workpiece frame, mm, into a bound along this axis
  double lever;     // mm of tool point per mm or deg of the axis, at most
};

/// The least squares x = J' w, w = adj(J J') deviation / max(det(J J'), floor). Used for a machine whose
/// correction also moves rotary axes. Rows of J: directions of the tool point; columns: axes, each divided by
/// its lever.
struct LeastSquares {
  /// True if there are fewer axes than directions in which they move the tool point, with other directions at
  /// each pose (a telescope). If `nearest` is true, K below is J'. x = (J'J)^-1 J' deviation brings the tool
  /// point nearest to its target; the component across the axes remains. If `nearest` is false, K is J, and x
  /// = J' (J J')^-1 deviation is the smallest motion.
  bool nearest = false;
  std::vector<std::vector<NodeId>> jacobian, square, adjugate;  // K, K K', adj(K K')
  std::vector<NodeId> deviation, weights;                       // right side and result of (K K')^-1
  std::vector<double> lever;                                    // mm per axis unit
  NodeId determinant = 0, reciprocal = 0;
  double floor = 0;      // if det(K K') is below it, the correction decreases to 0
  double trace = 0;      // sum of the squares of J's singular values, at most
  double largest = 0;    // |adj(K K')| at most
  double gain = 0;       // |K' (K K')^-1| at most, where the correction is not reduced
  double spread_mm = 0;  // |deviation| at most
};

/// Motion of the nominal tool point with an axis: mm per mm or per deg, in the frame of the
/// deviation.
struct AxisColumn {
  std::size_t axis;
  NodeVector direction;
  double norm;  // its length at most
};

/// Contribution of one term of the chain to the deviation, and thereby to each output.
struct EffectPart {
  std::string name;  // "X of transform 2 (tool): BX*dirX"
  NodeVector deviation;
  std::vector<NodeId> outputs;  // as Derivation::outputs
};

/// The correction of the tool's direction by rotary axes. Vectors of Orientation have length 1, so deviations
/// are in rad.
struct Orientation {
  std::vector<std::size_t> axes;  // one or two axes that tilt the tool
  std::vector<double> lever;      // rad of direction per deg of the axis, at most
  std::vector<NodeId> values;     // the deviation along each of them, deg: the board subtracts it
  std::vector<double>
      limit_deg;           // |value| at most: the axis' maxcorrection, or the largest value of the solution
  NodeVector deviation{};  // of the direction, in a frame of the chain
  double spread = 0;       // its length at most
  std::vector<Neglected> neglected;
  NodeId determinant = 0;        // of J'J, J the motion of the direction with the axes, each by its lever
  double floor = 0;              // damped if the determinant is below it
  std::optional<double> damped;  // share of the poses; nullopt: it is proved that no pose is damped
  double gain = 0;               // |(J'J)^-1 J'| at most, if not damped
  std::vector<EffectPart> parts;
};

/// One of several evaluations of the deviation. The error equation is evaluated again at the corrected
/// position. The error of the next evaluation depends only on the distance between the two positions, not on
/// the accuracy of the present evaluation.
struct Evaluation {
  std::vector<NodeId> values;        // as the outputs', of the outputs before the axes of the direction
  std::vector<NodeId> orientation;   // as Orientation::values
  std::vector<double> range;         // |value| at most
  std::vector<Neglected> neglected;  // of the position
  std::vector<Neglected> neglected_direction;
};

/// The symbolic error equation of a machine.
struct Derivation {
  Graph graph;
  std::vector<AxisDeviation> outputs;
  std::vector<AxisColumn> columns;        // of the corrected axes
  NodeVector deviation{};                 // of the tool point, mm, in a frame of the chain
  double spread_mm = 0;                   // its length at most
  std::map<std::size_t, double> turning;  // axes that rotate that frame: rad per mm or deg
  std::map<NodeId, double> table_slopes;  // of each table value: mm or deg per axis unit at most
  std::vector<Neglected> neglected;
  std::vector<EffectPart> parts;   // their sum is the deviation
  std::vector<std::string> notes;  // information for the user about the correction, one sentence each
  std::optional<LeastSquares> least_squares;
  std::optional<Orientation> orientation;  // its axes are the last outputs
  std::vector<Evaluation> before;          // evaluations before the last one
  NodeVector last_direction{};             // deviation of the direction in the last evaluation
  std::optional<double>
      fading;  // share of the poses where it decreases to 0 because the axes do not reach every direction
  std::vector<std::string> switching;  // comparisons and the like: the bound is valid away from their steps
};

/// Source of an error of the fixed-point program.
enum class ErrorSource : std::uint8_t { kRounding, kTable, kFunction, kChannel, kLag };
constexpr std::size_t kErrorSourceCount = 5;  // of ErrorSource

/// Properties of one register: format, range and sources of its error. The value of a register is count /
/// 2^fraction_bits in the unit of the machine file.
struct Register {
  std::string name;  // unique, a C++ identifier
  int fraction_bits = 0;
  Interval range;        // of the exact value
  double error = 0;      // bound of |register - exact value|, same unit
  double own_error = 0;  // the part that this register adds
  ErrorSource source = ErrorSource::kRounding;
  bool given = false;  // its users refer to its actual value, so its error is not propagated
  double addend = 0;   // of a sum of products: its constant, exact
  struct Use {
    std::uint32_t from;
    double gain;  // |d this / d from| at most
  };
  std::vector<Use> uses;
};

/// A table of the program that owns its memory (comp/error_table.h defines the records).
struct LoweredTable {
  std::string name;
  std::uint16_t columns = 0, degree = 1;
  std::uint32_t pieces = 0;
  std::uint32_t grid_multiplier = 0, grid_shift = 0;
  std::vector<std::int32_t> records;

  ErrorTable view() const { return {records.data(), pieces, columns, degree, grid_multiplier, grid_shift}; }
};

/// A fixed-point program that owns its arrays (`Program` in comp/compensator.h only refers to arrays).
struct LoweredProgram {
  std::vector<std::int32_t> constants;
  std::vector<Channel> channels;
  std::vector<Instruction> instructions;
  std::vector<ProductTerm> terms;
  std::vector<LoweredTable> tables;
  std::vector<Wrap> wraps;
  std::vector<Output> outputs;
  std::uint32_t lag_count = 0;
  std::vector<Register> registers;              // one per constant, channel and result
  std::map<NodeId, std::uint32_t> register_of;  // of the nodes that have one
  std::vector<ValueRange> ranges;               // of the registers, as the verifier computes them

  std::uint32_t first_result() const {
    return static_cast<std::uint32_t>(constants.size() + channels.size());
  }
  std::uint32_t results_of(const Instruction& step) const {
    return step.op == OpCode::kLookUp ? tables[step.b].columns : step.op == OpCode::kSineCosine ? 2u : 1u;
  }
};

/// The shares of the effects in the corrections. The shares are an equation whose channels are registers of
/// the tick.
struct LoweredShares {
  std::vector<std::int32_t> constants;
  std::vector<std::uint16_t> sources;
  std::vector<Instruction> instructions;
  std::vector<ProductTerm> terms;
  std::vector<Share> shares;
  std::vector<std::string> names;  // name of the effect, one per share
  std::vector<double> largest;     // |share| at most, mm or deg
  std::size_t left_out = 0;        // number of shares for which the image has no space
};

/// One cause of error in an output, with its bound.
struct Contribution {
  std::string name;
  std::string source;  // "linearisation", "table", "function", "rounding", "input", "lag"
  double bound_um = 0;
};

/// Proved bound of |fixed-point correction - exact inverse solution| along one axis. Valid over the declared
/// ranges, away from the steps of comparisons, and before magnitude limit, ramp and slew limit. The exact
/// inverse solution is c with p_actual(q + c) = p_nominal(q). For a rotary axis the bound is the motion of
/// the tool point at the longest lever of the axis. With least squares the bound is that of all axes
/// together. An axis that corrects the tool's direction has only `deviation_deg`. The linear axes correct the
/// point at the position of this axis; TiltBound states the remaining tilt.
struct OutputBound {
  std::string axis;
  double total_um = 0;
  double linearisation_um = 0, table_um = 0, function_um = 0, rounding_um = 0, input_um = 0, lag_um = 0;
  /// Remaining error of the correction after one step, or two steps, of Newton's iteration. Cause: the
  /// deviation at the corrected position differs, and the nominal motion is not a straight line. A value of
  /// second_order_um is included in the total. No value: no useful bound exists (least squares near singular
  /// poses).
  std::optional<double> second_order_um;
  double deviation_um = 0;                  // largest |deviation| over the declared ranges, by intervals
  std::optional<double> deviation_deg;      // of an axis that corrects the tool's direction: at most
  std::vector<Contribution> contributions;  // largest first, all of them
};

/// Remaining tilt of the tool in poses where the correction of the tilt is neither damped nor limited.
struct TiltBound {
  double deviation_deg = 0;     // tilt without correction, at most
  double fixed_point_deg = 0;   // by the program and its neglected terms
  double second_order_deg = 0;  // as OutputBound::second_order_um
  double left_deg() const { return fixed_point_deg + second_order_deg; }
};

struct CompileOptions {
  std::uint32_t tick_us = 1000;      // cycle time that lags and slew limits are computed for
  std::optional<double> budget_um;   // largest error bound allowed on any axis
  std::uint32_t accepted_rules = 0;  // of the safety sheet, recorded in the image
  /// If the error after one step exceeds this value, the deviation is evaluated again at the
  /// corrected position.
  double most_second_order_um = 0.1;
  double most_second_order_deg = 2e-4;  // the same of the tool's direction: a tenth of the usual requirement
};

struct CompiledMachine {
  std::vector<std::uint8_t> image;
  LoweredProgram program;
  LoweredShares shares;
  std::vector<OutputBound> bounds;
  std::optional<LeastSquares> least_squares;  // if rotary axes are corrected too
  std::optional<Orientation> orientation;     // if the direction of the tool is corrected
  std::optional<TiltBound> tilt;
  int evaluations = 1;                 // of the deviation: more if one step is not sufficient
  std::size_t operations_of_one = 0;   // per tick, with one evaluation
  std::vector<std::string> switching;  // comparisons and the like: the bound is valid away from their steps
  std::vector<std::string> notes;      // information for the user about the correction, one sentence each
  std::string header, source;          // equation.h, equation.cpp
  std::uint64_t fingerprint = 0;
};

}  // namespace vernier::compile
