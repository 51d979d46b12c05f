// SPDX-License-Identifier: GPL-3.0-or-later
// Types that the source files of tools/compile have in common: the derived error equation, the fixed-point
// program, its bounds, and the compiled machine.
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

/// A rotation about a coordinate axis (0..2: X Y Z) by an angle times the factor `sense`.
struct Turn {
  int axis = 0;
  NodeId angle_deg = 0;
  double sense = 1;
};

/// A part of the exact deviation that the error equation omits, with its bound over the declared ranges.
struct Neglected {
  std::string what;                // description: "second order of rZ in transform 3 (tool)"
  double bound_mm;                 // bound of the norm
  std::array<double, 3> along_mm;  // bound of each component in the frame of the deviation
  /// The omitted part as a vector: (R(turn) - 1) times the vector `of`, or of this rotation only the part of
  /// one order. The nominal rotations `to_frame`, one after the other, bring it into the frame of the
  /// deviation.
  Turn turn = {};
  NodeVector of = {};
  int order = 0;  // of the sine or cosine of the angle; 0: the whole rotation
  std::vector<Turn> to_frame = {};
  double slack_mm = 0;  // upper limit of the difference between this vector and the omitted part
};

/// The deviation of the tool point, expressed as the motion of one axis. A motion of the axis by `value` has
/// the same effect on the tool point as the deviation.
struct AxisDeviation {
  std::size_t axis;
  NodeId value;               // mm or deg
  std::array<double, 3> row;  // upper limits of the factors that convert the components of a vector in the
                              // frame of the deviation to a motion of this axis
  double row_norm;  // factor that converts a norm in the workpiece frame, mm, to a bound along this axis
  double lever;     // largest motion of the tool point per unit of the axis: mm per mm or deg
};

/// Least-squares solution for the axis motions: x = J' w with w = adj(J J') deviation / max(det(J J'),
/// floor). Least squares are used for a machine whose correction also moves rotary axes. The rows of J are
/// directions of the tool point. The columns of J are axes, each divided by its lever.
struct LeastSquares {
  /// True if there are fewer axes than directions in which they move the tool point, and these directions
  /// change with the pose (for example a telescope). If `nearest` is true, the matrix K is J'. With
  /// `nearest`, x = (J'J)^-1 J' deviation brings the tool point nearest to its target, and the component
  /// that the axes cannot reach remains. If `nearest` is false, the matrix K is J. Without `nearest`, x = J'
  /// (J J')^-1 deviation is the smallest motion of the axes that removes the deviation.
  bool nearest = false;
  std::vector<std::vector<NodeId>> jacobian, square, adjugate;  // the matrices K, K K', adj(K K')
  std::vector<NodeId> deviation, weights;                       // right side and result of (K K')^-1
  std::vector<double> lever;                                    // lever of each axis, mm per unit of the axis
  NodeId determinant = 0, reciprocal = 0;
  double floor = 0;      // limit for det(K K'); below the limit the correction decreases to 0
  double trace = 0;      // upper limit of the sum of squares of J's singular values
  double largest = 0;    // upper limit of |adj(K K')|
  double gain = 0;       // upper limit of |K' (K K')^-1| where the correction is not reduced
  double spread_mm = 0;  // upper limit of |deviation|
};

/// Motion of the nominal tool point with an axis: mm per mm or per deg, in the frame of the
/// deviation.
struct AxisColumn {
  std::size_t axis;
  NodeVector direction;
  double norm;  // upper limit of the length of `direction`
};

/// Contribution of one term of the chain to the deviation, and with it to each output.
struct EffectPart {
  std::string name;  // name of the term: "X of transform 2 (tool): BX*dirX"
  NodeVector deviation;
  std::vector<NodeId> outputs;  // contribution to each output, in the order of Derivation::outputs
};

/// Correction of the tool's direction by rotary axes. Direction vectors have the length 1. The deviations of
/// direction vectors are therefore in rad.
struct Orientation {
  std::vector<std::size_t> axes;  // one or two axes that tilt the tool
  std::vector<double> lever;      // lever of each axis: upper limit of the change of direction, rad per deg
                                  // of the axis
  std::vector<NodeId> values;     // deviation as motion of each axis, deg; the board subtracts this value
  std::vector<double> limit_deg;  // upper limit of |value|: the attribute maxcorrection of the axis, or the
                                  // largest value of the solution
  NodeVector deviation{};         // deviation of the direction, in a frame of the chain
  double spread = 0;              // upper limit of the length of `deviation`
  std::vector<Neglected> neglected;
  NodeId determinant = 0;        // determinant of J'J; J is the motion of the direction with the axes, each
                                 // divided by its lever
  double floor = 0;              // limit for the determinant; the correction is damped below this limit
  std::optional<double> damped;  // share of the poses in which the correction is damped; nullopt: it is
                                 // proved that there is no such pose
  double gain = 0;               // upper limit of |(J'J)^-1 J'| where the correction is not damped
  std::vector<EffectPart> parts;
};

