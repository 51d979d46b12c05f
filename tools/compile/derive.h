#pragma once
#include <string>
#include <vector>

#include "tools/compile/graph.h"

namespace vernier {

/// A part of the exact deviation that the equation leaves out, and how much it can be over the declared
/// ranges.
struct Neglected {
  std::string what;  // "second order of rZ in transform 3 (tool)"
  double bound_mm;   // norm
};

/// The deviation along one linear axis: axis * value has the deviation's effect on the tool point.
struct AxisDeviation {
  std::size_t axis;
  NodeId value;     // mm along the axis
  double row_norm;  // turns a norm in the workpiece frame into a bound along this axis
};

/// The symbolic error equation of a machine.
struct Derivation {
  Graph graph;
  std::vector<AxisDeviation> outputs;
  std::vector<Neglected> neglected;
  std::vector<std::string> switching;  // comparisons and the like: the bound holds away from their steps
};

/// Range of a channel in the unit of the machine file: declared, or the default of docs for its kind and
/// unit.
Interval axis_range(const Machine& machine, std::size_t axis);
Interval input_range(const Input& input);
Interval channel_range(const Machine& machine, ChannelKind kind, std::size_t index);

/// Derives p(actual) - p(nominal) in factored form along the chain, seen along the linear axes.
/// neglect_mm: a higher-order term smaller than this over the declared ranges is left out and entered in
/// `neglected`. Throws InputError in one line where the machine cannot be compiled: a free static without
/// nominal, an axis without range, linear axes whose directions turn with a rotary axis that they carry, an
/// expression that the program has no operation for. tool.
Derivation derive(const Machine& machine, double neglect_mm);

}  // namespace vernier
