// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <random>

#include "tools/model/machine.h"
#include "tools/model/states.h"

namespace vernier::bench {

/// Evenly drawn.
double between(double low, double high, std::mt19937_64& random);

/// Three linear axes, drawn: their order, travels of 200 to 1200 mm, tables of 3 to 6 stations with some of
/// their columns free, squareness.
model::Machine drawn_machine(std::mt19937_64& random);

/// The machine with every parameter as far off as moves the tool point by `expected_um` rms, drawn.
model::Machine true_machine(const model::Machine& machine, double expected_um, std::mt19937_64& random);

model::States first_of(const model::States& states, std::size_t count);

/// Lines along every axis through the middle, and the four body diagonals, there and back, `each` places on
/// each; over the machine's work ranges.
model::States iso_lines(const model::Machine& machine, std::size_t each);

/// Evenly drawn over the machine's work ranges, either sense.
model::States anywhere(const model::Machine& machine, std::size_t count, std::mt19937_64& random);

/// Fewest poses, of a family that grows, after which `um_of` them is not above `um`; `most` where that does
/// not do. Bisection, since more poses never know less.
template <typename Uncertainty>
std::size_t fewest(std::size_t most, double um, const Uncertainty& um_of) {
  std::size_t low = 0, high = 1;
  while (high < most && um_of(high) > um) low = high, high *= 2;
  if (high >= most) return most;
  while (high - low > 1) {
    const std::size_t middle = (low + high) / 2;
    (um_of(middle) > um ? low : high) = middle;
  }
  return high;
}

}  // namespace vernier::bench
