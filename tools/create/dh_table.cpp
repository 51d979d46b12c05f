// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/create/dh_table.h"

#include <fmt/format.h>

#include <cmath>
#include <optional>

#include "tools/format/csv_file.h"
#include "tools/format/units.h"
#include "tools/text/numbers.h"
#include "tools/text/words.h"

namespace vernier::create {
namespace {

double number_in(const std::string& text, const text::Place& place, const std::string& what) {
  const auto number = text::parse_number(text);
  if (!number) throw text::InputError(place, text, "not a number, for " + what);
  return *number;
}

/// The cells of one column in mm or deg; empty if the table has no such column.
std::optional<std::vector<double>> column(const format::CsvFile& csv, const std::string& name,
                                          format::Dimension dimension) {
  for (std::size_t k = 0; k < csv.columns.size(); ++k) {
    if (csv.columns[k].name != name) continue;
    const format::Unit unit = *format::find_unit(csv.columns[k].unit);
    // Published tables leave the units out; mm and deg are theirs.
    const bool bare = unit.dimension == format::Dimension::kNone;
    if (!bare && unit.dimension != dimension)
      throw text::InputError(
          {csv.file, csv.header_line}, name + "[" + unit.name + "]",
          std::string("this column needs a unit, for example ") + format::base_unit(dimension));
    std::vector<double> values;
    for (std::size_t row = 0; row < csv.rows.size(); ++row)
      values.push_back((bare ? 1 : unit.factor) *
                       number_in(csv.rows[row][k], {csv.file, csv.line[row]}, name));
    return values;
  }
  return std::nullopt;
}

bool is_prismatic(const std::string& word, const text::Place& place) {
  if (word == "P" || word == "p" || word == "prismatic") return true;
  if (word == "R" || word == "r" || word == "revolute" || word.empty()) return false;
  throw text::InputError(place, word, "the type of a joint must be R (turns) or P (slides)");
}

}  // namespace

bool DhRow::parallel() const { return beta != 0 || std::abs(std::sin(alpha * std::acos(-1.0) / 180)) < 1e-9; }

const std::vector<DhRow>& default_arm() {
  // Universal Robots, "DH parameters for calculations of kinematics and dynamics", UR10e.
  static const std::vector<DhRow> kRows = {{0, 180.7, 0, 90, false},   {0, 0, -612.7, 0, false},
                                           {0, 0, -571.55, 0, false},  {0, 174.15, 0, 90, false},
                                           {0, 119.85, 0, -90, false}, {0, 116.55, 0, 0, false}};
  return kRows;
}

std::vector<DhRow> parse_dh_table(const std::string& text, const std::string& file) {
  const format::CsvFile csv = format::parse_csv(text, file);
  for (const format::CsvColumn& known : csv.columns) {
    const std::string& name = known.name;
    if (name != "theta" && name != "d" && name != "a" && name != "alpha" && name != "type" && name != "joint")
      throw text::InputError(
          {file, csv.header_line}, name,
          "the table has an unknown column; the known columns are theta, d, a, alpha, type and joint");
  }
  const auto theta = column(csv, "theta", format::Dimension::kAngle),
             d = column(csv, "d", format::Dimension::kLength),
             a = column(csv, "a", format::Dimension::kLength),
             alpha = column(csv, "alpha", format::Dimension::kAngle);
  if (!d || !a || !alpha)
    throw text::InputError({file, csv.header_line}, !d ? "d" : !a ? "a" : "alpha", "this column is missing");
  std::vector<DhRow> rows;
  for (std::size_t row = 0; row < csv.rows.size(); ++row) {
    rows.push_back({theta ? (*theta)[row] : 0, (*d)[row], (*a)[row], (*alpha)[row], false});
    for (std::size_t k = 0; k < csv.columns.size(); ++k)
      if (csv.columns[k].name == "type")
        rows.back().prismatic = is_prismatic(csv.rows[row][k], {file, csv.line[row]});
  }
  return rows;
}

DhRow parse_dh_row(const std::string& words) {
  std::vector<std::string> parts = text::parts_of(words, ',');
  const text::Place place;
  DhRow row;
  if (parts.size() == 5) {
    row.prismatic = is_prismatic(parts.front(), place);
    parts.erase(parts.begin());
  }
  if (parts.size() != 4)
    throw text::InputError(fmt::format(
        "\"{}\": a joint is theta,d,a,alpha (deg,mm,mm,deg; P, before them for a prismatic joint)", words));
  row.theta = number_in(parts[0], place, "theta");
  row.d = number_in(parts[1], place, "d");
  row.a = number_in(parts[2], place, "a");
  row.alpha = number_in(parts[3], place, "alpha");
  return row;
}

}  // namespace vernier::create
