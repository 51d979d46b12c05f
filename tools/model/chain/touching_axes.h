// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <cstddef>
#include <set>
#include <vector>

#include "tools/model/machine.h"
#include "tools/model/measurement.h"

namespace vernier::model {

/// An axis that moved until the tool touched has positions that the other axes and the touched object
/// determine, except for the error. Limits for that: rms of the position beside a polynomial of the other
/// axes over the rms of the error, and travel over the rms of the error.
inline constexpr double kRestOverError = 10, kTravelOverError = 100;

/// Returns the axes whose positions are readings of touches (`same`, `on`), and not commands: such a position
/// follows the error and is no cause of it. Empty if no row touches an object. rows: indices of the rows that
/// count; error_mm: rms of their error.
std::set<std::size_t> touching_axes(const Machine& machine, const Measurement& measurement,
                                    const std::vector<std::size_t>& rows, double error_mm);

/// Extent (diagonal, mm) of the points at which the tool was in these rows.
double extent_of_points(const Machine& machine, const Measurement& measurement,
                        const std::vector<std::size_t>& rows);

}  // namespace vernier::model
