// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <ginac/ginac.h>

#include <array>
#include <vector>

#include "tools/derive/types.h"

namespace vernier::derive {

class SymbolBook;

using SymbolicVector = std::array<GiNaC::ex, 3>;

/// A rotation matrix as a product of elementary rotations. Successive rotations about one axis are combined.
/// Parallel axes therefore give sin(q2+q3) instead of products of sines.
class RotationProduct {
 public:
  void turn(int axis, const GiNaC::ex& angle_rad);
  /// Returns the product of rotations applied to a vector.
  SymbolicVector operator*(const SymbolicVector& v) const;

 private:
  struct Turn {
    int axis;
    GiNaC::ex angle;
  };
  std::vector<Turn> turns_;
};

/// Returns the vector v rotated about the axis x, y or z (0, 1 or 2).
SymbolicVector turned(const SymbolicVector& v, int axis, const GiNaC::ex& angle_rad);

/// Returns the cross product a x b.
SymbolicVector cross(const SymbolicVector& a, const SymbolicVector& b);

/// Returns the unit vector along the axis x, y or z (0, 1 or 2).
SymbolicVector unit_vector(int axis);

/// Returns the chain as elementary motions from the workpiece to the tool. The workpiece branch comes first,
/// in reverse order with opposite signs, and then the tool branch. Throws InputError with the name of an
/// expression that has no symbolic form.
std::vector<ElementaryMotion> elementary_motions(const model::Machine& machine, SymbolBook& book);

}  // namespace vernier::derive
