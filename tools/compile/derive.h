// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <array>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "tools/compile/graph.h"

namespace vernier::compile {

using NodeVector = std::array<NodeId, 3>;

/// A part of the exact deviation that the equation leaves out, and how much it can be over the declared
/// ranges.
struct Neglected {
  std::string what;                // "second order of rZ in transform 3 (tool)"
  double bound_mm;                 // norm
  std::array<double, 3> along_mm;  // each component in the frame of the deviation
};

/// The deviation along one axis: moving the axis by value has the deviation's effect on the tool point.
struct AxisDeviation {
  std::size_t axis;
  NodeId value;  // mm or deg
  std::array<double, 3>
      row;          // turns the components of a vector in the frame of the deviation into one, at most
  double row_norm;  // turns a norm in the workpiece frame, mm, into a bound along this axis
  double lever;     // mm of tool point per mm or deg of the axis, at most
};

/// The least squares x = J' w, w = adj(J J') deviation / max(det(J J'), floor) of a machine that is corrected
/// by turning axes too. Rows of J: directions of the tool point; columns: axes, each divided by its lever.
struct LeastSquares {
  /// Fewer axes than directions that they move the tool point in, other ones at each pose (a telescope): then
  /// K below is J', x = (J'J)^-1 J' deviation is what brings the tool point nearest, and what lies across the
  /// axes stays. Else K is J, and x = J' (J J')^-1 deviation the least motion of all.
  bool nearest = false;
  std::vector<std::vector<NodeId>> jacobian, square, adjugate;  // K, K K', adj(K K')
  std::vector<NodeId> deviation, weights;                       // what (K K')^-1 is taken of, and gives
  std::vector<double> lever;                                    // mm per axis unit
  NodeId determinant = 0, reciprocal = 0;
  double floor = 0;      // det(K K') below it: the correction fades
  double trace = 0;      // sum of the squares of J's singular values, at most
  double largest = 0;    // |adj(K K')| at most
  double gain = 0;       // |K' (K K')^-1| at most, where the correction does not fade
  double spread_mm = 0;  // |deviation| at most
};

/// How the nominal tool point moves with an axis: mm per mm or per deg, in the frame of the deviation.
struct AxisColumn {
  std::size_t axis;
  NodeVector direction;
  double norm;  // its length at most
};

/// What one term of the chain adds to the deviation, and so to each output.
struct EffectPart {
  std::string name;  // "X of transform 2 (tool): BX*dirX"
  NodeVector deviation;
  std::vector<NodeId> outputs;  // as Derivation::outputs
};

/// The correction of the tool's direction by rotary axes. Vectors are of length 1, so deviations are in rad.
struct Orientation {
  std::vector<std::size_t> axes;  // one or two, that tilt the tool
  std::vector<double> lever;      // rad of direction per deg of the axis, at most
  std::vector<NodeId> values;     // the deviation along each of them, deg: what the board takes back
  std::vector<double> limit_deg;  // |value| at most: the axis' maxcorrection, or what the solution can reach
  NodeVector deviation{};         // of the direction, in a frame of the chain
  double spread = 0;              // its length at most
  std::vector<Neglected> neglected;
  NodeId determinant = 0;        // of J'J, J the motion of the direction with the axes, each by its lever
  double floor = 0;              // damped where the determinant is below it
  std::optional<double> damped;  // share of the poses; nothing: proved that there are none
  double gain = 0;               // |(J'J)^-1 J'| at most, where not damped
  std::vector<EffectPart> parts;
};

/// One of several evaluations of the deviation: the equation is evaluated again where it leads to. What the
/// next is wrong by does not depend on how exact this one is, only on how far apart they are.
struct Evaluation {
  std::vector<NodeId> values;        // as the outputs', of those in front of the axes of the direction
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
  std::map<std::size_t, double> turning;  // axes that turn that frame: rad per mm or deg
  std::map<NodeId, double> table_slopes;  // of each table value: mm or deg per axis unit at most
  std::vector<Neglected> neglected;
  std::vector<EffectPart> parts;   // their sum is the deviation
  std::vector<std::string> notes;  // what the user should know of the correction, a sentence each
  std::optional<LeastSquares> least_squares;
  std::optional<Orientation> orientation;  // its axes are the last outputs
  std::vector<Evaluation> before;          // evaluations in front of the last one
  NodeVector last_direction{};             // deviation of the direction in the last evaluation
  std::optional<double> fading;  // share of the poses where it fades, because the axes do not reach there
  std::vector<std::string> switching;  // comparisons and the like: the bound holds away from their steps
};

/// Derives p(actual) - p(nominal) in factored form along the chain, seen along the linear axes where they
/// span it, else along the rotary ones too. neglect_mm: a higher-order term smaller than this over the
/// declared ranges is left out and entered in `neglected`. evaluations: beyond the first, the deviation is
/// evaluated again with the correction so far, p(actual, corrected) - p(nominal), and what is left of it
/// corrected too: a step of Newton's iteration with the nominal Jacobian. Of a machine that corrects
/// orientation the rotary axes put the direction right first, the linear ones the point, with what the rotary
/// ones do. Throws InputError in one line where the machine cannot be compiled: a free static without
/// nominal, an axis without range, an axis whose nominal motion has a step, an expression that the program
/// has no operation for. tool.
Derivation derive(const model::Machine& machine, double neglect_mm, int evaluations = 1);

}  // namespace vernier::compile
