// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <cstddef>
#include <functional>
#include <string>
#include <vector>

#include "tools/sheet/sheet.h"

namespace vernier::importer {

/// The columns of a sheet that show the order of its rows.
struct RowOrder {
  std::size_t first_data = 0;       // index of the first row of data
  std::size_t position = 0;         // column with the positions of the axis
  std::size_t direction = 0;        // column with the approach directions of this axis
  std::vector<std::size_t> others;  // columns with the positions of the other axes
};

/// Rows whose approach direction contradicts the motion from the row before them.
struct DirectionDoubt {
  enum class Kind {
    kNone,
    kSame,     // one direction in all rows, although the same positions occur on the way out and back
    kShifted,  // the direction changes at another row than the motion
  };
  Kind kind = Kind::kNone;
  std::vector<std::size_t> lines;  // of the rows that contradict, in the file
  bool certain = false;  // true: no other axis moves, so that the rows are the path of this axis alone
};

/// Compares the approach directions with the order of the positions from row to row. `direction_of`: 1 or -1
/// for the cell of a direction, 0 for other texts. A table that is sorted by its positions, and a single row
/// at a turn of the motion (the machine moved beyond the end position), are no contradiction.
DirectionDoubt doubt_of_directions(const sheet::Sheet& sheet, const RowOrder& order,
                                   const std::function<int(const std::string&)>& direction_of);

/// Returns "line 7" or "lines 7, 8, 9, …".
std::string lines_text(const std::vector<std::size_t>& lines);

}  // namespace vernier::importer
