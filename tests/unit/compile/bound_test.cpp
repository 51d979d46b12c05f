// SPDX-License-Identifier: GPL-3.0-or-later
#include <gtest/gtest.h>

#include "tests/unit/compile/agreement.h"
#include "tests/unit/effects/candidates.h"
#include "tools/model/machine_reader.h"

namespace vernier::bound_test {

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
  EXPECT_GT(seen.largest_um, 5.0);
  EXPECT_GT(seen.poses, 4000u);
  // A bound far beyond what is ever seen is of no use. The second order is that of the steepest slopes of all
  // tables at the largest corrections at once; looser: the sum of 53 neglected terms, and least squares.
  const bool loose = GetParam() == "fibre_placement" || GetParam() == "ur10e";
  EXPECT_LE(bound, (loose ? 100 : 12) * seen.worst_um);
}

INSTANTIATE_TEST_SUITE_P(Machines, ReferenceMachine, testing::ValuesIn(diagnose_test::reference_machines()),
                         [](const auto& test) { return test.param; });

INSTANTIATE_TEST_SUITE_P(Machines, ErrorBound, testing::Values("bridge", "five_axis", "planar"));

}  // namespace
}  // namespace vernier::bound_test
