// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <string>
#include <vector>

#include "tools/model/machine.h"

namespace vernier::exchange {

/// Returns the table of one axis as CSV: `X[mm],lXx[mm],lXy[mm],lXz[mm],rXx[deg],rXy[deg],rXz[deg]`, exact.
std::string axis_csv(const model::Machine& machine, const model::Table& table);

/// Reads the CSV table of one axis. Columns have any order and any unit of their dimension; ISO 230 names
/// (EXX … ECX for axis X) are accepted; an absent column is 0. The first column is the axis. Throws
/// InputError with file and line.
model::Table parse_axis_csv(const std::string& text, const std::string& file, const model::Machine& machine);

/// Component errors of all tables in the ISG CSV format of the volumetric compensation of ISG and Beckhoff
/// (TF5280) controllers. Each axis has one block: its argument (mm, deg) and its six errors (mm, rad) under
/// ISO 230 names; blanks between columns, // comments, # between blocks. Source: the makers' pages "ISG CSV
/// format", "Units of measure", "List of parameters supported". Throws InputError if an axis has no ISO
/// letter or a table is cubic (the controller interpolates linearly).
std::string isg_csv(const model::Machine& machine);

/// Reads the component errors of a file in the ISG CSV format. Throws InputError with file, line and word: a
/// position error, an ISG parameter, a second argument (the tables of a machine file have one argument), a
/// malformed row.
std::vector<model::Table> parse_isg_csv(const std::string& text, const std::string& file,
                                        const model::Machine& machine);

}  // namespace vernier::exchange
