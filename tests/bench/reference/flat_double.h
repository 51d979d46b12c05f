// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <string>

#include "tools/compile/derive.h"

namespace vernier::bench {

using namespace vernier::compile;
using namespace vernier::model;

/// The machine's error equation, as the compiler derives it, printed as C++ in double with nothing else
/// changed: `void flat(const double* channel, double* deviation)`, channels in the units of the
/// machine file and the order of `channels`, in namespace vernier::`space`. The
/// peer that shows what fixed point costs. Throws InputError where the equation has a lag.
std::string print_flat_double(const Machine& machine, const Derivation& derivation,
                              const std::vector<Channel>& channels, const std::string& space);

}  // namespace vernier::bench
