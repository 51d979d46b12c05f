// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <array>
#include <map>
#include <string>
#include <vector>

#include "tools/compile/dual.h"

namespace vernier::compile {

/// One elementary step along the chain: a rotation about a coordinate axis, or a shift along a coordinate
/// axis. The elementary steps are in the order in which they act on the tool point.
struct Step {
  bool turn;
  int axis;  // 0..2: X Y Z
  Dual by;   // angle in deg or shift in mm
  std::string where;
  struct Part {
    std::string term;
    NodeId delta;
  };
  std::vector<Part> parts;  // the terms whose sum is by.delta
};

/// Returns the elementary steps of the whole chain: from the tool point through the tool branch to the base,
/// and then through the reversed workpiece branch to the workpiece.
std::vector<Step> all_steps(const model::Machine& machine, Translator& translate, Graph& graph);

/// Returns the motion of a point with an axis, mm per mm or deg. The frame is that before `last_turn`; if
/// `last_turn` is null, it is the frame of the point. The same axis may also drive the rotation `last_turn`.
/// Throws std::domain_error if the motion of the point contains a step.
NodeVector motion_of(Graph& graph, NodeId axis, const NodeVector& point, const Step* last_turn);

/// Returns a vector after a rotation.
NodeVector turned(Graph& graph, const NodeVector& v, const Turn& turn);

/// Returns an omitted part as a vector in the frame of the deviation. It differs from the exact part by at
/// most its slack_mm.
NodeVector omitted_part(Graph& graph, const Neglected& neglected);

/// Moves a point through the chain, and computes its nominal position and the deviation of the actual chain.
class Walk {
 public:
  /// `neglect_mm`: a higher-order term that is smaller than this limit is omitted and listed in `neglected`.
  Walk(Derivation& derivation, double neglect_mm, std::vector<Neglected>& neglected);
  /// Returns a Walk for the direction of the tool (the z axis of its last frame) instead of a point. Shifts
  /// do not change a direction. All lengths of a Walk for a direction are without unit, because a direction
  /// vector has the length 1.
  static Walk of_direction(Derivation& derivation, double neglect, std::vector<Neglected>& neglected);

  void take(const Step& step);
  /// Declares that no corrected axis moves from this call on. After freeze(), nominal rotations no longer
  /// rotate the deviation, because they rotate the axes in the same way.
  void freeze() { frozen_ = true; }

  const NodeVector& nominal() const { return nominal_; }
  /// Returns the contribution of each term of the chain to the deviation.
  const std::map<std::string, NodeVector>& parts() const { return parts_; }
  /// Returns the deviation in the frame in which freeze() was called.
  const NodeVector& deviation() const { return deviation_; }
  /// reach_mm() and spread_mm() return bounds of the lengths of nominal() and deviation(), mm. A rotation
  /// does not change the length of a vector. The bounds of the lengths therefore do not grow with every
  /// rotation, as the intervals of the components do.
  double reach_mm() const;
  double spread_mm() const;

 private:
  NodeVector only(std::size_t axis, NodeId value);
  NodeVector plus(const NodeVector& a, const NodeVector& b);
  double norm_of(const NodeVector& v) const;
  void turn_nominal(const Step& step);
  NodeVector deviation_here();
  NodeVector seen_from_frame(NodeVector v);
  void add_deviation(const NodeVector& v);
  void add_part(const std::string& name, const NodeVector& v);
  void split_turn(const Step& step, const NodeVector& point, const NodeVector& all);
  double size_of(const Step& step) const;  // upper limit of the error of a rotation, rad
  bool small(double bound_mm, const Step& step, const NodeVector& of, int order, const char* what);
  void turn_sizes(std::array<double, 3>& sizes, int axis, NodeId angle_deg);
  void deviate_by_turn(const Step& step);
  NodeId sine_of(const Step& step, const NodeVector& point, double size, double reach);
  NodeId bend_of(const Step& step, const NodeVector& point, double size, double reach);

  Graph& g_;
  double neglect_mm_;
  std::vector<Neglected>& neglected_;
  bool direction_ = false;
  NodeVector nominal_, deviation_;
  std::map<std::string, NodeVector> parts_;
  double reach_mm_ = 0, spread_mm_ = 0;
  bool frozen_ = false;
  std::vector<Step> turns_;  // nominal rotations since the call of freeze()
};

/// Returns a walk along the whole chain with the additions `added` on the axes, in the frame after
/// `frozen_from` steps.
Walk walked(const model::Machine& machine, Derivation& derivation, const Additions& added,
            std::size_t frozen_from, Walk walk);

}  // namespace vernier::compile
