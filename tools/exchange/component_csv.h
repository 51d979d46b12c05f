// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <string>
#include <vector>

#include "tools/model/machine.h"

namespace vernier::exchange {

/// Table of one axis as a measurement-like CSV: `X[mm],lXx[mm],lXy[mm],lXz[mm],rXx[deg],rXy[deg],rXz[deg]`,
/// exact.
std::string axis_csv(const model::Machine& machine, const model::Table& table);

/// Reads one; columns in any order and unit, lengths and angles in their dimension; also ISO 230 names (EXX …
/// ECX for axis X); a column left out is 0. The first column is the axis. Throws InputError with file and
/// line. tool.
model::Table parse_axis_csv(const std::string& text, const std::string& file, const model::Machine& machine);

/// Component errors of all tables in the ISG CSV format of the volumetric compensation of ISG and Beckhoff
/// (TF5280) controllers. One block per axis: its argument (mm, deg) and its six errors (mm, rad) under ISO
/// 230 names; blanks between columns, // comments, # between blocks. Source: the makers' pages "ISG CSV
/// format", "Units of measure", "List of parameters supported". Throws InputError if an axis has no ISO
/// letter or a table is cubic (the controller interpolates linearly). tool.
std::string isg_csv(const model::Machine& machine);

/// Reads the component errors of such a file. Throws InputError with file, line and word: a position error,
/// an ISG parameter or a second argument (which a machine file's tables cannot hold), a malformed row. tool.
std::vector<model::Table> parse_isg_csv(const std::string& text, const std::string& file,
                                        const model::Machine& machine);

}  // namespace vernier::exchange
