// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/import/sizes/row_shift.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <optional>
#include <string>

#include "tools/maths/median.h"

namespace vernier::importer {
namespace {

constexpr std::size_t kFewestPairs = 5;  // a shorter column agrees with a shifted one by chance
/// The differences from the targets of their own rows are this many times as large as from those of the
/// neighbours: a usual error of a machine is a thousandth of its steps.
constexpr double kTimesOwn = 15;
constexpr double kSeen_mm = 0.5, kSeen_deg = 0.1;  // no difference is judged below this size
/// Share of the rows that must agree: a shifted table of several runs has a wrong pair at each begin.
constexpr double kMostPairs = 0.8;
/// A display whose zero is one step away is right within this share of the step by chance only.
constexpr double kOfStep = 0.01;

/// A row with a target and a measured position, both in mm or deg.
struct Pair {
  double target = 0, measured = 0;
};

std::vector<Pair> pairs_of(const sheet::Sheet& sheet, const sheet::SheetTable& table,
                           const std::vector<SizedColumn>& columns, std::size_t target, std::size_t reading) {
  std::vector<Pair> pairs;
  for (std::size_t row = table.first_data; row < sheet.rows.size(); ++row) {
    const auto at = sheet::number_at(sheet, row, target), read = sheet::number_at(sheet, row, reading);
    if (at && read)
      pairs.push_back(
          {*at * sized_unit(columns[target])->factor, *read * sized_unit(columns[reading])->factor});
  }
  return pairs;
}

/// Differences of the measured positions from the targets `shift` rows below: their median, and the distance
/// from it that most rows do not exceed.
struct Agreement {
  double middle = 0, most = 0;
};

Agreement agreement(const std::vector<Pair>& pairs, std::ptrdiff_t shift) {
  std::vector<double> apart;
  const auto count = static_cast<std::ptrdiff_t>(pairs.size());
  for (std::ptrdiff_t i = 0; i < count; ++i)
    if (i + shift >= 0 && i + shift < count)
      apart.push_back(pairs[static_cast<std::size_t>(i)].measured -
                      pairs[static_cast<std::size_t>(i + shift)].target);
  const double middle = maths::median(apart);
  for (double& one : apart) one = std::abs(one - middle);
  std::sort(apart.begin(), apart.end());
  const auto last = static_cast<std::size_t>(kMostPairs * static_cast<double>(apart.size() - 1));
  return {middle, apart[last]};
}

/// Size of all steps between the targets; nullopt: the steps are not equal.
std::optional<double> equal_step(const std::vector<Pair>& pairs) {
  constexpr double kRounding = 1e-6;  // of a step, by the digits of the targets
  const double step = pairs[1].target - pairs[0].target;
  for (std::size_t i = 1; i < pairs.size(); ++i)
    if (std::abs(pairs[i].target - pairs[i - 1].target - step) > kRounding * std::abs(step))
      return std::nullopt;
  return step;
}

/// A sentence about a column that is shifted by `shift` rows.
std::string shifted_text(const Agreement& own, const Agreement& other, std::ptrdiff_t shift, bool angle) {
  return fmt::format(
      "the measured positions agree with the targets of the row {} them (within {}), and differ from the "
      "targets of their own row by up to {}: the column is probably shifted by one row against the targets",
      shift > 0 ? "below" : "above", size_text(other.most, angle),
      size_text(own.most + std::abs(own.middle), angle));
}

std::optional<SizeDoubt> shifted(sheet::Sheet& sheet, const sheet::SheetTable& table,
                                 const std::vector<SizedColumn>& columns, std::size_t target,
                                 std::size_t reading) {
  const std::vector<Pair> pairs = pairs_of(sheet, table, columns, target, reading);
  if (pairs.size() < kFewestPairs) return std::nullopt;
  const bool angle = sized_unit(columns[reading])->dimension == format::Dimension::kAngle;
  const Agreement own = agreement(pairs, 0);
  const double visible = angle ? kSeen_deg : kSeen_mm;
  for (const std::ptrdiff_t shift : {1, -1}) {
    const Agreement other = agreement(pairs, shift);
    const std::string text = shifted_text(own, other, shift, angle);
    if (own.most > visible && own.most > kTimesOwn * other.most && std::abs(other.middle) < own.most)
      return SizeDoubt{
          reading, sheet.line[table.heading_row], "",
          fmt::format("{}; move the column by one row; if the rows are right, give --column "
                      "\"{}[{}]={}\"",
                      text, columns[reading].name, columns[reading].unit, table.headings[reading].text)};
    const auto step = equal_step(pairs);
    if (step && std::abs(*step) > visible && other.most < kOfStep * std::abs(*step) &&
        std::abs(other.middle) < kOfStep * std::abs(*step))
      sheet.notes.push_back(fmt::format("\"{}\": {}, or the zero of the instrument is one step away",
                                        table.headings[reading].text, text));
  }
  return std::nullopt;
}

/// Notes a column of readings whose first row alone is empty: the first sign of a column that is shifted by a
/// row and cut off at the end.
void note_empty_first_row(sheet::Sheet& sheet, const sheet::SheetTable& table,
                          const std::vector<SizedColumn>& columns, std::size_t reading) {
  const std::string axis =
      columns[reading].measures.empty() ? columns[reading].positions : columns[reading].measures;
  const auto position = std::find_if(columns.begin(), columns.end(), [&](const SizedColumn& one) {
    return one.use == SizedColumn::Use::kPosition && one.axis && one.name == axis;
  });
  if (position == columns.end()) return;
  const auto at = static_cast<std::size_t>(position - columns.begin());
  std::vector<std::size_t> empty;
  std::size_t rows = 0;
  for (std::size_t row = table.first_data; row < sheet.rows.size(); ++row) {
    if (!sheet::number_at(sheet, row, at)) continue;
    if (!sheet::number_at(sheet, row, reading)) empty.push_back(row);
    ++rows;
  }
  if (rows < kFewestPairs || empty.size() != 1 || empty.front() != table.first_data) return;
  sheet.notes.push_back(fmt::format(
      "\"{}\" is empty in line {} only, the first row: if the column is shifted by one row against the "
      "positions, move it; otherwise the row has no reading",
      table.headings[reading].text, sheet.line[empty.front()]));
}

}  // namespace

std::vector<SizeDoubt> judge_row_shift(sheet::Sheet& sheet, const sheet::SheetTable& table,
                                       const std::vector<SizedColumn>& columns) {
  std::vector<SizeDoubt> doubts;
  for (std::size_t k = 0; k < columns.size(); ++k) {
    const auto unit = sized_unit(columns[k]);
    const bool measured = columns[k].use == SizedColumn::Use::kPosition && !columns[k].measures.empty();
    if (!unit || (!measured && columns[k].use != SizedColumn::Use::kDeviation)) continue;
    note_empty_first_row(sheet, table, columns, k);
    if (!measured) continue;
    for (std::size_t target = 0; target < columns.size(); ++target) {
      const SizedColumn& one = columns[target];
      if (one.use != SizedColumn::Use::kPosition || !one.axis || one.name != columns[k].measures ||
          !sized_unit(one) || sized_unit(one)->dimension != unit->dimension)
        continue;
      auto doubt = shifted(sheet, table, columns, target, k);
      if (doubt && columns[k].stated && !columns[k].profile)
        sheet.notes.push_back(fmt::format("\"{}\": {}", table.headings[k].text,
                                          doubt->text.substr(0, doubt->text.find("; move the column"))));
      else if (doubt)
        doubts.push_back(std::move(*doubt));
    }
  }
  return doubts;
}

}  // namespace vernier::importer
