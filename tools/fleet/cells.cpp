// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/fleet/cells.h"

#include <charconv>

#include "tools/text/numbers.h"

namespace vernier::fleet {

Cell cell(std::int64_t value) { return std::to_string(value); }
Cell cell(double value) { return text::number_text(value); }
std::string words(const Cell& cell) { return cell.value_or(std::string()); }

std::int64_t whole(const Cell& cell) {
  if (!cell) return 0;
  std::int64_t value = 0;
  const auto [end, error] = std::from_chars(cell->data(), cell->data() + cell->size(), value);
  if (error != std::errc() || end != cell->data() + cell->size())
    throw DatabaseError("\"" + *cell + "\" is no whole number");
  return value;
}

double real(const Cell& cell) {
  if (!cell) return 0;
  // Evidence may be beyond what the formats take for a number.
  double value = 0;
  const auto [end, error] = std::from_chars(cell->data(), cell->data() + cell->size(), value);
  if (error != std::errc() || end != cell->data() + cell->size())
    throw DatabaseError("\"" + *cell + "\" is no number");
  return value;
}

}  // namespace vernier::fleet
