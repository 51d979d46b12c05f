// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/exchange/controller/test_moves.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace vernier::exchange {
namespace {

/// Without values above 0.1 um there is nothing to check.
constexpr double kVisible_mm = 1e-4;

/// Slope of the values of a table between the ends of its travel, mm/mm; 0 without a table. The slopes of two
/// axes by each other contain the rotation of the whole part with opposite signs: only their sum is an error
/// of the machine.
double slope_of(const ControllerTable* table) {
  if (table == nullptr) return 0;
  return (table->at(table->high, 1) - table->at(table->low, 1)) / (table->high - table->low);
}

}  // namespace

std::string positioning_move(const ControllerTable& table, const std::string& mark,
                             const std::string& reversed) {
  const auto [low, high] = std::minmax_element(table.forward.begin(), table.forward.end());
  if (*high - *low < kVisible_mm) return "";
  const auto a = static_cast<std::size_t>(low - table.forward.begin());
  const auto b = static_cast<std::size_t>(high - table.forward.begin());
  return fmt::format(
      "{0}Test move: with the table off, move {1} from {2:.3f} to {3:.3f} mm in the positive direction and\n"
      "{0}measure {4}: its error changes by {5:.1f} um. With the table on, this change must be near 0 um. "
      "If\n"
      "{0}the change is near {6:.1f} um, {7}.\n",
      mark, kLetters[table.input], std::clamp(table.position(std::min(a, b)), table.low, table.high),
      std::clamp(table.position(std::max(a, b)), table.low, table.high), kLetters[table.output],
      -1000 * (table.forward[std::max(a, b)] - table.forward[std::min(a, b)]),
      -2000 * (table.forward[std::max(a, b)] - table.forward[std::min(a, b)]), reversed);
}

std::string straightness_move(const ControllerTable& table, const std::string& mark,
                              const std::string& reversed) {
  double largest = 0, place = table.low;
  for (std::size_t k = 0; k < table.forward.size(); ++k) {
    const double position = std::clamp(table.position(k), table.low, table.high);
    const double line = table.at(table.low, 1) + slope_of(&table) * (position - table.low);
    if (const double bow = table.at(position, 1) - line; std::abs(bow) > std::abs(largest))
      largest = bow, place = position;
  }
  if (std::abs(largest) < kVisible_mm) return "";
  return fmt::format(
      "{0}Test move: with the table off, align a straightedge along {1}: the error of {2} is 0 at {3:.3f} "
      "and at\n"
      "{0}{4:.3f} mm. At {1} {5:.3f} mm the error of {2} is then {6:.1f} um. Switch the table on and align "
      "the\n"
      "{0}straightedge again: the error must be near 0 um. If the error is near {7:.1f} um,\n"
      "{0}{8}.\n",
      mark, kLetters[table.input], kLetters[table.output], table.low, table.high, place, -1000 * largest,
      -2000 * largest, reversed);
}

std::string squareness_moves(const ControllerTables& tables, const std::string& mark,
                             const ReversedTables& reversed) {
  std::string text;
  for (std::size_t first = 0; first < 3; ++first)
    for (std::size_t second = first + 1; second < 3; ++second) {
      const ControllerTable *of_first = tables.find(first, second), *of_second = tables.find(second, first);
      if (of_first == nullptr && of_second == nullptr) continue;
      const ControllerTable &along = *tables.find(first, first), &across = *tables.find(second, second);
      const double change = (slope_of(of_first) + slope_of(of_second)) * (across.high - across.low);
      if (std::abs(change) < kVisible_mm) continue;
      text += fmt::format(
          "{0}Test move for squareness: with the tables off, align one edge of a square along {1}: the error "
          "of\n"
          "{0}{2} is 0 at {1} {3:.3f} and {4:.3f} mm. Move {2} from {5:.3f} to {6:.3f} mm on the other edge "
          "and\n"
          "{0}measure {1}: its error changes by {7:.1f} um. Switch the tables on and align the square "
          "again:\n"
          "{0}this change must be near 0 um. If the change is near {8:.1f} um,\n"
          "{0}{9}.\n",
          mark, kLetters[first], kLetters[second], along.low, along.high, across.low, across.high,
          -1000 * change, -2000 * change, reversed(of_first, of_second));
    }
  return text;
}

}  // namespace vernier::exchange
