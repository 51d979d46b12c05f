// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <ginac/ginac.h>

#include <string>

namespace vernier::derive {

enum class Notation { kText, kLatex };

/// Prints the expression with terms and factors in a fixed order. Every run gives the same text (GiNaC's own
/// order depends on addresses). GiNaC's parser can read the text form if all names are identifiers.
std::string print(const GiNaC::ex& expr, Notation notation);

/// Returns a name in LaTeX: EXX is E_{XX}, d_lAx is \Delta \mathrm{lAx}.
std::string latex_name(const std::string& name);

}  // namespace vernier::derive
