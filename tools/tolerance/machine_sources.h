// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <string>
#include <utility>
#include <vector>

#include "tools/effects/catalogue.h"
#include "tools/model/machine.h"
#include "tools/model/parameters.h"

namespace vernier::tolerance {

/// One cause of deviations, by its name in the catalogue of effects: `squareness of Y in X`.
/// Statics and table columns that are the same effect of the same axis at the same location are
/// one source.
struct MachineSource {
  std::string name;
  std::string effect;                   // id of the catalogue; "custom": a term that it does not contain
  std::vector<std::size_t> parameters;  // indices into the parameter set of its construction
  std::vector<std::size_t> statics;
  std::vector<std::pair<std::size_t, std::size_t>> columns;  // of tables: table, column
  std::vector<std::size_t> scales;                           // axes with a scale factor
};

/// Returns the free or non-nominal errors of a machine. A static gets the name of its term. machine_sources
/// searches the forms of the catalogue in order for the term's quantities, its functions and the degree of
/// freedom on which it acts.
std::vector<MachineSource> machine_sources(const model::Machine& machine,
                                           const model::ParameterSet& parameters,
                                           const std::vector<effects::Effect>& catalogue);

/// Returns the machine with this source at nominal.
model::Machine without_source(const model::Machine& machine, const MachineSource& source);

}  // namespace vernier::tolerance
