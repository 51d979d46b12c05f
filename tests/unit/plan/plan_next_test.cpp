// SPDX-License-Identifier: GPL-3.0-or-later
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cstdlib>
#include <iostream>

#include "tests/unit/plan/confusable.h"
#include "tools/diagnose/diagnosis.h"
#include "tools/diagnose/sentences.h"
#include "tools/model/machine_reader.h"
#include "tools/plan/offers.h"

namespace vernier::plan_test {

using namespace vernier::diagnose;
using namespace vernier::effects;
using namespace vernier::model;
using namespace vernier::plan;
namespace {

constexpr std::uint64_t kSeed = 7001;

/// Surveys per pair and truth, if a table of rates is wanted: then random rows are judged beside the planned
/// ones.
const char* wanted_surveys() { return std::getenv("VERNIER_PLAN_SURVEYS"); }
int surveys() { return wanted_surveys() != nullptr ? std::max(1, std::atoi(wanted_surveys())) : 1; }

/// Does a diagnosis of old and new rows give the right name with confidence?
bool named(const Machine& machine, const Measurement& old, const Measurement& next,
           const std::string& effect) {
  const DiagnoseOptions options;  // holds the effects that the candidates point to
  const Diagnosis d = diagnose::diagnose(model_text(), machine, append_rows(old, next), options);
  const bool right =
      d.verdict == Verdict::kMissingEffect && d.candidates.front().candidate.choice.effect->id == effect;
  if (!right) {
    std::cout << "    " << verdict_name(d.verdict);
    for (std::size_t i = 0; i < d.candidates.size() && i < 3; ++i)
      std::cout << (i == 0 ? ": " : ", ") << d.candidates[i].add << " " << d.candidates[i].score;
    if (d.runner_up)
      std::cout << "; runner-up " << d.candidates[*d.runner_up].add << " " << d.runner_up_distance;
    std::cout << "\n";
  }
  return right;
}

class PlanNext : public testing::TestWithParam<int> {};

TEST_P(PlanNext, RowsLetADiagnosisNameTheRightOneOfTwo) {
  const Confusable pair = confusable_pairs()[static_cast<std::size_t>(GetParam())];
  const Machine machine = parse_machine(model_text(), "model.xml");
  int right = 0, by_chance = 0, all = 0, points = 0;
  for (int survey_number = 0; survey_number < surveys(); ++survey_number)
    for (int truth = 0; truth < 2; ++truth) {
      // GIVEN a survey that cannot tell the two
      const std::uint64_t seed = kSeed + 10 * static_cast<std::uint64_t>(survey_number);
      const Measurement old = survey(pair, truth, machine, seed);
      // WHEN the next rows are planned and measured on the true machine
      const Plan plan = plan_next(model_text(), machine, old, pair.by_id ? pair.effects[0] : pair.adds[0],
                                  pair.by_id ? pair.effects[1] : pair.adds[1], built_in_effects());
      std::cout << "seed " << seed << ", true: " << pair.effects[truth] << ". " << plan.sentence << "\n"
                << fmt::format("  non-centrality {:.3g} -> {:.3g}, needed {:.3g}\n", plan.worse().now,
                               plan.worse().planned, plan.worse().needed);
      ASSERT_FALSE(plan.told_already);
      ASSERT_TRUE(plan.separable);
      Measurement next = plan.rows;
      read(next, machine, pair, truth, seed + 1);
      Measurement drawn = random_rows(plan, old, seed + 2);
      read(drawn, machine, pair, truth, seed + 3);
      // THEN a diagnosis of all rows names it
      right += named(machine, old, next, pair.effects[truth]) ? 1 : 0;
      if (wanted_surveys() != nullptr) by_chance += named(machine, old, drawn, pair.effects[truth]) ? 1 : 0;
      points += static_cast<int>(plan.rows.rows());
      ++all;
    }
  std::cout << fmt::format("{}: planned {}/{}, random rows {}, {:.1f} points\n", pair.name, right, all,
                           wanted_surveys() != nullptr ? fmt::format("{}/{}", by_chance, all) : "not judged",
                           points / static_cast<double>(all));
  EXPECT_GE(right, 0.95 * all);
}

INSTANTIATE_TEST_SUITE_P(Pairs, PlanNext, testing::Range(0, 4));

}  // namespace
}  // namespace vernier::plan_test
