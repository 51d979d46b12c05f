// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/import/columns/column_axes.h"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <cstddef>
#include <map>
#include <set>
#include <string>

#include "tools/format/columns.h"
#include "tools/format/units.h"
#include "tools/import/words/sheet_words.h"
#include "tools/text/words.h"

namespace vernier::importer {
namespace {

/// If no heading names an axis and the titles do, a target or an actual position belongs to that axis.
void settle_axis(const sheet::Sheet& sheet, const sheet::SheetTable& table, std::vector<SheetColumn>& columns,
                 const Guess& guess) {
  std::set<std::string> axes, of_deviations;
  bool read = false;
  for (std::size_t k = 0; k < columns.size(); ++k) {
    const SheetColumn& column = columns[k];
    if (column.use == SheetColumn::Use::kDeviation && guess.is_axis(column.name))
      of_deviations.insert(column.name);
    if (column.use != SheetColumn::Use::kColumn) continue;
    if (guess.is_axis(column.name)) axes.insert(column.name);
    // The heading of a mean may have the letter of a reading.
    if (!names_statistic(table.headings[k]))
      read |= std::find(format::columns::kPoint.begin(), format::columns::kPoint.end(), column.name) !=
              format::columns::kPoint.end();
  }
  // Straightness is a deviation of another axis than the one that moves.
  if (axes.empty()) {
    const std::string titled = axis_of_titles(sheet, table);
    axes = guess.is_axis(titled) ? std::set<std::string>{titled} : of_deviations;
  }
  const std::string axis = axes.size() == 1 ? *axes.begin() : "";
  if (axis.empty() || read) return;
  bool target = std::any_of(columns.begin(), columns.end(), [&](const SheetColumn& one) {
    return one.use == SheetColumn::Use::kColumn && one.name == axis;
  });
  bool actual = false;
  const auto has = [&](Guess::Bare kind) {
    return std::any_of(table.headings.begin(), table.headings.end(),
                       [&](const sheet::Heading& one) { return Guess::bare(one.name) == kind; });
  };
  // "Anzeige" beside "Laser" is the target.
  const bool shown = !has(Guess::Bare::kTarget) && has(Guess::Bare::kActual);
  for (std::size_t k = 0; k < columns.size(); ++k) {
    SheetColumn& column = columns[k];
    if (column.use != SheetColumn::Use::kColumn || column.why != "by its heading") continue;
    Guess::Bare bare = Guess::bare(table.headings[k].name);
    if (bare == Guess::Bare::kDisplay && shown) bare = Guess::Bare::kTarget;
    if (bare == Guess::Bare::kActual && !actual && reading_of(axis)) {
      column.name = *reading_of(axis);
      actual = true;
    } else if (bare == Guess::Bare::kTarget && !target) {
      column.name = axis;
      target = true;
    }
  }
}

/// Two measured positions along an axis without a target: the position shown by the machine counts as
/// commanded if another instrument measured.
void settle_display(const sheet::SheetTable& table, std::vector<SheetColumn>& columns, const Guess& guess) {
  std::map<std::string, std::size_t> count;
  for (const SheetColumn& column : columns)
    if (column.use == SheetColumn::Use::kColumn) ++count[column.name];
  for (std::size_t k = 0; k < columns.size(); ++k) {
    SheetColumn& column = columns[k];
    if (column.name.size() != 1 || count[column.name] < 2 || column.why != "by its heading") continue;
    const std::string axis(1, static_cast<char>(std::toupper(static_cast<unsigned char>(column.name[0]))));
    if (axis == column.name || !guess.is_axis(axis) || count[axis] > 0) continue;
    if (text::in_small_letters(table.headings[k].name).find("istposition") == std::string::npos) continue;
    --count[column.name];
    ++count[axis];
    column.name = axis;
  }
}

/// The position that the control shows is the commanded one if the table has another measurement of the axis
/// and no target. Beside a target it is no reading.
void settle_shown_position(const sheet::SheetTable& table, std::vector<SheetColumn>& columns,
                           const Guess& guess) {
  for (std::size_t k = 0; k < columns.size(); ++k) {
    SheetColumn& column = columns[k];
    if (column.use != SheetColumn::Use::kColumn || column.why != "by its heading") continue;
    std::string axis;
    bool display = false;
    for (const std::string& word : heading_words(table.headings[k].name)) {
      display |= says_display(text::in_small_letters(word));
      if (guess.is_axis(word)) axis = axis.empty() ? word : "more than one";
    }
    const auto unit = format::find_unit(column.unit);
    const bool large = column.unit.empty() || (unit && unit->factor >= 1);  // a gauge shows um
    if (!display || !large || !guess.is_axis(axis)) continue;
    bool target = false, measured = false;
    for (const SheetColumn& other : columns) {
      if (&other == &column || other.use == SheetColumn::Use::kLeft) continue;
      const bool deviation = other.use == SheetColumn::Use::kDeviation;
      target |= !deviation && other.name == axis;
      measured |= deviation ? other.name.empty() || other.name == axis : other.name == reading_of(axis);
    }
    if (measured && target)
      leave_column(column, fmt::format("the control shows this position; the target is the column {}", axis));
    else if (measured)
      column.name = axis;
  }
}

}  // namespace

void settle_axes(const sheet::Sheet& sheet, const sheet::SheetTable& table, std::vector<SheetColumn>& columns,
                 const Guess& guess) {
  settle_axis(sheet, table, columns, guess);
  settle_display(table, columns, guess);
  settle_shown_position(table, columns, guess);
}

}  // namespace vernier::importer