/// One of several evaluations of the deviation, each at the position that the previous evaluation corrected.
/// After a correction, the error equation is evaluated again at the corrected position. The error of the next
/// evaluation depends only on the distance between its position and the present position, not on the accuracy
/// of the present evaluation.
struct Evaluation {
  std::vector<NodeId> values;        // as the values of the outputs; only the outputs before the axes that
                                     // correct the direction
  std::vector<NodeId> orientation;   // as Orientation::values
  std::vector<double> range;         // upper limits of |value|
  std::vector<Neglected> neglected;  // omitted terms of the position
  std::vector<Neglected> neglected_direction;
};

/// The symbolic error equation of a machine.
struct Derivation {
  Graph graph;
  std::vector<AxisDeviation> outputs;
  std::vector<AxisColumn> columns;        // motion of the nominal tool point with each corrected axis
  NodeVector deviation{};                 // deviation of the tool point, mm, in a frame of the chain
  double spread_mm = 0;                   // upper limit of the length of `deviation`
  std::map<std::size_t, double> turning;  // axes that rotate the frame of the deviation: rad per mm or deg
  std::map<NodeId, double> table_slopes;  // upper limit of the slope of each table value: mm or deg per unit
                                          // of the axis
  std::vector<Neglected> neglected;
  std::vector<EffectPart> parts;   // contributions of the terms; their sum is the deviation
  std::vector<std::string> notes;  // information for the user about the correction, one sentence each
  std::optional<LeastSquares> least_squares;
  std::optional<Orientation> orientation;  // its axes are the last axes of `outputs`
  std::vector<Evaluation> before;          // all evaluations except the last one
  NodeVector last_direction{};             // deviation of the tool's direction in the last evaluation
  std::optional<double> fading;  // share of the poses in which the correction decreases to 0, because the
                                 // axes do not reach every direction
  std::vector<std::string> switching;  // comparisons and other expressions with a step; the error bound is
                                       // valid away from these steps
};

/// Cause of a difference between the fixed-point program and exact arithmetic.
enum class ErrorSource : std::uint8_t { kRounding, kTable, kFunction, kChannel, kLag };
constexpr std::size_t kErrorSourceCount = 5;  // number of error sources

/// Properties of one register of the fixed-point program: format, range and sources of its error. The value
/// of a register is count / 2^fraction_bits in the unit of the machine file.
struct Register {
  std::string name;  // unique name, a C++ identifier
  int fraction_bits = 0;
  Interval range;        // range of the exact value
  double error = 0;      // bound of |register - exact value|, in the unit of the register
  double own_error = 0;  // part of the error that this register itself adds
  ErrorSource source = ErrorSource::kRounding;
  bool given = false;  // true: other registers use its actual value, so that its error is not propagated
  double addend = 0;   // exact constant in a sum of products
  struct Use {
    std::uint32_t from;
    double gain;  // upper limit of |d this / d from|
  };
  std::vector<Use> uses;
};

/// A table of the program with its own memory (the format of `records` is in comp/error_table.h).
struct LoweredTable {
  std::string name;
  std::uint16_t columns = 0, degree = 1;
  std::uint32_t pieces = 0;
  std::uint32_t grid_multiplier = 0, grid_shift = 0;
  std::vector<std::int32_t> records;

  ErrorTable view() const { return {records.data(), pieces, columns, degree, grid_multiplier, grid_shift}; }
};

/// A fixed-point program with its own memory (`Program` in comp/compensator.h only refers to arrays).
struct LoweredProgram {
  std::vector<std::int32_t> constants;
  std::vector<Channel> channels;
  std::vector<Instruction> instructions;
  std::vector<ProductTerm> terms;
  std::vector<LoweredTable> tables;
  std::vector<Wrap> wraps;
  std::vector<Output> outputs;
  std::uint32_t lag_count = 0;
  std::vector<Register> registers;              // one register for each constant, channel and result
  std::map<NodeId, std::uint32_t> register_of;  // register of each node that has a register
  std::vector<ValueRange> ranges;               // ranges of the registers, as the verifier computes them

