#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <random>

#include "tests/unit/compile/poses.h"

namespace vernier {
namespace {

struct Agreement {
  double worst_um = 0;     // |fixed point - double chain|
  double worst_share = 0;  // of the bound
  double largest_um = 0;   // deviation itself, so that agreement on zero counts for nothing
};

/// Deviation of the double chain seen along the corrected axes.
Eigen::MatrixXd exact_deviation(const Machine& machine, const States& states,
                                const std::vector<std::size_t>& axes) {
  // Nominal directions of the axes by differences: a derivation that shares nothing with the compiler's.
  const Eigen::Matrix3Xd deviation_mm = deviation(machine, states);
  const Machine nominal = nominal_machine(machine);
  const Eigen::Matrix3Xd here = forward(nominal, states).position;
  std::vector<Eigen::Matrix3Xd> moved;
  for (const std::size_t axis : axes) {
    States ahead = states;
    ahead.axis[axis] += 1.0;
    moved.push_back(forward(nominal, ahead).position - here);
  }
  Eigen::MatrixXd result(static_cast<Eigen::Index>(axes.size()), deviation_mm.cols());
  for (Eigen::Index i = 0; i < deviation_mm.cols(); ++i) {
    Eigen::MatrixXd directions(3, static_cast<Eigen::Index>(axes.size()));
    for (std::size_t k = 0; k < axes.size(); ++k)
      directions.col(static_cast<Eigen::Index>(k)) = moved[k].col(i);
    result.col(i) = directions.completeOrthogonalDecomposition().solve(deviation_mm.col(i));
  }
  return result;
}

Agreement compare(const std::string& name, std::size_t batches, std::size_t batch, unsigned seed) {
  const TestMachine test(name);
  std::vector<std::size_t> axes;
  for (const Output& out : test.compiled.program.outputs) axes.push_back(out.axis);
  Agreement worst;
  std::mt19937_64 random(seed);
  for (std::size_t b = 0; b < batches; ++b) {
    const std::vector<CycleInput> inputs = test.random_poses(batch, random);
    const Eigen::MatrixXd exact = exact_deviation(test.machine, test.states_of(inputs), axes);
    Compensator compensator(test.loaded->view.program());
    for (std::size_t i = 0; i < inputs.size(); ++i) {
      compensator.step(inputs[i]);
      for (std::size_t k = 0; k < axes.size(); ++k) {
        const double expected = exact(static_cast<Eigen::Index>(k), static_cast<Eigen::Index>(i)) * 1000;
        const double error = std::abs(test.deviation_um(compensator, k) - expected);
        worst.worst_um = std::max(worst.worst_um, error);
        worst.worst_share = std::max(worst.worst_share, error / test.compiled.bounds[k].total_um);
        worst.largest_um = std::max(worst.largest_um, std::abs(expected));
      }
    }
  }
  return worst;
}

class ErrorBound : public testing::TestWithParam<const char*> {};

TEST_P(ErrorBound, HoldsAgainstTheDoubleChainOverRandomPoses) {
  constexpr unsigned kSeed = 20260701;
  const std::size_t poses = pose_count();
  const Agreement seen =
      compare(GetParam(), (poses + 9999) / 10000, std::min<std::size_t>(poses, 10000), kSeed);
  double bound = 0;
  for (const OutputBound& b : TestMachine(GetParam()).compiled.bounds) bound = std::max(bound, b.total_um);
  std::printf(
      "%s: seed %u, %zu poses: deviation up to %.2f um, |fixed - double| <= %.6f um seen, %.6f um proved, "
      "share %.3f\n",
      GetParam(), kSeed, poses, seen.largest_um, seen.worst_um, bound, seen.worst_share);
  EXPECT_LE(seen.worst_share, 1.0);
  EXPECT_GT(seen.largest_um, 5.0);  // there is something to correct
  EXPECT_GT(seen.worst_um, 1e-7);   // and the two derivations are not the same arithmetic
}

INSTANTIATE_TEST_SUITE_P(Machines, ErrorBound, testing::Values("bridge", "five_axis", "planar"));

}  // namespace
}  // namespace vernier
