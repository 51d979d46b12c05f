// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <array>
#include <map>
#include <string>
#include <vector>

#include "tools/compile/dual.h"

namespace vernier::compile {

/// One elementary step along the chain, in the order in which the steps act on the point: a rotation about a
/// coordinate axis, or a shift along one.
struct Step {
  bool turn;
  int axis;  // 0..2: X Y Z
  Dual by;   // deg or mm
  std::string where;
  struct Part {
    std::string term;
    NodeId delta;
  };
  std::vector<Part> parts;  // the terms whose sum is by.delta
};

/// Returns the elementary steps of the chain: from the tool point through the tool branch to the base, then
/// through the workpiece branch, reversed, to the workpiece.
std::vector<Step> all_steps(const model::Machine& machine, Translator& translate, Graph& graph);

/// Returns the motion of a point with an axis, mm per mm or deg, in the frame before `last_turn` (null: the
/// frame of the point). The axis may also drive the rotation `last_turn`. Throws std::domain_error if the
/// motion has a step.
NodeVector motion_of(Graph& graph, NodeId axis, const NodeVector& point, const Step* last_turn);

/// Moves a point through the chain: its nominal position, and the addition that the actual chain makes.
class Walk {
 public:
  /// neglect_mm: a higher-order term smaller than neglect_mm is omitted and entered in `neglected`.
  Walk(Derivation& derivation, double neglect_mm, std::vector<Neglected>& neglected);
  /// Returns a Walk for the direction of the tool, the z axis of its last frame, instead of a point. Shifts
  /// do not change a direction; all lengths are those of a vector of length 1.
  static Walk of_direction(Derivation& derivation, double neglect, std::vector<Neglected>& neglected);

  void take(const Step& step);
  /// From this call on no corrected axis moves. After freeze(), nominal rotations no longer rotate the
  /// deviation, because they rotate the axes in the same way.
  void freeze() { frozen_ = true; }

  const NodeVector& nominal() const { return nominal_; }
  /// Returns the contribution of each term of the chain to the deviation.
  const std::map<std::string, NodeVector>& parts() const { return parts_; }
  /// Returns the deviation in the frame in which freeze() was called.
  const NodeVector& deviation() const { return deviation_; }
  /// Returns the bounds of the two vectors' lengths, mm. Rotations keep a length. These bounds therefore do
  /// not grow with every rotation, unlike the intervals of the components.
  double reach_mm() const;
  double spread_mm() const;

 private:
  NodeVector only(std::size_t axis, NodeId value);
  NodeVector plus(const NodeVector& a, const NodeVector& b);
  double norm_of(const NodeVector& v) const;
  std::pair<NodeId, NodeId> direction_of(NodeId angle_deg);
  NodeVector turned(const NodeVector& v, int axis, NodeId angle_deg);
  void turn_nominal(const Step& step);
  NodeVector deviation_here();
  NodeVector seen_from_frame(NodeVector v);
  void add_deviation(const NodeVector& v);
  void add_part(const std::string& name, const NodeVector& v);
  void split_turn(const Step& step, const NodeVector& point, const NodeVector& all);
  bool small(double bound_mm, const Step& step, const char* what);
  void turn_sizes(std::array<double, 3>& sizes, int axis, NodeId angle_deg);
  void deviate_by_turn(const Step& step);
  NodeId sine_of(const Step& step, double size, double reach);
  NodeId bend_of(const Step& step, double size, double reach);

  Graph& g_;
  double neglect_mm_;
  std::vector<Neglected>& neglected_;
  bool direction_ = false;
  NodeVector nominal_, deviation_;
  std::map<std::string, NodeVector> parts_;
  double reach_mm_ = 0, spread_mm_ = 0;
  bool frozen_ = false;
  std::vector<Step> turns_;  // nominal turns since freeze()
};

/// Returns a walk along the whole chain with `added` on the axes, in the frame after `frozen_from`
/// steps.
Walk walked(const model::Machine& machine, Derivation& derivation, const Additions& added,
            std::size_t frozen_from, Walk walk);

}  // namespace vernier::compile
