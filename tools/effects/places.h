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
/// Is the degree of freedom an angle (deg), no length (mm)?
bool is_angle(const model::Machine& machine, const DofPlace& place);
/// Which degree of freedom every axis moves in the nominal chain. Worked out once for a machine: that means
/// to evaluate its chain at every place. tool.
class AxisPlaces {
 public:
  explicit AxisPlaces(const model::Machine& machine);

  /// Nothing for an axis that moves none.
  const std::optional<DofPlace>& own(std::size_t axis) const { return own_.at(axis); }
  /// +1 or -1: sense in which its own degree of freedom follows an axis (-1 for Y="-Y"); 0 for an axis
  /// without.
  double sense(std::size_t axis) const { return sense_.at(axis); }
  bool is_own(std::size_t axis, const DofPlace& place) const { return own(axis) == place; }
  /// The axis that moves a transform (the first one where there are several).
  std::optional<std::size_t> axis_of(const DofPlace& place) const;

 private:
  std::vector<std::optional<DofPlace>> own_;
  std::vector<double> sense_;
};
/// The lengths X Y Z that shift the whole measuring frame, where the chain has such a transform: the first
/// one of a chain without workpiece branch, the last one of a workpiece branch that does not turn there.
std::vector<DofPlace> base_places(const model::Machine& machine);
/// The machine with a place for rigid motions of the whole: where it has no base_places, because the row
/// there turns (a DH row, a table), an identity sixdof stands in at that end of the chain, numbered one below
/// the first row or one above the last. Predictions are the same; add_to_machine_text writes the row once it
/// takes a term. Places of diagnose, plan and `add` are those of this machine. tool.
model::Machine with_base_row(model::Machine machine);
/// Is the transform of this place one that with_base_row put in? It stands on no line of the file.
bool is_stand_in(const model::Machine& machine, const DofPlace& place);
/// The degrees of freedom of the transforms that carry everything: the first one of the tool branch and the
/// last one of the workpiece branch, each where the chain has that branch; beside a stand-in the row next to
/// it.
std::vector<DofPlace> carrier_places(const model::Machine& machine);
/// All degrees of freedom, tool branch first.
std::vector<DofPlace> all_places(const model::Machine& machine);

}  // namespace vernier::effects
