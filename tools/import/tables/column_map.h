// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <string>
#include <utility>
#include <vector>

#include "tools/import/tables/delimited.h"
#include "tools/text/error.h"

namespace vernier::importer {

/// Source of a column of the measurement file.
struct MappedColumn {
  std::string source;      // a number from 1, or a name in the header line; empty for a constant
  std::string constant;    // the value, if it is the same in every row
  std::string name, unit;  // of the measurement file
  text::Place place;       // line of the map; no file for an argument
};

/// Meaning of the columns of an instrument's table.
struct ColumnMap {
  DelimitedFormat format;
  std::vector<MappedColumn> columns;
};

/// Reads a column map: one statement per line, # comments.
///   column 3 = x[mm]      (third column)      column Temp 1 = T_column[degC]   (column named so in the
///   header) set run = s1          set u[um] = 5       (the same in every row) separator = semicolon decimal
///   = comma   skip = 2   comment = %   header = yes
/// Throws InputError with file, line and word.
void read_column_map(ColumnMap& map, const std::string& text, const std::string& file);

/// Adds "3=x[mm]" or "Name=x[mm]"; "run=s1" or "u[um]=5". Throws InputError.
void add_column(ColumnMap& map, const std::string& words, const text::Place& place = {});
void add_constant(ColumnMap& map, const std::string& words, const text::Place& place = {});

/// Returns the cell of the measurement file for a constant that the user states ("u[um]=0,5"): a decimal
/// comma becomes a decimal point, "0.5". Words of a label do not change. decimal_comma: true if the imported
/// file has a decimal comma; it decides the meaning of "1,234". Throws InputError: no number for a column of
/// numbers, or a comma that can separate thousands.
std::string constant_cell(const MappedColumn& column, bool decimal_comma);

/// A table that becomes a measurement file: columns of text, one cell for every row.
struct ImportTable {
  struct Column {
    std::string name, unit;
    std::vector<std::string> cells;  // numbers with a decimal point; empty: not measured
  };
  std::string file;
  std::vector<Column> columns;
  std::vector<std::size_t> line;  // of each row in `file`

  const Column* find(const std::string& name) const;
  /// Returns the numbers of a column in the base unit of its dimension; an empty cell or another dimension is
  /// an error.
  std::vector<double> numbers(const std::string& name) const;
  void remove(const std::string& name);
  void add(const std::string& name, const std::string& unit, const std::vector<double>& values);
};

/// The columns of a file that the map names, every number read and written with a decimal point. Columns of
/// words are not changed. Throws InputError with file, line and word: a column that does not exist, not a
/// number, an unknown unit, a name twice.
ImportTable mapped_table(const std::string& text, const std::string& file, const ColumnMap& map);

/// Writes the table as a measurement file and reads the file back as a test. Throws InputError if that fails.
std::string measurement_csv(const ImportTable& table);

}  // namespace vernier::importer
