// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <string>

#include "tools/format/readings.h"
#include "tools/model/machine.h"

namespace vernier::create {

/// By its word: "point", "length" … Throws InputError with all words.
const format::SurveyReading& reading_of(const std::string& word);

/// A measurement file to be filled in, with remarks that explain each column, the header for this machine,
/// and positions that show its errors. First every axis alone, forward and backward; then poses over the
/// whole travel, every fourth one a check row. The measured cells are empty. Throws InputError if a fit would
/// refuse such readings of this machine. tool.
std::string survey_template(const model::Machine& machine, const format::SurveyReading& reading);

/// Such a survey as a workbook (.xlsx): its rows on the first sheet, the remarks on the second. tool.
std::string survey_workbook(const std::string& survey);

}  // namespace vernier::create
