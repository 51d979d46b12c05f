// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "tools/model/measurement.h"

namespace vernier::fit {

/// Returns the values of the columns in a row (mm, deg or the unit of an input) in steps of 0.1 um, 0.0001
/// deg: rows at one pose have the same values.
std::vector<std::int64_t> rounded_values(const std::vector<model::Column>& columns, std::size_t row);

/// Two rows at one pose whose measured points cannot both be right.
struct ContradictingRows {
  std::size_t row = 0, other = 0;
  double apart_um = 0;  // distance of the two measured points
};

/// Finds measured points (x, y, z) at one pose that differ by far more than their standard uncertainty u and
/// than the points of other repeated poses: a row that was written to the wrong pose. Rows are at one pose if
/// their file, set-up, touched object, commanded positions, directions, inputs and active image are equal. Of
/// three rows and more, each row is compared with their median, so that a drift is no contradiction. Limits:
/// the constants in the source, with their reasons. The largest difference is first.
std::vector<ContradictingRows> contradicting_rows(const model::Measurement& m);

/// Returns a sentence about such rows: the lines, the difference, and what to do; empty for an empty list.
std::string contradiction_in_words(const model::Measurement& m, const std::vector<ContradictingRows>& list);

}  // namespace vernier::fit
