// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <ginac/ginac.h>

#include <cstddef>

namespace vernier::derive {

/// True if the expression is a call of the function `name`.
bool is_call(const GiNaC::ex& e, const char* name);

/// Expands the expression, including the arguments of functions.
GiNaC::ex expand_inside(const GiNaC::ex& expr);

/// Expands an expression and replaces sin^2 by 1 - cos^2. After the replacement of sin^2, equal
/// trigonometric polynomials of one angle have identical text.
GiNaC::ex canonical(const GiNaC::ex& expr);

/// Returns the shortest expression that is mathematically equal to the given expression, among those that
/// were found. The expression is brought to canonical form, and factored if it is small enough.
GiNaC::ex tidy(const GiNaC::ex& expr);

/// Returns the number of terms in a sum; 1 for any other expression; 0 for zero.
std::size_t term_count(const GiNaC::ex& expr);

}  // namespace vernier::derive
