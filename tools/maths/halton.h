// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <cstddef>

namespace vernier::maths {

/// Returns the element `index` of van der Corput's sequence in a prime base, 0..1. If each dimension has its
/// own base, these sequences together are Halton's sequence, which is evenly distributed over all dimensions
/// (Halton 1960).
double radical_inverse(std::size_t index, std::size_t base);

}  // namespace vernier::maths
