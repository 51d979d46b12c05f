// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <string>

#include "tools/format/readings.h"
#include "tools/model/machine.h"

namespace vernier::create {

/// Returns the kind of reading with the given name: "point", "length" … If there is no such kind, throws
/// InputError with a list of all names.
const format::SurveyReading& reading_of(const std::string& word);

/// Returns a measurement file without readings. The file has comments that explain each column, the header
/// for this machine, and positions that show the errors of the machine. In the first rows, each axis moves
/// alone, forward and backward. After the rows in which one axis moves alone, the rows are poses over the
/// whole travel; every fourth of these poses is a check row. The cells for the measured values are empty.
/// Throws InputError if a fit of the machine would refuse the kind of reading.
std::string survey_template(const model::Machine& machine, const format::SurveyReading& reading);

/// Returns a survey as a workbook (.xlsx). The first sheet contains the rows, and the second sheet contains
/// the comments.
std::string survey_workbook(const std::string& survey);

}  // namespace vernier::create
