// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <functional>
#include <nlohmann/json.hpp>
#include <string>

#include "tools/import/reading/sheet_import.h"
#include "tools/model/machine.h"

namespace vernier::workbench {

/// True if the first line of a text is that of a measurement file: names with units, separated by commas, one
/// of them a reading. A text with another first line may be a spreadsheet.
bool begins_as_measurement(const std::string& text);

/// Returns how a spreadsheet is read, as JSON: {how, sheet, sheets: names of all sheets of a workbook,
/// tables_beside: names of the other visible sheets with tables, separator, decimal, heading_line, columns
/// (columns_json), rows: the first as cells, csv: the first lines of the measurement file, n_rows, message:
/// reason why it is not a measurement yet}. A table of distances between named points also has points:
/// {names, axes: [{name, unit}], missing: names without a position}. The log of a robot (robot_log.h) also
/// has robot: [{column: index, name, unit}]. `machine`: the chosen machine; null: none. Throws InputError if
/// the file does not contain a table.
nlohmann::ordered_json sheet_preview(const std::string& bytes, const std::string& file,
                                     const importer::SheetWords& words,
                                     const model::Machine* machine = nullptr);

/// Returns the options in a request, with the names of the options of `vernier import table`: separator,
/// decimal, comment, sheet, unit (texts), skip (number), column, deviation, leave, set (lists). Throws
/// InputError if an option of the request is not valid.
importer::SheetWords sheet_words(const nlohmann::json& request);

/// Returns the points of a request, with the names of the options of `vernier import table`: point (list),
/// nominal (name of a file, which `reads` returns). `machine`: the chosen machine; null: none. Throws
/// InputError if a point is not valid, or if a list is given without a machine.
using ReadsFile = std::function<std::string(const std::string& file)>;
importer::NamedPoints sheet_points(const nlohmann::json& request, const importer::SheetWords& words,
                                   const model::Machine* machine, const ReadsFile& reads);

}  // namespace vernier::workbench
