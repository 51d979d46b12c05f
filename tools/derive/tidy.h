// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <ginac/ginac.h>

#include <cstddef>

namespace vernier::derive {

/// True if the expression is a call of the function with this name.
bool is_call(const GiNaC::ex& e, const char* name);

/// Expands the expression, including the arguments of functions.
GiNaC::ex expand_inside(const GiNaC::ex& expr);

/// Expands the expression and replaces sin^2 by 1 - cos^2. Equal trigonometric polynomials of one angle
/// thereby become identical.
GiNaC::ex canonical(const GiNaC::ex& expr);

/// Returns an equal expression in the shortest form found: canonical, then factored if the expression is
/// small enough.
GiNaC::ex tidy(const GiNaC::ex& expr);

/// Returns the number of terms of a sum, 1 for any other expression, 0 for zero.
std::size_t term_count(const GiNaC::ex& expr);

}  // namespace vernier::derive
