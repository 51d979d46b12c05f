// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <nlohmann/json.hpp>
#include <string>

#include "tools/derive/error_equation.h"
#include "tools/derive/print.h"
#include "tools/derive/second_order.h"

namespace vernier::derive {

/// An error equation with the bound of its remainder (terms of second and higher order).
struct DerivedMachine {
  ErrorEquation equation;
  SecondOrderBound bound;
  std::optional<SecondOrder> sampled;  // no value if a linear axis has no range
  std::size_t samples = 0;
};

/// Returns one component of the deviation as text: 0..2 tool point (mm), 3..5 rotation vector (rad), 6..8
/// direction of the tool's z axis. The text is a sum over the errors, each with its sensitivity in factored
/// form. If the component has no term, the text is "0".
std::string print_component(const ErrorEquation& equation, std::size_t component, Notation notation,
                            const std::string& separator = " ");

/// Returns the text that the command `vernier derive` prints.
std::string print_text(const DerivedMachine& derived);
/// Returns the error equation of a machine as a LaTeX fragment (amsmath).
std::string print_latex(const DerivedMachine& derived);
/// Returns the error equation of a machine as JSON.
nlohmann::ordered_json to_json(const DerivedMachine& derived);

}  // namespace vernier::derive
