// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <string>

#include "tools/model/machine.h"

namespace vernier::exchange {

/// Returns the text of a machine file with the table of one axis replaced or added: stations in steps of the
/// given table, its interpolation and its free columns. The rest of the text is not changed. Throws
/// InputError if the text has no section for the table, or if reading the new text does not give the same
/// table.
std::string set_table(const std::string& text, const model::Machine& machine, const model::Table& table);

/// Throws InputError unless the chain uses every column of the table that is not zero.
void check_used(const model::Machine& machine, const model::Table& table);

/// Returns a table of an axis with one station per position, all values 0. Interpolation and free columns are
/// those of the machine's table. If the machine has no table, the result is linear and has no free column.
model::Table empty_table(const model::Machine& machine, std::size_t axis,
                         const std::vector<double>& positions);

/// Removes the rounding of binary arithmetic from a number of at most nine printed decimals.
double nine_decimals(double value);

}  // namespace vernier::exchange
