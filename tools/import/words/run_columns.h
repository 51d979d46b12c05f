// SPDX-License-Identifier: GPL-3.0-or-later
// What the heading of one column states in a table with a column for each run.
#pragma once
#include <cstddef>
#include <optional>
#include <string>
#include <utility>

#include "tools/sheet/heading.h"

namespace vernier::importer {

/// One run in one approach direction, as its heading describes it.
struct RunColumn {
  std::size_t column = 0;
  std::string run, axis, unit;
  int sense = 0;
  bool deviation = false, measured = false, turned = false, pos = false;
  bool length = false;    // the sign by the length of the motion: "positiv = zu kurz"
  bool forth = false;     // the direction by a word of the survey: "hin", "zurück", "forward"
  bool relative = false;  // the direction by a word that is not about the axis: "hin", "forward", "up"
};

/// Returns the run and the approach direction of a heading ("Lauf 1 hin [um]", "1-", "Run 2 ↑"); nullopt if
/// the heading has a word that is not about a run. RunColumn::column is not set.
std::optional<RunColumn> run_column(const sheet::Heading& heading);

/// Returns a heading of positions with an approach direction ("X Soll hin", "X+ Pos"), without the word for
/// the direction; the direction is 0 for other headings.
std::pair<int, sheet::Heading> position_of_direction(const sheet::Heading& heading);

}  // namespace vernier::importer
