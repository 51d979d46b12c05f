// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/import/tables/thousands.h"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <cmath>
#include <optional>
#include <string>
#include <string_view>
#include <utility>

#include "tools/format/units.h"
#include "tools/import/columns/column_guess.h"
#include "tools/maths/median.h"
#include "tools/sheet/sheet_number.h"
#include "tools/text/error.h"
#include "tools/text/numbers.h"

namespace vernier::importer {
namespace {

using Use = SheetColumn::Use;

/// Both meanings of a cell.
struct Meanings {
  double decimal = 0, thousands = 0;
  std::string whole;  // the cell without the sign
};

class Thousands {
 public:
  Thousands(sheet::Sheet& sheet, const sheet::SheetTable& table, const std::vector<SheetColumn>& columns)
      : sheet_(sheet), table_(table), columns_(columns) {}

  /// Decides by the other columns; true if a cell was written again, which then decides other cells.
  bool by_the_other_columns(std::size_t k) {
    std::vector<std::pair<std::size_t, Meanings>> whole;
    std::size_t decimals = 0;
    bool sure = false;  // another cell of the column can only be a decimal number
    for (std::size_t row = table_.first_data; row < sheet_.rows.size(); ++row) {
      const auto value = value_at(row, k);
      const auto other = beside(row, k);
      const auto both = both_meanings(row, k);
      sure |= value && has_sign(row, k);
      if (!other || *other == 0) continue;
      if (both && agree(both->thousands, *other))
        whole.emplace_back(row, *both);
      else if ((both && agree(both->decimal, *other)) || (value && has_sign(row, k) && agree(*value, *other)))
        ++decimals;
    }
    // Only the doubtful cells agree, and only as thousands: the unit of a column may be wrong instead.
    if (whole.empty() || (sure && decimals == 0)) return false;
    note(k, whole.front(), whole.size(), "the position beside it agrees");
    for (const auto& [row, both] : whole) sheet_.rows[row][k] = both.whole;
    return true;
  }

  /// Decides a column of whole numbers and doubtful cells.
  void by_size(std::size_t k) {
    std::vector<std::pair<std::size_t, Meanings>> doubtful;
    std::vector<double> whole;
    bool integers = false, confirmed = false;
    for (std::size_t row = table_.first_data; row < sheet_.rows.size(); ++row) {
      const auto both = both_meanings(row, k);
      const auto other = both ? beside(row, k) : std::nullopt;
      if (both) doubtful.emplace_back(row, *both);
      confirmed |= other && *other != 0 && agree(both->decimal, *other);
      const auto value = both ? std::nullopt : value_at(row, k);
      if (value && has_sign(row, k)) return;
      integers |= value.has_value();
      if (value && *value != 0) whole.push_back(std::abs(*value));
    }
    if (doubtful.empty() || !integers || confirmed) return;
    std::vector<double> sizes;
    for (const auto& [row, both] : doubtful) sizes.push_back(std::abs(both.decimal));
    // The logarithms of the two meanings are 3 apart: nearer than 1 to the whole numbers is clear.
    constexpr double kClear = 10;
    const double ratio = whole.empty() ? 0 : maths::median(sizes) / maths::median(whole);
    if (ratio > 1 / kClear) return;
    if (whole.empty() || ratio > kClear / 1000) refuse(k, doubtful.front());
    note(k, doubtful.front(), doubtful.size(), "the whole numbers of this column have this size");
    for (const auto& [row, both] : doubtful) sheet_.rows[row][k] = both.whole;
  }

  /// Refuses the targets of a linear axis whose numbers can all be thousands, in a table where no cell shows
  /// the decimal sign. A measured position with as many decimals decides: no machine is wrong by whole
  /// millimetres at each target.
  void refuse_undecided_targets(std::size_t k) const {
    constexpr double kLongestAxis_mm = 20'000;  // a longer one is hardly measured
    constexpr std::size_t kFewest = 2;
    const auto unit = format::find_unit(columns_[k].unit);
    if (!sheet_.decimal_doubtful || !is_linear_axis(columns_[k]) || !unit) return;
    std::vector<std::pair<std::size_t, Meanings>> doubtful;
    for (std::size_t row = table_.first_data; row < sheet_.rows.size(); ++row) {
      const auto both = both_meanings(row, k);
      const auto value = value_at(row, k);
      if (!both && value && *value != 0) return;
      if (both && std::abs(both->thousands) * unit->factor > kLongestAxis_mm) return;
      if (both) doubtful.emplace_back(row, *both);
      for (std::size_t other = 0; other < columns_.size(); ++other)
        if (columns_[other].use == Use::kColumn && reading_of(columns_[k].name) == columns_[other].name &&
            both_meanings(row, other))
          return;
    }
    if (doubtful.size() < kFewest) return;
    const auto& [row, both] = doubtful.front();
    throw text::InputError(
        {sheet_.file, sheet_.line[row]}, sheet_.rows[row][k],
        fmt::format(
            "this cell of \"{}\" can be {:.6g} or {:.6g}: no cell of the table shows whether the {} is "
            "the decimal sign or separates thousands. If the cell is {:.6g}, give --decimal {}; if the "
            "cell is {:.6g}, give --decimal {}",
            table_.headings[k].text, both.decimal, both.thousands, sheet_.decimal_comma ? "comma" : "point",
            both.decimal, sheet_.decimal_comma ? "comma" : "point", both.thousands,
            sheet_.decimal_comma ? "point" : "comma"));
  }

