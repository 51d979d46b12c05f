// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <string>
#include <string_view>
#include <vector>

#include "tools/sheet/heading.h"
#include "tools/sheet/sheet.h"

namespace vernier::importer {

/// What else states the runs and the directions of a column.
struct HeadingPlace {
  bool run = false;       // true: the heading names a run, and its numbers and directions are read
  bool directed = false;  // true: a column has the directions, and a direction in the heading is not read
};

/// Returns the words of a heading that no rule of the import reads, in their order: "zehnfach" for
/// "Abweichung X [µm] zehnfach". A sign before a word is a part of it: "-Abweichung".
std::vector<std::string> unread_words(std::string_view heading, const HeadingPlace& place);

/// Returns the texts in the line of the headings that head no column, each with the cells behind it: a cell
/// above no value, with words that no rule reads.
std::vector<std::string> texts_beside_headings(const sheet::Sheet& sheet, const sheet::SheetTable& table);

/// True if the name of a sheet in a workbook has other words than an axis, an instrument, a run or a number.
bool is_telling_name(const std::string& sheet);

}  // namespace vernier::importer
