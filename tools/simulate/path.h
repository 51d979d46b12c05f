// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "tools/format/csv_file.h"
#include "tools/format/units.h"
#include "tools/model/machine.h"
#include "tools/model/states.h"

namespace vernier::simulate {

/// A path file (FORMATS section 3, `simulate`) with the columns `t[s]`, axes, inputs and motion, which are
/// found by name. A column is converted to numbers when a machine uses it. Machines with different inputs can
/// therefore use one path. A column that no machine uses is ignored.
class Path {
 public:
  /// Throws InputError if there is no column t, if a time is empty or not a number, or if the times do not
  /// increase.
  Path(const std::string& text, const std::string& file);

  std::size_t rows() const { return csv_.rows.size(); }
  /// Returns the times of the rows, s, strictly increasing.
  const model::Column& time() const { return time_; }
  bool has(const std::string& name) const { return index_of(name).has_value(); }
  /// Returns the numbers of a column in the base unit of its dimension. Throws InputError if the column is
  /// absent, has another dimension, or contains a cell that is empty or not a number.
  model::Column numbers(const std::string& name, format::Dimension dimension) const;
  /// Returns the values of an input in the unit that the machine declares.
  model::Column input(const model::Input& input) const;
  /// Returns the cells of a column as text, without conversion.
  std::vector<std::string> words(const std::string& name) const;
  const std::string& file() const { return csv_.file; }

 private:
  std::optional<std::size_t> index_of(const std::string& name) const;
  model::Column read(std::size_t column) const;

  format::CsvFile csv_;
  model::Column time_;
};

/// Reads a path file.
Path read_path(const std::string& file);

/// Times of the ticks along a path. Tick k is at time()[0] + k * period, from the first row to the last row.
struct Ticks {
  model::Column time;                // time of each tick, s
  std::vector<std::size_t> segment;  // index of the row at or before the tick; never the last row if there
                                     // are two rows
  model::Column fraction;            // 0..1: position of the tick between this row and the next row
  std::size_t count() const { return segment.size(); }
};

/// Returns the ticks along a path. `period_s`: time between two ticks.
Ticks ticks_of(const Path& path, double period_s);

}  // namespace vernier::simulate
