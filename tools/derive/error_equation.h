// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <array>

#include "tools/derive/types.h"

namespace vernier::derive {

/// Returns the transform to which an elementary motion belongs.
const model::Transform& transform_of(const model::Machine& machine, const ElementaryMotion& motion);

/// Derives the symbolic error equation of any chain: sixdof and DH, both branches, linear and rotary axes.
/// The equation is exact to first order about the nominal chain. The parameters of the equation are table
/// values, statics that are free or have `nominal`, and scale factors that are not zero. Other statics remain
/// symbols in the equation. If a static that remains a symbol rotates a frame, its nominal angle is inserted
/// as a number. The BaseShift is not part of the error equation. Throws InputError with one line if an
/// expression has no first order (an error inside a comparison, min, max, abs, sign or lag; a pole). The
/// message contains this expression. The definition of the chain is in tools/docs/formats.md. In the
/// derivation, each error of the machine moves the tool by a small screw motion.
ErrorEquation derive(const model::Machine& machine, const ErrorSizes& sizes = {});

/// Returns the first-order deviation of the direction of the tool's z axis by one parameter: rotation vector
/// x tool axis.
std::array<GiNaC::ex, 3> tool_axis_sensitivity(const ErrorEquation& equation, std::size_t parameter);

}  // namespace vernier::derive
