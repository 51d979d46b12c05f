// SPDX-License-Identifier: GPL-3.0-or-later
// What the values of a column are, beside the positions of an axis, and values that need a word of the user
// before they are readings.
#pragma once
#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "tools/import/sizes/sized_column.h"
#include "tools/sheet/heading.h"
#include "tools/sheet/sheet.h"

namespace vernier::importer {

/// kOpposite: the positions with the opposite sign. kFalling: a constant minus the positions. kSteps: the
/// steps from row to row.
enum class Values { kUnclear, kPositions, kDeviations, kOpposite, kFalling, kSteps };

/// Two columns of a sheet with their units.
struct ColumnPair {
  std::size_t position = 0, reading = 0;
  std::string position_unit, reading_unit;
};

/// Compares the values of a column with the positions of an axis, row by row. With a unit on one side only
/// the result is kUnclear.
Values values_beside(const sheet::Sheet& sheet, const sheet::SheetTable& table, const ColumnPair& pair);

/// Returns what the user must do before the values of a column are readings: the values of kOpposite,
/// kFalling and kSteps; empty for others. `heading`: the heading of the column.
std::string work_before_reading(const sheet::Sheet& sheet, const sheet::SheetTable& table, Values values,
                                const ColumnPair& pair);

/// Returns the doubt of a column with the readings of a dial gauge in which the pointer passed zero: 9, 97
/// where -3 is meant. nullopt for other columns. `unit`: of the column.
std::optional<SizeDoubt> doubt_of_dial(const sheet::Sheet& sheet, const sheet::SheetTable& table,
                                       std::size_t column, const std::string& unit);

/// Judges readings of dial gauges that passed zero, and measured positions that are not those of the axis. A
/// column whose unit the
/// user stated, or that the user assigned (`given`), gets a note in place of the doubt.
std::vector<SizeDoubt> judge_raw_readings(sheet::Sheet& sheet, const sheet::SheetTable& table,
                                          const std::vector<SizedColumn>& columns);

/// Why a column with the numbers of the positions is no column of positions, and what to do.
std::string text_of_numbered_positions(const sheet::Heading& heading);

/// Returns why a table without readings can have no proposal of an assignment, with the remedy: numbers of
/// the positions in place of the positions, distances between two columns of positions, steps, and dial
/// gauges that passed zero. Empty: the headings decide.
std::string no_assignment(const sheet::Sheet& sheet, const sheet::SheetTable& table,
                          const std::vector<std::string>& units);

}  // namespace vernier::importer
