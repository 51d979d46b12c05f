// SPDX-License-Identifier: GPL-3.0-or-later
#include "tests/support/term_discovery.h"

#include <gtest/gtest.h>

#include <cmath>

#include "tools/fit/fit.h"
#include "tools/model/machine_reader.h"

namespace vernier::support {

using namespace vernier::fit;
using namespace vernier::model;
namespace {

double correlation(Eigen::VectorXd a, Eigen::VectorXd b) {
  a.array() -= a.mean();
  b.array() -= b.mean();
  return a.dot(b) / (a.norm() * b.norm());
}

TEST(TermDiscovery, HasTheSizesOfTheBenchmark) {
  for (std::uint64_t seed = 1; seed <= 20; ++seed) {
    SCOPED_TRACE(seed);
    const TermDiscovery data = make_term_discovery(seed, 12);
    ASSERT_EQ(data.reading_um.size(), 2000);
    ASSERT_EQ(data.inputs.cols(), 12);
    EXPECT_NEAR(std::sqrt(data.geometry_um.squaredNorm() / 2000), 3.3, 1e-9);
    EXPECT_NEAR(std::abs(data.coefficient), 12 * data.bound, 1e-15);
    for (const Eigen::Index c : {1, 2}) {
      EXPECT_GT(correlation(data.inputs.col(0), data.inputs.col(c)), 0.85);
      EXPECT_LT(correlation(data.inputs.col(0), data.inputs.col(c)), 0.99);
    }
  }
}

TEST(TermDiscovery, IsTheSameForASeed) {
  EXPECT_EQ(make_term_discovery(3, 5).reading_um, make_term_discovery(3, 5).reading_um);
  EXPECT_NE(make_term_discovery(3, 5).reading_um, make_term_discovery(4, 5).reading_um);
}

// The files against the bound: the term, put into the machine, is found by a fit as often off as it must be.
TEST(TermDiscovery, FilesGiveTheCoefficientWithinItsBound) {
  double squares = 0;
  for (std::uint64_t seed = 1; seed <= 20; ++seed) {
    const TermDiscovery data = make_term_discovery(seed, 5);
    TermDiscoveryFiles files = term_discovery_files(data);
    files.model.replace(files.model.find("<BaseShift"), 0, "<c value=\"0\" nominal=\"0\"/>");
    files.model.replace(files.model.find("<comptables>"), 0,
                        "<inputs><T unit=\"degC\" reference=\"20\"/></inputs>");
    files.model.replace(files.model.find("X+lXx"), 1, "X+c*(T-20)*X");
    const Machine machine = parse_machine(files.model, "model.xml");
    const FitResult result = fit::fit(machine, parse_measurement(files.csv, "survey.csv", machine));
    const double found = result.machine.statics[*result.machine.find_static("c")].value;
    squares += std::pow((1000 * found - data.coefficient) / data.bound, 2);
  }
  EXPECT_NEAR(std::sqrt(squares / 20), 1, 0.48);  // three sigma of a standard deviation from 20
}

}  // namespace
}  // namespace vernier::support
