// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <string>
#include <vector>

#include "tools/residual/sample.h"

namespace vernier::residual {

struct Repeats;

struct Omnibus {
  double p = 1;
  std::string by;         // name of the test with the smallest p-value
  std::size_t tried = 0;  // number of tests
};

/// Returns one p-value for the statement "this residual has some structure". The p-value is the smallest of
/// many tests. Each test has its share of the probability of a false alarm (weighted Bonferroni). The
/// combined p-value is valid for any dependence between the tests. The tests are made for each kind of
/// reading and for all kinds together. The tests for structure are: constant; every column as a line,
/// parabola, curve; all columns together; products of two columns; sines over the axes; neighbours in order
/// and in position; repeats against lack of fit.
Omnibus omnibus_test(const std::vector<KindSample>& samples, const std::vector<RecordedColumn>& columns,
                     const model::Measurement& measurement, const Repeats& repeats);

}  // namespace vernier::residual
