// SPDX-License-Identifier: GPL-3.0-or-later
// Sentences in the exported files: measurements at the machine by which the user checks the sign of a table.
// The expected readings are those of an instrument that is aligned as the sentence says. The alignment of the
// instrument that measured the machine is not part of them. All functions return an empty text if there is
// nothing to read (0.1 um). `mark`: text before each line. `reversed`: what to change if the sign is wrong.
#pragma once
#include <functional>
#include <string>

#include "tools/exchange/controller/tables.h"

namespace vernier::exchange {

/// Returns a sentence with two positions at which the effect of the table of an axis for itself is large.
std::string positioning_move(const ControllerTable& table, const std::string& mark,
                             const std::string& reversed);

/// Returns a sentence for the table of an axis that corrects another axis: the reading of a straightedge that
/// is aligned with the ends of the travel.
std::string straightness_move(const ControllerTable& table, const std::string& mark,
                              const std::string& reversed);

/// Returns what to change in the tables of two axes by each other. One of the tables can be nullptr.
using ReversedTables = std::function<std::string(const ControllerTable*, const ControllerTable*)>;

/// Returns sentences for the squareness of each two axes: the reading of a square that is aligned with the
/// travel of the first axis.
std::string squareness_moves(const ControllerTables& tables, const std::string& mark,
                             const ReversedTables& reversed);

}  // namespace vernier::exchange
