// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <string>

#include "tools/model/machine.h"

namespace vernier::exchange {

/// The text of a machine file with the table of one axis replaced (or added): stations in steps of the table
/// given, its interpolation and its free columns; everything else as the user wrote it. Throws InputError
/// where the text has no place for it, or where reading it back does not give that table. tool.
std::string set_table(const std::string& text, const model::Machine& machine, const model::Table& table);

/// Throws InputError unless the chain uses every column of the table that is not zero.
void check_used(const model::Machine& machine, const model::Table& table);

/// A table of that axis with one station a position, all values 0; interpolation and free columns of the
/// table that the machine has, linear and none where it has none.
model::Table empty_table(const model::Machine& machine, std::size_t axis,
                         const std::vector<double>& positions);

/// Rounds away what binary arithmetic adds to a number of at most nine printed decimals.
double nine_decimals(double value);

}  // namespace vernier::exchange
