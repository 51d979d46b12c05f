// SPDX-License-Identifier: GPL-3.0-or-later
// Every form of every effect of the catalogue, written into machines at places of every rule, compiles and
// keeps its proved bound.
#include <gtest/gtest.h>

#include "tests/unit/compile/agreement.h"
#include "tests/unit/effects/candidates.h"
#include "tools/effects/add.h"
#include "tools/model/machine_reader.h"

namespace vernier::effects_test {

using namespace vernier::effects;
using namespace vernier::model;
using namespace vernier::text;
namespace {

constexpr unsigned kSeed = 20260701;

/// Sizes the effect: its linear unknowns so that the deviation changes by 30 um at most.
void size_effect(Machine& machine, const Candidate& candidate) {
  std::mt19937_64 random(kSeed);
  const Machine without = machine;
  const auto set = [&](double scale) {
    double sign = 1;
    for (const CandidateUnknown& unknown : candidate.unknowns)
      if (unknown.kind == UnknownKind::kLinear) {
        machine.statics[*machine.find_static(unknown.name)].value = sign * scale;
        sign *= -0.7;
      }
  };
  const TestMachine poses = TestMachine::poses_of(machine);
  const States states = poses.states_of(poses.random_poses(200, random));
  constexpr double kTry = 1e-9;
  set(kTry);
  const double size =
      (forward(machine, states).position - forward(without, states).position).cwiseAbs().maxCoeff();
  set(size > 1e-15 ? 0.03 / size * kTry : 1e-3);
}

class EffectsCompile : public testing::TestWithParam<std::string> {};

TEST_P(EffectsCompile, AllOfThemWithinTheirBound) {
  const std::string text = read_file(diagnose_test::machine_path(GetParam()));
  const Machine machine = parse_machine(text, GetParam());
  std::map<std::string, int> refused;
  std::size_t compiled = 0;
  double worst_share = 0;
  for (const Choice& choice : diagnose_test::all_choices(machine, 2)) {
    const Candidate candidate = make_candidate(machine, choice);
    SCOPED_TRACE(candidate.label + ", form " + choice.form->label);
    Machine added = parse_machine(add_to_machine_text(text, machine, candidate), "added.xml");
    size_effect(added, candidate);
    try {
      const TestMachine test(added);
      const Agreement seen = compare(test, 1, 200, kSeed);
      worst_share = std::max(worst_share, seen.worst_share);
      EXPECT_LE(seen.worst_share, 1.0) << seen.worst_um << " um seen, " << largest_bound_um(test.compiled);
      ++compiled;
    } catch (const InputError& error) {
      ++refused[choice.effect->id + ", form " + choice.form->label + ": " + error.what()];
    }
  }
  std::printf("%s: %zu effects compiled, largest share of the bound %.2f\n", GetParam().c_str(), compiled,
              worst_share);
  for (const auto& [reason, count] : refused) std::printf("  refused %d times: %s\n", count, reason.c_str());
  EXPECT_GT(compiled, 100u);
  EXPECT_TRUE(refused.empty());
}

INSTANTIATE_TEST_SUITE_P(Machines, EffectsCompile,
                         testing::Values("gantry", "five_axis_bhead_ctable", "ur10e"),
                         [](const auto& test) { return test.param; });

}  // namespace
}  // namespace vernier::effects_test
