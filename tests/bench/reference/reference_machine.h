// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <array>
#include <string>
#include <vector>

#include "tests/unit/compile/poses.h"

namespace vernier::bench {

using namespace vernier::compile;
using namespace vernier::model;

/// The machines that the benches of the run-time core run on. three_axis, five_axis, seven_axis and six_r are
/// those of tables/machines with every error of their chain set (seven_axis_chain: without tables, one tool
/// point in place of a choice); the others are test machines as they stand.
inline constexpr std::array<const char*, 7> kReferenceMachines = {
    "three_axis", "five_axis",          "seven_axis_chain", "seven_axis",
    "six_r",      "three_axis_effects", "five_axis_effects"};

/// A reference machine with seeded errors: statics 5 um / 5 mdeg off their nominal, tables of 64 stations on
/// the three-axis machine, random walks in all columns. Always the same. Throws InputError for another name.
Machine reference_machine(const std::string& name);

/// The same with its compiled form.
struct ReferenceMachine {
  Machine machine;
  CompiledMachine compiled;
  explicit ReferenceMachine(const std::string& name);
};

}  // namespace vernier::bench
