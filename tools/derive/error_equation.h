// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <array>

#include "tools/derive/types.h"

namespace vernier::derive {

/// The transform that a motion is part of.
const model::Transform& transform_of(const model::Machine& machine, const ElementaryMotion& motion);

/// Derives the error equation of any chain in symbols: sixdof and DH, both branches, linear and rotary axes.
/// Exact to first order about the nominal chain. Errors are table values, statics with `nominal` or free
/// ones, and non-zero scale factors; other statics stay symbols, except where they turn a frame: there the
/// nominal angle is put in as a number. BaseShift is no part of it. Throws InputError in one line naming the
/// expression that has no first order (an error inside a comparison, min, max, abs, sign, lag; a pole). tool.
/// Source: the chain as tools/docs/formats.md defines it; every error moves the tool like a small screw.
ErrorEquation derive(const model::Machine& machine, const ErrorSizes& sizes = {});

/// Deviation of the direction of the tool's z, first order: rotation vector x tool axis; by one parameter.
std::array<GiNaC::ex, 3> tool_axis_sensitivity(const ErrorEquation& equation, std::size_t parameter);

}  // namespace vernier::derive
