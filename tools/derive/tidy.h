// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <ginac/ginac.h>

#include <cstddef>

namespace vernier::derive {

/// Is it a call of the function of this name?
bool is_call(const GiNaC::ex& e, const char* name);

/// Expanded, the arguments of functions too.
GiNaC::ex expand_inside(const GiNaC::ex& expr);

/// Expanded, with sin^2 replaced by 1 - cos^2: equal trigonometric polynomials of one angle become the same.
GiNaC::ex canonical(const GiNaC::ex& expr);

/// Returns the same value in the shortest form found: canonical, then factored if it is small
/// enough.
GiNaC::ex tidy(const GiNaC::ex& expr);

/// Number of terms of a sum, 1 for anything else, 0 for zero.
std::size_t term_count(const GiNaC::ex& expr);

}  // namespace vernier::derive
