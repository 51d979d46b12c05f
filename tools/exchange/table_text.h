// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <string>

#include "tools/model/machine.h"

namespace vernier::exchange {

/// Returns the text of a machine file with the table of one axis replaced or added. Stations, interpolation
/// and free columns are those of the given table. The rest of the machine file is not changed. Throws
/// InputError if the text has neither an element <comptables> nor an element <variables>. Throws InputError
/// if the new text does not give the same table when it is read.
std::string set_table(const std::string& text, const model::Machine& machine, const model::Table& table);

/// Throws InputError if the chain does not use a column of the table that is not zero.
void check_used(const model::Machine& machine, const model::Table& table);

/// Returns a table for an axis with one station per position. All values are 0. The interpolation and the
/// free columns are those of the machine's existing table. If the machine has no table for this axis, the
/// result is linear and has no free column.
model::Table empty_table(const model::Machine& machine, std::size_t axis,
                         const std::vector<double>& positions);

/// Returns the table of an axis at other stations: the values that the given table has there. Throws
/// InputError if the machine has no table of the axis.
model::Table table_at(const model::Machine& machine, std::size_t axis, const std::vector<double>& positions);

/// Returns a number of at most nine decimals without the rounding error of binary arithmetic.
double nine_decimals(double value);

}  // namespace vernier::exchange
