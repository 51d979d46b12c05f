// SPDX-License-Identifier: GPL-3.0-or-later
// The shares of the effects: named in the image, computed beside the tick, together the correction.
#include <gtest/gtest.h>

#include <map>

#include "tests/unit/compile/agreement.h"
#include "tests/unit/effects/candidates.h"
#include "tools/model/machine_reader.h"

namespace vernier::shares_test {

using namespace vernier::model;
namespace {

constexpr unsigned kSeed = 5;

/// Largest |sum of the shares - correction| over random poses, um at the tool point, of the axis it is worst
/// on.
double worst_sum_um(const TestMachine& test, std::size_t poses, double& largest_um) {
  const ShareProgram& shares = test.loaded->view.shares();
  const Program& program = test.loaded->view.program();
  std::mt19937_64 random(kSeed);
  Compensator compensator(program);
  std::vector<Correction> each(shares.shares.size);
  double worst = 0;
  for (const CycleInput& input : test.random_poses(poses, random)) {
    compensator.step(input);
    shares_of(compensator, shares, program, each.data());
    for (std::uint32_t k = 0; k < program.outputs.size; ++k) {
      double sum = 0;
      for (std::uint32_t i = 0; i < shares.shares.size; ++i)
        if (shares.shares[i].axis == program.outputs[k].axis) sum += each[i].counts;
      const double correction = -test.deviation_units(compensator, k);
      const auto& least = test.compiled.least_squares;
      const double um = 1000 * (least ? least->lever[k] : 1);  // at the tool point
      worst = std::max(worst, um * std::abs(sum * test.axis_unit(program.outputs[k].axis) - correction));
      largest_um = std::max(largest_um, um * std::abs(correction));
    }
  }
  return worst;
}

class Shares : public testing::TestWithParam<std::string> {};

TEST_P(Shares, SumToTheCorrection) {
  const TestMachine test(disturbed(read_machine(diagnose_test::machine_path(GetParam())), kSeed));
  const ShareProgram& shares = test.loaded->view.shares();
  double largest = 0;
  const double worst = worst_sum_um(test, 2000, largest);
  std::printf(
      "%s: %u shares, %zu left out, %u operations beside %u of the tick, sum within %.4f um of %.1f um\n",
      GetParam().c_str(), shares.shares.size, test.compiled.shares.left_out,
      shares.equation.instructions.size, test.loaded->view.program().equation.instructions.size, worst,
      largest);
  EXPECT_GT(shares.shares.size, 1u);
  if (test.compiled.shares.left_out > 0) GTEST_SKIP() << "the image has no room for all of them";
  // Each share is rounded to a count, and to its own format; where least squares are solved, its weights too.
  EXPECT_GT(largest, 5.0);
  EXPECT_LE(worst, (test.compiled.least_squares ? 0.02 : 0.002) * shares.shares.size);
}

INSTANTIATE_TEST_SUITE_P(Machines, Shares, testing::ValuesIn(diagnose_test::reference_machines()),
                         [](const auto& test) { return test.param; });

TEST(Share, IsThatOfItsEffectAlone) {
  // The bridge with all its effects against the bridge with one of them alone: what is left of the
  // correction.
  const Machine all = read_machine(machine_path("bridge"));
  Machine alone = all;
  for (Static& s : alone.statics)
    if (s.nominal && s.name != "BX" && s.name != "tauWarm") s.value = *s.nominal;
  alone.tables.clear();
  for (Axis& axis : alone.axes) axis.scale_factor = 0;
  const TestMachine both(all), one(alone);
  const auto named = [](const ImageView& view, const std::string& name) {
    std::map<std::uint32_t, std::uint32_t> of_axis;
    for (std::uint32_t i = 0; i < view.share_names().size; ++i)
      if (view.share_names()[i].text == name) of_axis[view.shares().shares[i].axis] = i;
    return of_axis;
  };
  const auto backlash = named(both.loaded->view, "X of transform 2 (tool): BX*dirX");
  ASSERT_EQ(backlash.count(0), 1u);
  std::mt19937_64 random(kSeed);
  Compensator with_all(both.loaded->view.program()), with_one(one.loaded->view.program());
  std::vector<Correction> each(both.loaded->view.shares().shares.size);
  for (const CycleInput& input : both.random_poses(500, random)) {
    with_all.step(input);
    with_one.step(input);
    shares_of(with_all, both.loaded->view.shares(), both.loaded->view.program(), each.data());
    EXPECT_NEAR(each[backlash.at(0)].counts, -1e6 * one.deviation_units(with_one, 0),
                20.0);  // nm: second order
    EXPECT_EQ(std::abs(each[backlash.at(0)].counts) > 1000, input.axis[0].sense != 0);
  }
}

}  // namespace
}  // namespace vernier::shares_test
