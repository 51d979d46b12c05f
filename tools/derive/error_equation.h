// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <array>

#include "tools/derive/types.h"

namespace vernier::derive {

/// The transform that a motion is part of.
const model::Transform& transform_of(const model::Machine& machine, const ElementaryMotion& motion);

/// Derives the symbolic error equation of any chain: sixdof and DH, both branches, linear and
/// rotary axes. It is exact to first order about the nominal chain. Errors are table values,
/// statics with `nominal` or free ones, and non-zero scale factors. Other statics stay symbols,
/// unless they rotate a frame: then the nominal angle is inserted as a number. BaseShift is not
/// included. Throws InputError in one line naming the expression without a first order (an error
/// inside a comparison, min, max, abs, sign, lag; a pole). tool. Source: the chain as
/// tools/docs/formats.md defines it. Every error moves the tool like a small screw motion.
ErrorEquation derive(const model::Machine& machine, const ErrorSizes& sizes = {});

/// Returns the first-order deviation of the direction of the tool's z by one parameter: rotation
/// vector x tool axis.
std::array<GiNaC::ex, 3> tool_axis_sensitivity(const ErrorEquation& equation, std::size_t parameter);

}  // namespace vernier::derive
