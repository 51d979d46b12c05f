// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <cstddef>
#include <optional>
#include <vector>

#include "tools/model/machine.h"

namespace vernier::effects {

/// A degree of freedom of a transform of the chain.
struct DofPlace {
  bool workpiece = false;
  std::size_t transform = 0;  // index of the transform in its branch
  std::size_t dof = 0;        // index of the degree of freedom, as in Transform::dof
  bool operator==(const DofPlace&) const = default;
};

const model::Transform& transform_at(const model::Machine& machine, const DofPlace& place);
const char* dof_name(const model::Machine& machine, const DofPlace& place);
/// True if the degree of freedom is an angle (deg), false if it is a length (mm).
bool is_angle(const model::Machine& machine, const DofPlace& place);
/// For each axis, the degree of freedom that the axis moves in the nominal chain. The constructor evaluates
/// the chain for every degree of freedom. Construct only one AxisPlaces object for a machine, because the
/// constructor evaluates the whole chain many times.
class AxisPlaces {
 public:
  explicit AxisPlaces(const model::Machine& machine);

  /// Returns the degree of freedom that an axis moves; nullopt if the axis moves no degree of freedom.
  const std::optional<DofPlace>& own(std::size_t axis) const { return own_.at(axis); }
  /// Returns the sign with which the degree of freedom follows its axis: +1 or -1 (-1 for Y="-Y"). The sign
  /// is 0 for an axis that moves no degree of freedom.
  double sense(std::size_t axis) const { return sense_.at(axis); }
  bool is_own(std::size_t axis, const DofPlace& place) const { return own(axis) == place; }
  /// Returns the axis that moves a transform. If several axes move the transform, returns the first of these
  /// axes.
  std::optional<std::size_t> axis_of(const DofPlace& place) const;

 private:
  std::vector<std::optional<DofPlace>> own_;
  std::vector<double> sense_;
};
/// Returns the lengths X Y Z that shift the whole measuring frame; empty if the chain has no such transform.
/// The lengths belong to the first transform of a chain without workpiece branch, or to the last transform of
/// a workpiece branch if that transform does not rotate.
std::vector<DofPlace> base_places(const model::Machine& machine);
/// Returns a copy of the machine with a transform for rigid motions of the whole machine. If base_places() is
/// empty because the transform at this end of the chain rotates (a DH row, a table), an identity sixdof
/// transform is added. The number n of the added transform is one below that of the first transform, or one
/// above that of the last transform. The added transform does not change predictions. add_to_machine_text
/// writes it into the file when it gets a term. The locations in diagnose, plan and `add` refer to the
/// machine that with_base_row returns.
model::Machine with_base_row(model::Machine machine);
/// True if with_base_row added the transform at this location. The machine file contains no line for an added
/// transform.
bool is_stand_in(const model::Machine& machine, const DofPlace& place);
/// Returns the degrees of freedom of the transforms that carry the whole machine: the first transform of the
/// tool branch and, if the chain has a workpiece branch, its last transform. If with_base_row added a
/// transform, the neighbouring transform is used.
std::vector<DofPlace> carrier_places(const model::Machine& machine);
/// Returns all degrees of freedom of the chain, those of the tool branch first.
std::vector<DofPlace> all_places(const model::Machine& machine);

}  // namespace vernier::effects