 private:
  static bool is_linear_axis(const SheetColumn& column) {
    return column.use == Use::kColumn && column.name.size() == 1 &&
           std::string_view("XYZUVW").find(column.name) != std::string_view::npos && !is_angle(column.unit);
  }

  std::optional<double> value_at(std::size_t row, std::size_t k) const {
    const auto number = sheet::plain_number(sheet_.rows[row][k], sheet_.decimal_comma);
    return number ? text::parse_number(*number) : std::nullopt;
  }
  char sign() const { return sheet_.decimal_comma ? ',' : '.'; }
  bool has_sign(std::size_t row, std::size_t k) const {
    return !both_meanings(row, k) && sheet_.rows[row][k].find(sign()) != std::string::npos;
  }

  std::optional<Meanings> both_meanings(std::size_t row, std::size_t k) const {
    const std::string& cell = sheet_.rows[row][k];
    if (cell.find(sign()) == std::string::npos || sheet_.exact.contains(cell)) return std::nullopt;
    const auto decimal = sheet::plain_number(cell, sheet_.decimal_comma),
               whole = sheet::plain_number(cell, !sheet_.decimal_comma);
    if (!decimal || !whole) return std::nullopt;
    return Meanings{*text::parse_number(*decimal), *text::parse_number(*whole), *whole};
  }

  /// The position in the other column of the axis, in the unit of this column; no doubtful cell.
  std::optional<double> beside(std::size_t row, std::size_t k) const {
    for (std::size_t other = 0; other < columns_.size(); ++other) {
      const bool pair = columns_[other].use == Use::kColumn && columns_[k].use == Use::kColumn &&
                        (reading_of(columns_[k].name) == columns_[other].name ||
                         reading_of(columns_[other].name) == columns_[k].name);
      if (!pair || both_meanings(row, other)) continue;
      const auto unit = format::find_unit(columns_[k].unit), its = format::find_unit(columns_[other].unit);
      const auto value = value_at(row, other);
      const bool known = unit && its && !columns_[k].unit.empty() && !columns_[other].unit.empty();
      return value && known ? std::optional(*value * its->factor / unit->factor) : value;
    }
    return std::nullopt;
  }

  static bool agree(double one, double other) {
    constexpr double kShare = 0.05;  // no machine is wrong by a twentieth of its travel
    return std::abs(one - other) < kShare * std::max(std::abs(one), std::abs(other));
  }

  void note(std::size_t k, const std::pair<std::size_t, Meanings>& first, std::size_t cells,
            const char* reason) {
    sheet_.notes.push_back(
        fmt::format("\"{}\": {} {} such as \"{}\" (line {}) {} read as {}, because {}; if this is wrong, "
                    "give --decimal {}",
                    table_.headings[k].text, cells, cells == 1 ? "cell" : "cells",
                    sheet_.rows[first.first][k], sheet_.line[first.first], cells == 1 ? "is" : "are",
                    first.second.whole, reason, sheet_.decimal_comma ? "comma" : "point"));
  }

  [[noreturn]] void refuse(std::size_t k, const std::pair<std::size_t, Meanings>& first) const {
    const std::string &cell = sheet_.rows[first.first][k], &whole = first.second.whole;
    throw text::InputError(
        {sheet_.file, sheet_.line[first.first]}, cell,
        fmt::format(
            "this cell of \"{}\" can be {:.6g} or {}: the column has whole numbers too, and no other cell "
            "decides. If the cell is {:.6g}, give --decimal {}; if the cell is {}, write {} into the file",
            table_.headings[k].text, first.second.decimal, whole, first.second.decimal,
            sheet_.decimal_comma ? "comma" : "point", whole, whole));
  }

  sheet::Sheet& sheet_;
  const sheet::SheetTable& table_;
  const std::vector<SheetColumn>& columns_;
};

}  // namespace

void settle_thousands(sheet::Sheet& sheet, const sheet::SheetTable& table,
                      const std::vector<SheetColumn>& columns) {
  Thousands thousands(sheet, table, columns);
  const auto is_number = [&](std::size_t k) {
    return columns[k].use != Use::kLeft && !columns[k].words && !is_label(columns[k].name) &&
           !is_sense(columns[k].name);
  };
  constexpr int kPasses = 3;  // a cell that is decided decides the one beside it
  const auto decide_beside = [&] {
    bool any = true;
    for (int pass = 0; any && pass < kPasses; ++pass) {
      any = false;
      for (std::size_t k = 0; k < columns.size(); ++k)
        if (is_number(k)) any |= thousands.by_the_other_columns(k);
    }
  };
  decide_beside();
  for (std::size_t k = 0; k < columns.size(); ++k)
    if (is_number(k)) thousands.by_size(k);
  decide_beside();
  for (std::size_t k = 0; k < columns.size(); ++k) thousands.refuse_undecided_targets(k);
}

}  // namespace vernier::importer
