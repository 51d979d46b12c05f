// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <string>
#include <vector>

#include "tools/residual/sample.h"

namespace vernier::residual {

struct Repeats;

struct Omnibus {
  double p = 1;
  std::string by;         // the test with the smallest p-value
  std::size_t tried = 0;  // number of tests
};

/// Returns one p-value for "this residual has some structure". The p-value is the smallest of many tests,
/// each with its share of the probability of a false alarm (weighted Bonferroni). The p-value is valid for
/// any dependence between the tests. The tests are made for each kind separately and for all kinds together:
/// constant; every column as a line, parabola, curve; all columns together; products of pairs; sines over the
/// axes; neighbours in order and in position; repeats against lack of fit.
Omnibus omnibus_test(const std::vector<KindSample>& samples, const std::vector<RecordedColumn>& columns,
                     const model::Measurement& measurement, const Repeats& repeats);

}  // namespace vernier::residual
