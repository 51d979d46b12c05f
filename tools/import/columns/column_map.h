// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <string>
#include <utility>
#include <vector>

#include "tools/import/columns/delimited.h"
#include "tools/text/error.h"

namespace vernier::importer {

/// A column of the measurement file, and the source of its values.
struct MappedColumn {
  std::string source;      // column number from 1, or name in the header line; empty for a constant
  std::string constant;    // the value, if every row has the same value
  std::string name, unit;  // name and unit of the column in the measurement file
  text::Place place;       // line of the map; an argument of the command line has no file
  bool of_title = false;   // true: a title of the file states the constant, and a profile does not store it
};

/// Meaning of the columns in the table of an instrument.
struct ColumnMap {
  DelimitedFormat format;
  std::vector<MappedColumn> columns;
};

/// Reads a column map. Each line has one statement; comments begin with #.
///   column 3 = x[mm]                  (third column)
///   column Temp 1 = T_column[degC]     (column with this name in the header)
///   set run = s1
///   set u[um] = 5                      (the same value in every row)
///   separator = semicolon
///   decimal = comma
///   skip = 2
///   comment = %
///   header = yes
/// If the column map is not valid, throws InputError with file, line and word.
void read_column_map(ColumnMap& map, const std::string& text, const std::string& file);

/// Adds a column map entry: "3=x[mm]" or "Name=x[mm]" with add_column, "run=s1" or "u[um]=5" with
/// add_constant. Throws InputError if the text is not an entry of a column map.
void add_column(ColumnMap& map, const std::string& words, const text::Place& place = {});
void add_constant(ColumnMap& map, const std::string& words, const text::Place& place = {});

/// Returns the cell of the measurement file for a constant that the user states. A decimal comma
/// ("u[um]=0,5") becomes a decimal point ("0.5"). Constants that are words (labels) do not change.
/// `decimal_comma`: true if the imported file has decimal commas. The flag `decimal_comma` determines the
/// meaning of "1,234". Throws InputError if the constant of a numeric column is not a number, or if its comma
/// can be a separator of thousands.
std::string constant_cell(const MappedColumn& column, bool decimal_comma);

/// A table that becomes a measurement file. The columns of the table contain text, with one cell for every
/// row.
struct ImportTable {
  struct Column {
    std::string name, unit;
    std::vector<std::string> cells;  // numbers have a decimal point; an empty cell was not measured
  };
  std::string file;
  std::vector<Column> columns;
  std::vector<std::size_t> line;  // line of each row in `file`

  const Column* find(const std::string& name) const;
  /// Returns the numbers of a column in the base unit of its dimension. Throws InputError for an empty cell
  /// or a unit of another dimension.
  std::vector<double> numbers(const std::string& name) const;
  void remove(const std::string& name);
  void add(const std::string& name, const std::string& unit, const std::vector<double>& values);
};

/// True if the first line of the table has the names of the columns: the map says so, or names a column.
bool has_header(const ColumnMap& map);

/// Returns the columns of a file that the map names. Every number is written with a decimal point. Columns of
/// words are not changed. Throws InputError with file, line and word for: a column that does not exist, a
/// cell that is not a number, an unknown unit, a column name that occurs twice.
ImportTable mapped_table(const std::string& text, const std::string& file, const ColumnMap& map);

/// Writes a table as the text of a measurement file, and reads this text back as a test. Throws InputError if
/// the text is not a valid measurement file.
std::string measurement_csv(const ImportTable& table);

}  // namespace vernier::importer
