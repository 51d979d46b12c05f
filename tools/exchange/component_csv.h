// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <string>
#include <vector>

#include "tools/model/machine.h"

namespace vernier::exchange {

/// Returns the table of one axis as CSV `X[mm],lXx[mm],lXy[mm],lXz[mm],rXx[deg],rXy[deg],rXz[deg]`, without
/// rounding.
std::string axis_csv(const model::Machine& machine, const model::Table& table);

/// Reads the CSV table of one axis. The columns may be in any order, with any unit of their dimension. Names
/// of ISO 230 (EXX … ECX for axis X) are accepted. The values of a missing column are 0. The first column
/// contains the positions of the axis. If the CSV is not valid, throws InputError with file and line.
model::Table parse_axis_csv(const std::string& text, const std::string& file, const model::Machine& machine);

/// Returns the component errors of all tables in the ISG CSV format, for the volumetric compensation of ISG
/// and Beckhoff (TF5280) controllers. In the ISG CSV format each axis has one block: its argument (mm, deg)
/// and its six errors (mm, rad) with the names of ISO 230. Blanks separate columns, // begins a comment, and
/// # separates blocks. Sources are the manufacturers' pages "ISG CSV format", "Units of measure", "List of
/// parameters supported". Throws InputError if an axis has no letter of ISO 230, or if a table is cubic (the
/// controller interpolates linearly).
std::string isg_csv(const model::Machine& machine);

/// Reads the component errors of a file in the ISG CSV format. Throws InputError with file, line and word
/// for: a position error, an ISG parameter, a second argument (the tables of a machine file have one
/// argument), a row that is not valid.
std::vector<model::Table> parse_isg_csv(const std::string& text, const std::string& file,
                                        const model::Machine& machine);

}  // namespace vernier::exchange
