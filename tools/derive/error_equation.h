// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <array>

#include "tools/derive/types.h"

namespace vernier::derive {

/// The transform that a motion is part of.
const model::Transform& transform_of(const model::Machine& machine, const ElementaryMotion& motion);

/// Derives the symbolic error equation of any chain: sixdof and DH, both branches, linear and rotary axes.
/// The equation is exact to first order about the nominal chain. Parameters of the equation are table values,
/// statics with `nominal` or free statics, and non-zero scale factors. Other statics stay symbols. If such a
/// static rotates a frame, its nominal angle is inserted as a number. BaseShift is not included. Throws
/// InputError in one line with the expression that has no first order (an error inside a comparison, min,
/// max, abs, sign, lag; a pole). Source of the definition of the chain: tools/docs/formats.md. Each
/// error moves the tool like a small screw motion.
ErrorEquation derive(const model::Machine& machine, const ErrorSizes& sizes = {});

/// Returns the first-order deviation of the direction of the tool's z axis by one parameter: rotation vector
/// x tool axis.
std::array<GiNaC::ex, 3> tool_axis_sensitivity(const ErrorEquation& equation, std::size_t parameter);

}  // namespace vernier::derive