  std::uint32_t first_result() const {
    return static_cast<std::uint32_t>(constants.size() + channels.size());
  }
  std::uint32_t results_of(const Instruction& step) const {
    return step.op == OpCode::kLookUp ? tables[step.b].columns : step.op == OpCode::kSineCosine ? 2u : 1u;
  }
};

/// Program that computes the share of each effect in the corrections. The channels of this program are
/// registers of the program of the tick.
struct LoweredShares {
  std::vector<std::int32_t> constants;
  std::vector<std::uint16_t> sources;
  std::vector<Instruction> instructions;
  std::vector<ProductTerm> terms;
  std::vector<Share> shares;
  std::vector<std::string> names;  // name of the effect, one per share
  std::vector<double> largest;     // upper limit of |share|, mm or deg
  std::size_t left_out = 0;        // number of shares that are not in the image because the space is not
                                   // sufficient
};

/// One cause of error in an output (correction of one axis), with its bound.
struct Contribution {
  std::string name;
  std::string source;  // source of the error: "linearisation", "table", "function", "rounding", "input",
                       // "lag"
  double bound_um = 0;
};

/// Proved bound of |fixed-point correction - exact inverse solution| for one axis. The bound is valid over
/// the declared ranges, except at the steps of comparisons. The bound does not include the limits for
/// magnitude, ramp and slew. The exact inverse solution is the correction c with p_actual(q + c) =
/// p_nominal(q). For a rotary axis, the bound is the corresponding motion of the tool point at the longest
/// lever of the axis. With least squares, the bound is valid for all axes together. For an axis that corrects
/// the tool's direction, only `deviation_deg` has a value. The linear axes correct the tool point at the
/// corrected position of the axes for the direction. TiltBound contains the remaining tilt.
struct OutputBound {
  std::string axis;
  double total_um = 0;
  double linearisation_um = 0, table_um = 0, function_um = 0, rounding_um = 0, input_um = 0, lag_um = 0;
  /// Remaining error of the correction after one or two steps of Newton's iteration. The error remains
  /// because the deviation at the corrected position is different, and because the nominal motion is not a
  /// straight line. If second_order_um has a value, total_um includes it. The member second_order_um has no
  /// value if there is no useful bound (least squares near singular poses).
  std::optional<double> second_order_um;
  double deviation_um = 0;                  // upper limit of |deviation| over the declared ranges, by
                                            // interval arithmetic
  std::optional<double> deviation_deg;      // for an axis that corrects the tool's direction: upper limit of
                                            // its deviation
  std::vector<Contribution> contributions;  // all causes of error, largest first
};

/// Remaining tilt of the tool in poses in which the correction of the tilt is neither damped nor limited.
struct TiltBound {
  double deviation_deg = 0;     // upper limit of the tilt without correction
  double fixed_point_deg = 0;   // bound of the error by the fixed-point program and its omitted terms
  double second_order_deg = 0;  // remaining tilt after Newton's steps, as OutputBound::second_order_um
  double left_deg() const { return fixed_point_deg + second_order_deg; }
};

struct CompileOptions {
  std::uint32_t tick_us = 1000;      // cycle time for which lags and slew limits are computed
  std::optional<double> budget_um;   // largest permitted error bound of an axis
  std::uint32_t accepted_rules = 0;  // accepted rules of the safety sheet, which the image contains
  /// Limit for the error after one step of the correction. If the error after one step exceeds the limit, the
  /// deviation is evaluated again at the corrected position.
  double most_second_order_um = 0.1;
  double most_second_order_deg = 2e-4;  // the same limit for the direction of the tool: a tenth of the usual
                                        // requirement
};

struct CompiledMachine {
  std::vector<std::uint8_t> image;
  LoweredProgram program;
  LoweredShares shares;
  std::vector<OutputBound> bounds;
  std::optional<LeastSquares> least_squares;  // no value if the correction does not move rotary axes
  std::optional<Orientation> orientation;     // no value if the direction of the tool is not corrected
  std::optional<TiltBound> tilt;
  int evaluations = 1;                 // number of evaluations of the deviation; more than one if one step is
                                       // not sufficient
  std::size_t operations_of_one = 0;   // operations per tick with one evaluation
  std::vector<std::string> switching;  // comparisons and other expressions with a step; the error bound is
                                       // valid away from these steps
  std::vector<std::string> notes;      // information for the user about the correction, one sentence each
  std::string header, source;          // text of equation.h and of equation.cpp
  std::uint64_t fingerprint = 0;
};

}  // namespace vernier::compile
