// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <cstddef>
#include <string>
#include <vector>

#include "tools/import/columns/sheet_wishes.h"
#include "tools/sheet/heading.h"
#include "tools/sheet/sheet.h"

namespace vernier::importer {

/// A line between rows of data that states the run or the approach direction of the rows below it.
struct RunLine {
  std::size_t line = 0;  // of the file
  std::string text, run;
  int sense = 0;
  bool way = false;  // true: a direction of the survey ("Hinfahrt"), false: of the axis ("X+")
};

/// Takes lines with a run or a direction alone ("Hinfahrt", "Lauf 2 X-") out of a sheet: at least two, the
/// first of them above all rows of data. Other sheets do not change, and the result is empty.
std::vector<RunLine> take_run_lines(sheet::Sheet& sheet);
/// Adds columns for the run and the direction that `lines` state, with a note.
void add_run_lines(sheet::Sheet& sheet, sheet::SheetTable& table, const std::vector<RunLine>& lines);

/// Adds columns for the run and the approach direction that a title above a table states ("Lauf 2
/// rückwärts"), with a note. A direction of the survey ("Hinfahrt") is the way that the rows go. Does nothing
/// if the titles state no run and no direction, if they contradict each other, or if a heading or a constant
/// of the user already states the same. `one_of_several`: false for the only table of a file. A run without a
/// direction is then not read, nor a direction if the rows go in both directions.
void add_run_of_title(sheet::Sheet& sheet, sheet::SheetTable& table,
                      const std::vector<MappedColumn>& constants, bool one_of_several);

/// Throws InputError if a title names one axis ("Achse: Y") and the columns have the positions of one other
/// axis alone. The message has the options for both meanings. Columns that the user assigned, and an axis
/// with a constant position, are no contradiction.
void refuse_another_axis(const sheet::Sheet& sheet, const sheet::SheetTable& table,
                         const std::vector<SheetColumn>& columns, const SheetWishes& wishes);

/// Notes that the axis of the positions is that of the name of the sheet, or that the columns are assigned to
/// another axis.
void note_axis_of_name(sheet::Sheet& sheet, const sheet::SheetTable& table,
                       const std::vector<SheetColumn>& columns, const SheetWishes& wishes);

}  // namespace vernier::importer
