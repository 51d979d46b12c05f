// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/import/sizes/deviation_sizes.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <optional>
#include <string>

#include "tools/format/columns.h"
#include "tools/format/units.h"
#include "tools/maths/median.h"
#include "tools/sheet/unit_factor.h"
#include "tools/text/words.h"

namespace vernier::importer {
namespace {

/// Limits of the sizes of one quantity, in mm or in deg.
struct Limits {
  double surely;      // half of the deviations are larger: no machine tool, and hardly a robot, is that wrong
  double visible;     // no share of the travel, and no single row, is judged below this size
  double unusual;     // a larger deviation is noted
  double resolution;  // no instrument of a workshop resolves less
};
/// Errors of machine tools are below 0.5 mm, those of most robots below 2 mm.
constexpr Limits kLengths = {5, 0.5, 2, 1e-4};
/// Uncalibrated robots are wrong by up to 12 mm. A table of a robot has the positions of several rotary
/// joints.
constexpr Limits kLengthsOfRobots = {15, 0.5, 5, 1e-4};
constexpr std::size_t kJointsOfRobot = 3;  // machine tools have at most two rotary axes
/// Rotary tables are right within 1 arcmin, worn ones within 0.1 deg; autocollimators resolve 0.01 arcsec.
constexpr Limits kAngles = {1, 0.1, 0.2, 2.5e-6};
/// Deviations that are a larger share of the travel: a scale error of a twentieth is no error of a machine
/// (kSlope in column_values.cpp).
constexpr double kImplausibleShare = 0.05;
/// Ratio of two neighbours in the sorted sizes that only a factor of 1000 or a slipped decimal sign explains.
constexpr double kGap = 100;
/// Two columns of one machine whose deviations differ by this ratio do not have the same unit.
constexpr double kApart = 300;
constexpr std::size_t kMostGroups = 200;  // more runs are labels of the rows
constexpr std::size_t kFewestSizes = 3;   // fewer rows show no usual size

/// A column of deviations in mm or deg, row after row.
struct Sizes {
  std::size_t column = 0;
  bool angle = false;             // true: the sizes are in deg
  std::vector<double> size;       // absolute values
  std::vector<std::size_t> line;  // their lines in the file
  double median = 0, largest = 0;
  Limits limits = kLengths;
  bool stated = false;  // true: the user stated the largest plausible deviation
};

/// Limits of one quantity for this table.
Limits limits_of(const std::vector<SizedColumn>& columns, bool angle, const PlausibleDeviation& plausible) {
  const auto joints = std::count_if(columns.begin(), columns.end(), [](const SizedColumn& one) {
    return one.axis && one.use == SizedColumn::Use::kPosition && sized_unit(one) &&
           sized_unit(one)->dimension == format::Dimension::kAngle;
  });
  const bool robot = static_cast<std::size_t>(joints) >= kJointsOfRobot;
  Limits limits = angle ? kAngles : robot ? kLengthsOfRobots : kLengths;
  if (const auto most = angle ? plausible.deg : plausible.mm) limits.surely = limits.unusual = *most;
  return limits;
}

std::optional<Sizes> sizes_of(const sheet::Sheet& sheet, const sheet::SheetTable& table,
                              const std::vector<SizedColumn>& columns, std::size_t k,
                              const PlausibleDeviation& plausible) {
  const auto unit = sized_unit(columns[k]);
  if (columns[k].use != SizedColumn::Use::kDeviation || !unit) return std::nullopt;
  Sizes sizes;
  sizes.column = k;
  sizes.angle = unit->dimension == format::Dimension::kAngle;
  sizes.limits = limits_of(columns, sizes.angle, plausible);
  sizes.stated = (sizes.angle ? plausible.deg : plausible.mm).has_value();
  for (std::size_t row = table.first_data; row < sheet.rows.size(); ++row)
    if (const auto value = sheet::number_at(sheet, row, k)) {
      sizes.size.push_back(std::abs(*value) * unit->factor);
      sizes.line.push_back(sheet.line[row]);
    }
  if (sizes.size.size() < kFewestSizes) return std::nullopt;
  sizes.median = maths::median(sizes.size);
  sizes.largest = *std::max_element(sizes.size.begin(), sizes.size.end());
  return sizes;
}

/// What the user does about a wrong unit, and how the unit is confirmed if it is right.
std::string unit_remedy(const sheet::SheetTable& table, const SizedColumn& column, std::size_t k) {
  const sheet::Heading& heading = table.headings[k];
  const std::string wrong = heading.unit.empty()
                                ? fmt::format("state another unit (--unit, or --deviation \"{}[um]={}\")",
                                              column.name, heading.text)
                                : "correct the unit in the heading";
  // The option would confirm a unit without its factor.
  if (sheet::names_factor(heading.text))
    return fmt::format(
        "the heading has a factor that is not read as part of the unit [{}]: write the unit with "
        "its factor in brackets, such as [0.01mm], or convert the values",
        column.unit);
  return fmt::format("if the unit [{}] is wrong, {}; if it is right, give --deviation \"{}[{}]={}\"",
                     column.unit, wrong, column.name, column.unit, heading.text);
}

/// The position column of the axis of a deviation.
std::optional<std::size_t> positions_of(const std::vector<SizedColumn>& columns, const SizedColumn& one) {
  for (std::size_t k = 0; k < columns.size(); ++k)
    if (columns[k].use == SizedColumn::Use::kPosition && columns[k].name == one.positions &&
        sized_unit(columns[k]) && sized_unit(columns[k])->dimension == sized_unit(one)->dimension)
      return k;
  return std::nullopt;
}

double travel_along(const sheet::Sheet& sheet, const sheet::SheetTable& table,
                    const std::vector<SizedColumn>& columns, std::size_t position) {
  std::vector<double> at;
  for (std::size_t row = table.first_data; row < sheet.rows.size(); ++row)
    if (const auto value = sheet::number_at(sheet, row, position))
      at.push_back(*value * sized_unit(columns[position])->factor);
  if (at.empty()) return 0;
  const auto [least, most] = std::minmax_element(at.begin(), at.end());
  return *most - *least;
}

/// What is wrong with the sizes of one column, beside its travel and its other rows; empty: nothing.
struct SizeVerdict {
  bool refuse = false;
  std::size_t line = 0;  // 0: of the heading
  std::string words;
  bool too_large = false;  // true: a larger limit of plausible deviations would accept the column
};

/// The option that accepts the deviations of all columns: their largest one, rounded up.
std::string limit_remedy(const std::vector<Sizes>& all, bool angle) {
  double largest = 0;
  for (const Sizes& one : all) largest = one.angle == angle ? std::max(largest, one.largest) : largest;
  const double digit = std::pow(10, std::floor(std::log10(largest)));
  return fmt::format(" (for all columns of this machine: --deviation {:.6g}{})",
                     digit * std::ceil(largest / digit), angle ? "deg" : "mm");
}

SizeVerdict beside_other_rows(const Sizes& sizes) {
  std::vector<double> sorted = sizes.size;
  std::erase_if(sorted, [](double one) { return one == 0; });
  std::sort(sorted.begin(), sorted.end());
  for (std::size_t i = 1; i < sorted.size(); ++i) {
    // A few small values among large ones are near a zero of the error.
    const bool usual = i >= 2 && 4 * i >= sorted.size();
    if (!usual || sorted[i] < sizes.limits.visible || sorted[i] < kGap * sorted[i - 1]) continue;
    const auto at =
        std::find_if(sizes.size.begin(), sizes.size.end(), [&](double one) { return one >= sorted[i]; });
    const std::size_t row = static_cast<std::size_t>(at - sizes.size.begin()), many = sorted.size() - i;
    return {true, sizes.line[row],
            fmt::format("the deviation {} in this row{} is more than {} times as large as the other ones (at "
                        "most {}): correct the cell or its unit",
                        size_text(*at, sizes.angle),
                        many > 1 ? fmt::format(" (and in {} more)", std::to_string(many - 1)) : "", kGap,
                        size_text(sorted[i - 1], sizes.angle))};
  }
  return {};
}

SizeVerdict beside_travel(const Sizes& sizes, double travel, const std::string& axis) {
  const std::string along =
      travel > 0 ? fmt::format(", and {} moves by {}", axis, size_text(travel, sizes.angle)) : "";
  const bool share = !sizes.stated && travel > 0 && sizes.median > kImplausibleShare * travel &&
                     sizes.median > sizes.limits.visible;
  if (sizes.median > sizes.limits.surely || share)
    return {true, 0,
            fmt::format("half of the deviations are larger than {}{}: no machine has such errors",
                        size_text(sizes.median, sizes.angle), along),
            true};
  if (sizes.largest > sizes.limits.unusual)
    return {false, 0,
            fmt::format("the deviations are as large as {}{}: unusual for a machine",
                        size_text(sizes.largest, sizes.angle), along)};
  if (sizes.largest > 0 && sizes.largest < sizes.limits.resolution)
    return {false, 0,
            fmt::format("all deviations are below {}, less than an instrument resolves",
                        size_text(sizes.limits.resolution, sizes.angle))};
  return {};
}

/// Groups of rows of one column, one of which has another unit: run 1 in um and run 2 in mm, or one approach
/// direction in another unit than the other.
SizeVerdict beside_other_groups(const sheet::Sheet& sheet, const sheet::SheetTable& table,
                                const std::vector<SizedColumn>& columns, const Sizes& sizes,
                                std::size_t of_group, const char* what) {
  std::map<std::string, Sizes> groups;
  for (std::size_t row = table.first_data; row < sheet.rows.size(); ++row) {
    const auto value = sheet::number_at(sheet, row, sizes.column);
    // Rows that are exactly 0 show no size.
    if (!value || *value == 0) continue;
    Sizes& one = groups[sheet.rows[row][of_group]];
    one.size.push_back(std::abs(*value) * sized_unit(columns[sizes.column])->factor);
    one.line.push_back(sheet.line[row]);
  }
  if (groups.size() > kMostGroups) return {};
  for (auto& [name, one] : groups) one.median = maths::median(one.size);
  for (const auto& [name, one] : groups)
    for (const auto& [larger, other] : groups) {
      const bool enough = one.size.size() >= kFewestSizes && other.size.size() >= kFewestSizes;
      if (!enough || one.median <= 0 || other.median < kApart * one.median) continue;
      return {
          true, one.line.front(),
          fmt::format("the deviations of {0} {1} are about {2}, those of {0} {3} about {4}: the two {0}s do "
                      "not have the same unit",
                      what, name, size_text(one.median, sizes.angle), larger,
                      size_text(other.median, sizes.angle))};
    }
  return {};
}

SizeVerdict beside_other_runs(const sheet::Sheet& sheet, const sheet::SheetTable& table,
                              const std::vector<SizedColumn>& columns, const Sizes& sizes) {
  const std::string sense = format::entry_of(format::AxisQuantity::kSense).prefix;
  for (std::size_t k = 0; k < columns.size(); ++k) {
    if (columns[k].use == SizedColumn::Use::kDeviation) continue;
    const bool run = columns[k].name == format::columns::kRun;
    if (!run && columns[k].name != sense + columns[sizes.column].name) continue;
    SizeVerdict verdict = beside_other_groups(sheet, table, columns, sizes, k, run ? "run" : "direction");
    if (!verdict.words.empty()) return verdict;
  }
  return {};
}

/// Positions in a smaller unit than their deviations: the units of the two headings are exchanged.
bool exchanged(const std::vector<SizedColumn>& columns, std::size_t deviation, std::size_t position) {
  return sized_unit(columns[position])->factor < sized_unit(columns[deviation])->factor;
}

}  // namespace

std::vector<SizeDoubt> judge_deviation_sizes(sheet::Sheet& sheet, const sheet::SheetTable& table,
                                             const std::vector<SizedColumn>& columns,
                                             const PlausibleDeviation& plausible) {
  std::vector<SizeDoubt> doubts;
  std::vector<Sizes> all;
  for (std::size_t k = 0; k < columns.size(); ++k)
    if (auto sizes = sizes_of(sheet, table, columns, k, plausible)) all.push_back(std::move(*sizes));
  const std::size_t heading_line = sheet.line[table.heading_row];
  const auto say = [&](std::size_t k, const SizeVerdict& verdict) {
    if (verdict.words.empty()) return;
    const bool angle =
        columns[k].unit.empty() ? false : sized_unit(columns[k])->dimension == format::Dimension::kAngle;
    const std::string text = fmt::format("{}; {}{}", verdict.words, unit_remedy(table, columns[k], k),
                                         verdict.too_large ? limit_remedy(all, angle) : "");
    if (verdict.refuse && !columns[k].stated) {
      const bool known =
          std::any_of(doubts.begin(), doubts.end(), [&](const auto& one) { return one.column == k; });
      if (!known) doubts.push_back({k, verdict.line > 0 ? verdict.line : heading_line, "", text});
      return;
    }
    sheet.notes.push_back(
        fmt::format("\"{}\"{}: {}", table.headings[k].text,
                    verdict.line > 0 ? fmt::format(", line {}", std::to_string(verdict.line)) : "",
                    verdict.refuse ? verdict.words : text));
  };
  for (const Sizes& sizes : all) {
    const std::size_t k = sizes.column;
    const auto position = positions_of(columns, columns[k]);
    const double travel = position ? travel_along(sheet, table, columns, *position) : 0;
    SizeVerdict verdict = beside_other_runs(sheet, table, columns, sizes);
    if (verdict.words.empty()) verdict = beside_other_rows(sizes);
    if (verdict.words.empty()) verdict = beside_travel(sizes, travel, columns[k].name);
    if (position && exchanged(columns, k, *position)) {
      verdict.too_large = false;
      verdict.refuse = sizes.median > kImplausibleShare * travel;
      verdict.line = 0;
      verdict.words = fmt::format(
          "the positions \"{}\" are in the smaller unit [{}] and their deviations in [{}]{}: the units of "
          "the two headings are probably exchanged",
          table.headings[*position].text, columns[*position].unit, columns[k].unit,
          travel > 0
              ? fmt::format(", so {} would move by {} only", columns[k].name, size_text(travel, sizes.angle))
              : "");
    }
    say(k, verdict);
  }
  for (const Sizes& one : all)
    for (const Sizes& other : all) {
      if (one.angle != other.angle || one.median <= 0 || other.median < kApart * one.median ||
          one.largest > one.limits.resolution)
        continue;
      say(one.column,
          {true, 0,
           fmt::format("the deviations are about {}, those of \"{}\" about {}: the two columns cannot both "
                       "have the right unit",
                       size_text(one.median, one.angle), table.headings[other.column].text,
                       size_text(other.median, other.angle))});
    }
  return doubts;
}

void note_decimal_parts(sheet::Sheet& sheet, const sheet::SheetTable& table,
                        const std::vector<SizedColumn>& columns) {
  for (std::size_t k = 0; k < columns.size(); ++k) {
    const std::string& unit = columns[k].unit;
    if (unit != "0.1mm" && unit != "0.01mm" && unit != "0.0001in") continue;
    const std::string small = text::in_small_letters(table.headings[k].text);
    const bool tenths = unit == "0.0001in" && small.find("tenth") != std::string::npos;
    sheet.notes.push_back(fmt::format(
        "\"{}\": one unit is {}{}", table.headings[k].text,
        unit == "0.0001in" ? "0.0001 inch (2.54 um)"
        : unit == "0.1mm"  ? "0.1 mm"
                           : "0.01 mm (10 um)",
        tenths ? ", a tenth of a thousandth of an inch; for tenths of a millimetre write [0.1 mm] "
                 "in the heading"
               : ""));
  }
}

}  // namespace vernier::importer
