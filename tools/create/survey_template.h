// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <string>

#include "tools/format/readings.h"
#include "tools/model/machine.h"

namespace vernier::create {

/// Finds a kind of reading by its word: "point", "length" … Throws InputError, which lists all words.
const format::SurveyReading& reading_of(const std::string& word);

/// Returns a measurement file to be filled in: remarks that explain each column, the header for this machine,
/// and positions that show its errors. First every axis moves alone, forward and backward. Then poses over
/// the whole travel follow; every fourth pose is a check row. The measured cells are empty. Throws InputError
/// if a fit would refuse such readings of the machine.
std::string survey_template(const model::Machine& machine, const format::SurveyReading& reading);

/// Returns a survey as a workbook (.xlsx): the rows on the first sheet, the remarks on the second.
std::string survey_workbook(const std::string& survey);

}  // namespace vernier::create
