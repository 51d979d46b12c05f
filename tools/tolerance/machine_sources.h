// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <string>
#include <utility>
#include <vector>

#include "tools/effects/catalogue.h"
#include "tools/model/machine.h"
#include "tools/model/parameters.h"

namespace vernier::tolerance {

/// One source of error of a machine, with its name from the catalogue of effects: `squareness of Y in X`.
/// Constants and table columns with the same effect of the same axis at the same location belong to one
/// source of error.
struct MachineSource {
  std::string name;
  std::string effect;                   // id of the effect in the catalogue; "custom" if the catalogue does
                                        // not contain the term
  std::vector<std::size_t> parameters;  // indices of the source's parameters in the parameter set
  std::vector<std::size_t> statics;
  std::vector<std::pair<std::size_t, std::size_t>> columns;  // tables and columns that belong to the source:
                                                             // index of the table, index of the column
  std::vector<std::size_t> scales;                           // axes whose scale factor belongs to the source
};

/// Returns the sources of error of a machine: those with free parameters, and those whose value differs from
/// nominal. A constant gets the name of the term that contains it. machine_sources compares the quantities,
/// functions and degree of freedom of this term with the forms of the catalogue, in their order.
std::vector<MachineSource> machine_sources(const model::Machine& machine,
                                           const model::ParameterSet& parameters,
                                           const std::vector<effects::Effect>& catalogue);

/// Returns the machine with the nominal value (no error) for one source.
model::Machine without_source(const model::Machine& machine, const MachineSource& source);

}  // namespace vernier::tolerance
