// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <ginac/ginac.h>

#include <array>
#include <vector>

#include "tools/derive/types.h"

namespace vernier::derive {

class SymbolBook;

using SymbolicVector = std::array<GiNaC::ex, 3>;

/// Rotation matrix as a product. Successive rotations about one axis are merged: parallel axes give
/// sin(q2+q3) instead of products of sines.
class RotationProduct {
 public:
  void turn(int axis, const GiNaC::ex& angle_rad);
  /// Returns the product applied to a vector.
  SymbolicVector operator*(const SymbolicVector& v) const;

 private:
  struct Turn {
    int axis;
    GiNaC::ex angle;
  };
  std::vector<Turn> turns_;
};

/// Returns v rotated about axis x, y or z (0..2).
SymbolicVector turned(const SymbolicVector& v, int axis, const GiNaC::ex& angle_rad);

/// Returns a x b.
SymbolicVector cross(const SymbolicVector& a, const SymbolicVector& b);

/// Returns the unit vector of axis 0..2.
SymbolicVector unit_vector(int axis);

/// Returns the chain as elementary motions from the workpiece to the tool: the workpiece branch in
/// reverse order with opposite signs, then the tool branch. Throws InputError naming the
/// expression that cannot be expressed.
std::vector<ElementaryMotion> elementary_motions(const model::Machine& machine, SymbolBook& book);

}  // namespace vernier::derive
