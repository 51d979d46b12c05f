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
/// True if the degree of freedom is an angle (deg), false if it is a length (mm).
bool is_angle(const model::Machine& machine, const DofPlace& place);
/// The degree of freedom that every axis moves in the nominal chain. The constructor evaluates the chain for
/// every degree of freedom: construct AxisPlaces once per machine.
class AxisPlaces {
 public:
  explicit AxisPlaces(const model::Machine& machine);

  /// Returns nullopt for an axis that moves no degree of freedom.
  const std::optional<DofPlace>& own(std::size_t axis) const { return own_.at(axis); }
  /// Returns +1 or -1: the sign with which the degree of freedom of an axis follows the axis (-1 for Y="-Y").
  /// The sign is 0 for an axis that moves no degree of freedom.
  double sense(std::size_t axis) const { return sense_.at(axis); }
  bool is_own(std::size_t axis, const DofPlace& place) const { return own(axis) == place; }
  /// Returns the axis that moves a transform; the first axis if there are several.
  std::optional<std::size_t> axis_of(const DofPlace& place) const;

 private:
  std::vector<std::optional<DofPlace>> own_;
  std::vector<double> sense_;
};
/// Returns the lengths X Y Z that shift the whole measuring frame; empty if the chain has no such transform.
/// The lengths belong to the first transform of a chain without workpiece branch, or to the last transform of
/// a workpiece branch if that transform does not rotate.
std::vector<DofPlace> base_places(const model::Machine& machine);
/// Returns the machine with a transform for rigid motions of the whole machine. If the machine has no
/// base_places because the row there rotates (a DH row, a table), an identity sixdof is added at that end of
/// the chain. The number of the added row is one below the first row or one above the last row. The added row
/// does not change predictions. add_to_machine_text writes the row into the file when the row gets a term.
/// The locations of diagnose, plan and `add` refer to the machine of with_base_row.
model::Machine with_base_row(model::Machine machine);
/// True if with_base_row added the transform of this location. The machine file has no line for such a
/// transform.
bool is_stand_in(const model::Machine& machine, const DofPlace& place);
/// Returns the degrees of freedom of the transforms that carry the whole machine: the first transform of the
/// tool branch and, if the chain has a workpiece branch, its last transform. If this transform was added by
/// with_base_row, the neighbouring row is used.
std::vector<DofPlace> carrier_places(const model::Machine& machine);
/// Returns all degrees of freedom, tool branch first.
std::vector<DofPlace> all_places(const model::Machine& machine);

}  // namespace vernier::effects
