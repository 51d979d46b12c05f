// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/registry/cells.h"

#include <charconv>

#include "tools/text/numbers.h"

namespace vernier::registry {
namespace {

// Not text::parse_number: evidence may exceed the range of numbers in the formats.
template <typename Number>
Number read(const Cell& cell, const char* what) {
  if (!cell) return 0;
  Number value = 0;
  const auto [end, error] = std::from_chars(cell->data(), cell->data() + cell->size(), value);
  if (error != std::errc() || end != cell->data() + cell->size())
    throw DatabaseError("\"" + *cell + "\" is no " + what);
  return value;
}

}  // namespace

Cell cell(std::int64_t value) { return std::to_string(value); }
Cell cell(double value) { return text::number_text(value); }
std::string words(const Cell& cell) { return cell.value_or(std::string()); }

std::int64_t whole(const Cell& cell) { return read<std::int64_t>(cell, "whole number"); }
double real(const Cell& cell) { return read<double>(cell, "number"); }

}  // namespace vernier::registry
