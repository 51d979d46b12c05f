// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/exchange/component_csv.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <optional>
#include <sstream>

#include "tools/exchange/table_text.h"
#include "tools/format/csv_file.h"
#include "tools/format/units.h"
#include "tools/maths/factors.h"
#include "tools/text/numbers.h"

namespace vernier::exchange {
namespace {

constexpr std::array<const char*, 6> kDirections = {"X", "Y", "Z", "A", "B", "C"};

/// ISO 230 name of a component error: EXX, EYX … ECX.
std::string iso_name(std::size_t column, const std::string& axis) {
  return std::string("E") + kDirections[column] + axis;
}

bool has_iso_letter(const std::string& axis) {
  return std::find(kDirections.begin(), kDirections.end(), axis) != kDirections.end();
}

std::string own_name(const model::Machine& machine, std::size_t axis, std::size_t column) {
  return model::symbol_name(machine, {model::SymbolKind::kTableValue, 6 * axis + column});
}

/// Twelve digits: a round trip between deg and rad keeps them.
double twelve_digits(double value) { return *text::parse_number(fmt::format("{:.12g}", value)); }

double number_of(const std::string& word, const text::Place& place) {
  const auto value = text::parse_number(word);
  if (!value) throw text::InputError(place, word, "not a number");
  return *value;
}

void check_increasing(const model::Table& table, const std::string& file,
                      const std::vector<std::size_t>& lines) {
  for (std::size_t i = 1; i < table.stations.size(); ++i)
    if (table.stations[i].loc <= table.stations[i - 1].loc)
      throw text::InputError({file, lines[i]}, table.stations[i].loc_text, "positions must increase");
  if (table.stations.size() < 2)
    throw text::InputError({file, lines.at(0)}, "", "a table needs at least two rows");
}

std::vector<std::string> words_of(const std::string& line) {
  std::istringstream in(line.substr(0, line.find("//")));
  std::vector<std::string> words;
  for (std::string word; in >> word;) words.push_back(word);
  return words;
}

/// One block of an ISG file: header and rows.
struct Block {
  std::vector<std::string> header;
  std::vector<std::vector<std::string>> rows;
  std::size_t header_line = 0;
  std::vector<std::size_t> line;
};

std::vector<Block> blocks_of(const std::string& text, const std::string& file) {
  std::vector<Block> blocks(1);
  std::istringstream in(text);
  std::string line;
  for (std::size_t number = 1; std::getline(in, line); ++number) {
    std::vector<std::string> words = words_of(line);
    if (words.empty()) continue;
    Block& block = blocks.back();
    if (words[0].front() == '#') {
      if (!block.header.empty()) blocks.emplace_back();
    } else if (block.header.empty()) {
      block.header = std::move(words);
      block.header_line = number;
    } else {
      if (words.size() != block.header.size())
        throw text::InputError(
            {file, number}, words[0],
            fmt::format("this row has {} fields, but the header has {}", words.size(), block.header.size()));
      block.rows.push_back(std::move(words));
      block.line.push_back(number);
    }
  }
  if (blocks.back().header.empty()) blocks.pop_back();
  return blocks;
}

/// Which of the six errors of `axis` a word of the header is.
std::optional<std::size_t> error_column(const std::string& word, const std::string& axis) {
  for (std::size_t k = 0; k < 6; ++k)
    if (word == iso_name(k, axis)) return k;
  return std::nullopt;
}

model::Table table_of_block(const Block& block, const std::string& file, const model::Machine& machine) {
  const text::Place place{file, block.header_line};
  const auto is_argument = [](const std::string& word) { return has_iso_letter(word); };
  const auto arguments = std::count_if(block.header.begin(), block.header.end(), is_argument);
  if (arguments == 0)
    throw text::InputError(
        place, block.header[0],
        "this column is a position error or a parameter of the machine, not a component error; in a machine "
        "file it is a constant (static) with another sign and location");
  if (arguments > 1)
    throw text::InputError(
        place, block.header[1],
        "this column depends on two axes, but a table of a machine file depends on one axis");
  const auto found = std::find_if(block.header.begin(), block.header.end(), is_argument);
  const auto axis = machine.find_axis(*found);
  if (!axis) throw text::InputError(place, *found, "this machine has no axis of this name");
  const auto at = static_cast<std::size_t>(found - block.header.begin());
  std::vector<double> positions;
  for (std::size_t i = 0; i < block.rows.size(); ++i)
    positions.push_back(number_of(block.rows[i][at], {file, block.line[i]}));
  if (block.rows.empty()) throw text::InputError(place, *found, "the header has no rows below it");
  model::Table table = empty_table(machine, *axis, positions);
  table.interpolation = model::Interpolation::kLinear;
  for (std::size_t c = 0; c < block.header.size(); ++c) {
    if (c == at) continue;
    const auto column = error_column(block.header[c], *found);
    if (!column)
      throw text::InputError(place, block.header[c],
                             fmt::format("this column is not a component error of axis {}", *found));
    for (std::size_t i = 0; i < block.rows.size(); ++i) {
      const double value = number_of(block.rows[i][c], {file, block.line[i]});
      table.stations[i].value[*column] = *column < 3 ? value : twelve_digits(value * maths::kDegPerRad);
    }
  }
  check_increasing(table, file, block.line);
  return table;
}

}  // namespace

std::string axis_csv(const model::Machine& machine, const model::Table& table) {
  const model::Axis& axis = machine.axes[table.axis];
  std::string text = fmt::format(
      "# error table of axis {}, {} between rows, held at the ends; deviations (actual - nominal)\n{}{}",
      axis.name, table.interpolation == model::Interpolation::kCubic ? "cubic spline" : "linear", axis.name,
      axis.rotary ? "[deg]" : "[mm]");
  for (std::size_t k = 0; k < 6; ++k)
    text += "," + own_name(machine, table.axis, k) + (k < 3 ? "[mm]" : "[deg]");
  text += "\n";
  for (const model::Station& station : table.stations) {
    text += text::number_text(station.loc);
    for (const double value : station.value) text += "," + text::number_text(value);
    text += "\n";
  }
  return text;
}

model::Table parse_axis_csv(const std::string& text, const std::string& file, const model::Machine& machine) {
  const format::CsvFile csv = format::parse_csv(text, file);
  const text::Place place{file, csv.header_line};
  const auto axis = machine.find_axis(csv.columns[0].name);
  if (!axis)
    throw text::InputError(place, csv.columns[0].name, "the first column must be an axis of this machine");
  const auto numbers = [&](std::size_t column, format::Dimension dimension) {
    const format::Unit unit = *format::find_unit(csv.columns[column].unit);
    if (unit.dimension != dimension)
      throw text::InputError(
          place, csv.columns[column].name,
          std::string("this column needs a unit, for example ") + format::base_unit(dimension));
    std::vector<double> result;
    for (std::size_t i = 0; i < csv.rows.size(); ++i)
      result.push_back(unit.factor * number_of(csv.rows[i][column], {file, csv.line[i]}));
    return result;
  };
  const std::string& name = machine.axes[*axis].name;
  model::Table table = empty_table(
      machine, *axis,
      numbers(0, machine.axes[*axis].rotary ? format::Dimension::kAngle : format::Dimension::kLength));
  for (std::size_t c = 1; c < csv.columns.size(); ++c) {
    std::size_t k = 0;
    while (k < 6 && csv.columns[c].name != own_name(machine, *axis, k) &&
           csv.columns[c].name != iso_name(k, name))
      ++k;
    if (k == 6)
      throw text::InputError(place, csv.columns[c].name,
                             fmt::format("this column is not an error of axis {}; known are {} … or {} …",
                                         name, own_name(machine, *axis, 0), iso_name(0, name)));
    const std::vector<double> values =
        numbers(c, k < 3 ? format::Dimension::kLength : format::Dimension::kAngle);
    for (std::size_t i = 0; i < values.size(); ++i) table.stations[i].value[k] = values[i];
  }
  check_increasing(table, file, csv.line);
  return table;
}

std::string isg_csv(const model::Machine& machine) {
  std::string text =
      "// component errors, ISO 230 names; arguments in mm or deg, lengths in mm, angles in rad\n";
  bool first = true;
  for (const model::Table& table : machine.tables) {
    const std::string& axis = machine.axes[table.axis].name;
    if (!has_iso_letter(axis))
      throw text::InputError({machine.file, table.line}, axis,
                             "this format supports only the axes X, Y, Z, A, B and C");
    if (table.interpolation != model::Interpolation::kLinear)
      throw text::InputError({machine.file, table.line}, axis,
                             "a cubic table cannot be exported: the controller interpolates linearly");
    text += (first ? "" : "#\n") + axis;
    for (std::size_t k = 0; k < 6; ++k) text += "\t" + iso_name(k, axis);
    text += "\n";
    for (const model::Station& station : table.stations) {
      text += text::number_text(station.loc);
      for (std::size_t k = 0; k < 6; ++k)
        text += "\t" + (k < 3 ? text::number_text(station.value[k])
                              : fmt::format("{:.12g}", station.value[k] / maths::kDegPerRad));
      text += "\n";
    }
    first = false;
  }
  if (first) throw text::InputError({machine.file, 0}, "", "this machine has no table to export");
  return text;
}

std::vector<model::Table> parse_isg_csv(const std::string& text, const std::string& file,
                                        const model::Machine& machine) {
  std::vector<model::Table> tables;
  for (const Block& block : blocks_of(text, file)) {
    model::Table table = table_of_block(block, file, machine);
    for (const model::Table& other : tables)
      if (other.axis == table.axis)
        throw text::InputError({file, block.header_line}, machine.axes[table.axis].name,
                               "this axis already has a table");
    tables.push_back(std::move(table));
  }
  if (tables.empty()) throw text::InputError({file, 0}, "", "this file contains no component errors");
  return tables;
}

}  // namespace vernier::exchange
