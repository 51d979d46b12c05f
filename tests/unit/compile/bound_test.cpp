// SPDX-License-Identifier: GPL-3.0-or-later
#include <gtest/gtest.h>

#include "tests/unit/compile/agreement.h"
#include "tests/unit/effects/candidates.h"
#include "tools/compile/derive.h"
#include "tools/compile/solve.h"
#include "tools/compile/symbolic/calculus.h"
#include "tools/compile/symbolic/ranges.h"
#include "tools/compile/walk.h"
#include "tools/model/machine_reader.h"

namespace vernier::bound_test {

using namespace vernier::compile;
using namespace vernier::model;
namespace {

class ErrorBound : public testing::TestWithParam<const char*> {};

TEST_P(ErrorBound, HoldsAgainstTheDoubleChainOverRandomPoses) {
  constexpr unsigned kSeed = 20260701;
  const std::size_t poses = pose_count();
  const TestMachine test(GetParam());
  const Agreement seen = compare(test, (poses + 9999) / 10000, std::min<std::size_t>(poses, 10000), kSeed);
  const double bound = largest_bound_um(test.compiled);
  std::printf(
      "%s: seed %u, %zu poses: deviation up to %.2f um, |fixed - double| <= %.6f um seen, %.6f um proved, "
      "share %.3f\n",
      GetParam(), kSeed, poses, seen.largest_um, seen.worst_um, bound, seen.worst_share);
  EXPECT_LE(seen.worst_share, 1.0);
  // Within a correction (2.3 mm of 300 at most, but a second evaluation's micrometres mostly) of a step.
  EXPECT_LE(seen.at_steps, seen.poses / 5000);
  EXPECT_GT(seen.largest_um, 5.0);  // there is something to correct
  EXPECT_GT(seen.worst_um, 1e-7);   // and the two derivations are not the same arithmetic
}

class ReferenceMachine : public testing::TestWithParam<std::string> {};

TEST_P(ReferenceMachine, CompilesWithAllErrorsAndKeepsItsBound) {
  constexpr unsigned kSeed = 41;
  const TestMachine test(disturbed(read_machine(diagnose_test::machine_path(GetParam())), kSeed));
  const Agreement seen = compare(test, 4, 2000, kSeed);
  const double bound = largest_bound_um(test.compiled);
  std::printf(
      "%s: seed %u, %zu poses of 8000, %zu operations: deviation up to %.1f um, %.6f um seen, %.6f um "
      "proved\n",
      GetParam().c_str(), kSeed, seen.poses, test.compiled.program.instructions.size(), seen.largest_um,
      seen.worst_um, bound);
  EXPECT_LE(seen.worst_share, 1.0);
  // What the bound leaves out (the second order of a least-squares correction) is no larger than the rest.
  EXPECT_LE(seen.whole_um, 2 * bound);
  EXPECT_GT(seen.largest_um, 5.0);
  EXPECT_GT(seen.poses, 4000u);
  // A bound far beyond what is ever seen is of no use. The second order is that of the steepest slopes of all
  // tables at the largest corrections at once; looser: four rotations with tables of their own.
  const bool loose = GetParam() == "fibre_placement";
  EXPECT_LE(bound, (loose ? 100 : 12) * seen.worst_um);
}

/// Machines without tables, whose nodes can be sampled.
class OmittedParts : public testing::TestWithParam<std::string> {};

TEST_P(OmittedParts, AreWhatTheErrorEquationLacks) {
  // 10 um leaves out many terms; against 5 pm nothing is left out that counts.
  constexpr double kCoarse_mm = 1e-2, kFine_mm = 5e-9;
  const Machine machine = disturbed(read_machine(diagnose_test::machine_path(GetParam())), 41);
  Derivation coarse = derive(machine, kCoarse_mm, 1);
  const Derivation fine = derive(machine, kFine_mm, 1);
  NodeVector whole = coarse.deviation;
  double slack_mm = 1e-7;  // what the fine equation omits, and its own rounding
  for (const Neglected& n : coarse.neglected) {
    const NodeVector part = omitted_part(coarse.graph, n);
    for (std::size_t c = 0; c < 3; ++c) whole[c] = coarse.graph.add(whole[c], part[c]);
    slack_mm += n.slack_mm;
  }
  Samples at_coarse(coarse.graph, kSamples), at_fine(fine.graph, kSamples);
  double left = 0, before = 0;
  for (std::size_t c = 0; c < 3; ++c) {
    const Eigen::ArrayXd exact = at_fine.of(fine.deviation[c]);
    before = std::max(before, (at_coarse.of(coarse.deviation[c]) - exact).abs().maxCoeff());
    left = std::max(left, (at_coarse.of(whole[c]) - exact).abs().maxCoeff());
  }
  std::printf("%s: %zu parts, %.3g mm omitted, %.3g mm without them, at most %.3g mm\n", GetParam().c_str(),
              coarse.neglected.size(), before, left, slack_mm);
  EXPECT_LE(left, slack_mm);
  EXPECT_GT(before, 10 * slack_mm);  // and there is something to omit
}

INSTANTIATE_TEST_SUITE_P(Machines, OmittedParts,
                         testing::Values("five_axis_bhead_ctable", "fibre_placement_dh", "ur10e"),
                         [](const auto& test) { return test.param; });

TEST(TableRange, HoldsTheStationsOfEverySegmentInTheInterval) {
  Table table;
  for (const double value : {1.0, 5.0, -2.0, 3.0}) {
    Station station;
    station.loc = 10 * static_cast<double>(table.stations.size());
    station.value[2] = value;
    table.stations.push_back(station);
  }
  const Interval whole{-2, 5};
  const auto range = [&](double low, double high) { return table_range(table, 2, {low, high}, whole); };
  const auto expect = [](const Interval& seen, double low, double high) {
    EXPECT_EQ(seen.low, low);
    EXPECT_EQ(seen.high, high);
  };
  expect(range(1, 9), 1, 5);     // one segment
  expect(range(9, 11), -2, 5);   // on both sides of a station
  expect(range(21, 29), -2, 3);  // the last segment
  expect(range(-5, -1), 1, 1);   // before the first station its value is held
  expect(range(-5, 5), 1, 5);    // from before the first station
  expect(range(30, 40), 3, 3);   // from the last station on
  expect(range(25, 40), -2, 3);  // beyond the last station
  expect(range(0, 0), 1, 5);     // on a station: the segment after it
  table.periodic = true;
  expect(range(1, 9), -2, 5);
  table.periodic = false;
  table.interpolation = Interpolation::kCubic;
  expect(range(1, 9), -2, 5);
}

INSTANTIATE_TEST_SUITE_P(Machines, ReferenceMachine, testing::ValuesIn(diagnose_test::reference_machines()),
                         [](const auto& test) { return test.param; });

INSTANTIATE_TEST_SUITE_P(Machines, ErrorBound, testing::Values("bridge", "five_axis", "planar"));

}  // namespace
}  // namespace vernier::bound_test
