// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <ginac/ginac.h>

#include <string>

namespace vernier::derive {

enum class Notation { kText, kLatex };

/// Returns an expression as text, with terms and factors in a fixed order. Every run of the program gives
/// the same text for the same expression. (The order of GiNaC itself depends on memory addresses.) The
/// parser of GiNaC can read the text form if all names are identifiers.
std::string print(const GiNaC::ex& expr, Notation notation);

/// Returns a name in LaTeX form: EXX becomes E_{XX}, and d_lAx becomes \Delta \mathrm{lAx}.
std::string latex_name(const std::string& name);

}  // namespace vernier::derive
