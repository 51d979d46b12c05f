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
  std::size_t transform = 0;  // position in its branch
  std::size_t dof = 0;        // as Transform::dof
  bool operator==(const DofPlace&) const = default;
};

const model::Transform& transform_at(const model::Machine& machine, const DofPlace& place);
const char* dof_name(const model::Machine& machine, const DofPlace& place);
/// Is the degree of freedom an angle (deg) and not a length (mm)?
bool is_angle(const model::Machine& machine, const DofPlace& place);
/// The degree of freedom that every axis moves in the nominal chain. The constructor evaluates the
/// chain for every degree of freedom, so construct it once per machine. tool.
class AxisPlaces {
 public:
  explicit AxisPlaces(const model::Machine& machine);

  /// Returns nullopt for an axis that moves no degree of freedom.
  const std::optional<DofPlace>& own(std::size_t axis) const { return own_.at(axis); }
  /// +1 or -1: sign with which its own degree of freedom follows an axis (-1 for Y="-Y"). 0 for an
  /// axis that moves no degree of freedom.
  double sense(std::size_t axis) const { return sense_.at(axis); }
  bool is_own(std::size_t axis, const DofPlace& place) const { return own(axis) == place; }
  /// Returns the axis that moves a transform (the first one if there are several).
  std::optional<std::size_t> axis_of(const DofPlace& place) const;

 private:
  std::vector<std::optional<DofPlace>> own_;
  std::vector<double> sense_;
};
/// Returns the lengths X Y Z that shift the whole measuring frame, if the chain has such a
/// transform. It is the first transform of a chain without workpiece branch, or the last transform
/// of a workpiece branch if that transform does not rotate.
std::vector<DofPlace> base_places(const model::Machine& machine);
/// Returns the machine with a transform for rigid motions of the whole. If the machine has no
/// base_places because the row there rotates (a DH row, a table), an identity sixdof is added at
/// that end of the chain. Its number is one below the first row or one above the last. Predictions
/// are the same. add_to_machine_text writes the row as soon as it has a term. The locations of
/// diagnose, plan and `add` refer to this machine. tool.
model::Machine with_base_row(model::Machine machine);
/// Did with_base_row add the transform of this location? Such a transform is on no line of the
/// file.
bool is_stand_in(const model::Machine& machine, const DofPlace& place);
/// Returns the degrees of freedom of the transforms that carry everything: the first one of the
/// tool branch and the last one of the workpiece branch, if the chain has that branch. Next to a
/// transform of with_base_row, the neighbouring row is used.
std::vector<DofPlace> carrier_places(const model::Machine& machine);
/// Returns all degrees of freedom, tool branch first.
std::vector<DofPlace> all_places(const model::Machine& machine);

}  // namespace vernier::effects
