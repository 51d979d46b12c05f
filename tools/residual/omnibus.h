// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <string>
#include <vector>

#include "tools/residual/sample.h"

namespace vernier::residual {

struct Repeats;

struct Omnibus {
  double p = 1;
  std::string by;         // the test that says most
  std::size_t tried = 0;  // tests
};

/// One p-value for "this residual has some structure": the least of many tests, each with its share of the
/// chance of a false alarm (weighted Bonferroni), so that it stays valid however the tests depend on one
/// another. Tests of each kind apart and of all kinds together: constant; every column as a line, parabola,
/// curve; all columns together; products of pairs; sines over the axes; neighbours in order and in place;
/// repeats against lack of fit. tool.
Omnibus omnibus_test(const std::vector<KindSample>& samples, const std::vector<RecordedColumn>& columns,
                     const model::Measurement& measurement, const Repeats& repeats);

}  // namespace vernier::residual
