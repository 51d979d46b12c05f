// SPDX-License-Identifier: GPL-3.0-or-later
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <regex>

#include "tests/unit/plan/confusable.h"
#include "tools/format/columns.h"
#include "tools/format/csv_file.h"
#include "tools/model/machine_reader.h"
#include "tools/plan/sheets.h"

namespace vernier::plan_test {

using namespace vernier::effects;
using namespace vernier::model;
using namespace vernier::plan;
namespace {

Plan plan_of_lag() {
  const Machine machine = parse_machine(model_text(), "model.xml");
  const Confusable pair = confusable_pairs()[0];
  const Measurement old = survey(pair, 0, machine, 5);
  return plan_next(model_text(), machine, old, pair.adds[0], pair.adds[1], built_in_effects());
}

TEST(PlanCsv, ReadsBackAsTheSameRowsOnceReadingsAreIn) {
  const Plan plan = plan_of_lag();
  // Readings of 0 where the person would write his own.
  const std::string csv = std::regex_replace(plan_csv(plan), std::regex(",,,,"), ",0,0,0,");
  const Measurement back = parse_measurement(csv, "plan.csv", plan.machine);
  ASSERT_EQ(back.rows(), plan.rows.rows());
  EXPECT_EQ(back.observations.size(), plan.rows.observations.size());
  for (std::size_t a = 0; a < 3; ++a) {
    // Nine digits are written.
    EXPECT_TRUE(back.states.axis[a].isApprox(plan.rows.states.axis[a], 1e-8));
    EXPECT_TRUE((back.states.direction[a] == plan.rows.states.direction[a]).all());
    EXPECT_TRUE(back.states.velocity[a].isApprox(plan.rows.states.velocity[a], 1e-8));
  }
}

/// The plan with readings of one form in place of its own, in all rows that can have them.
Plan with_readings(Plan plan, format::ReadingForm form) {
  Measurement& rows = plan.rows;
  const auto count = static_cast<Eigen::Index>(rows.rows());
  rows.observations.clear();
  rows.states.normal[2].setOnes();
  rows.direction = Eigen::Matrix3Xd::Constant(3, count, std::nan(""));
  rows.other_end.assign(rows.rows(), 0);
  rows.other_end[0] = kNoRow;
  for (std::size_t row = 0; row < rows.rows(); ++row)
    for (const format::ReadingKindEntry& kind : format::kReadingKinds)
      if (kind.form == form && (form != format::ReadingForm::kDistance || row > 0))
        rows.observations.push_back({kind.kind, row, 0});
  return plan;
}

/// The sheet as it comes back: a reading of 0 (along z for a direction) where all that it needs is given.
std::string filled(const std::string& sheet, format::ReadingForm form) {
  format::CsvFile csv = format::parse_csv(sheet, "plan.csv");
  std::string text;
  for (const format::CsvColumn& column : csv.columns)
    text += (text.empty() ? "" : ",") + format::heading(column.name, column.unit);
  const auto column_of = [&](std::string_view name) {
    return static_cast<std::size_t>(
        std::find_if(csv.columns.begin(), csv.columns.end(), [&](const auto& c) { return c.name == name; }) -
        csv.columns.begin());
  };
  for (auto& row : csv.rows) {
    bool complete = true;
    for (const format::ColumnGroup* const group : format::columns_beside(form))
      for (const char* const name : group->list()) complete = complete && !row[column_of(name)].empty();
    const auto names = format::reading_columns(form).list();
    for (std::size_t k = 0; k < names.size() && complete; ++k)
      row[column_of(names[k])] = format::entry_of(form).together && k == 2 ? "1" : "0";
    text += "\n";
    for (std::size_t k = 0; k < row.size(); ++k) text += (k > 0 ? "," : "") + row[k];
  }
  return text + "\n";
}

// Every form of reading in the table of tools/format: what a plan asks for, fit reads.
TEST(PlanCsv, OfEveryFormOfReadingReadsBack) {
  const Plan lag = plan_of_lag();
  for (const format::ReadingFormEntry& form : format::kReadingForms) {
    SCOPED_TRACE(form.meaning);
    Plan plan = with_readings(lag, form.form);
    if (form.form == format::ReadingForm::kOn) plan.machine.artefacts.emplace_back().name = "0";
    const Measurement back = parse_measurement(filled(plan_csv(plan), form.form), "plan.csv", plan.machine);
    ASSERT_EQ(back.observations.size(), plan.rows.observations.size());
    for (std::size_t i = 0; i < back.observations.size(); ++i) {
      EXPECT_EQ(back.observations[i].kind, plan.rows.observations[i].kind);
      EXPECT_EQ(back.observations[i].row, plan.rows.observations[i].row);
    }
    EXPECT_TRUE(back.candidates.empty()) << back.candidates.front().name;
  }
}

TEST(PlanGcode, ApproachesEveryPointFromTheSideOfItsSense) {
  const Plan plan = plan_of_lag();
  const std::string text = plan_gcode(plan);
  const std::regex move(R"(G1 X(\S+) Y(\S+) Z(\S+) F(\S+)( ; point (\d+))?.*)");
  std::array<double, 3> before{};
  std::size_t seen = 0;
  for (std::sregex_iterator it(text.begin(), text.end(), move), end; it != end; ++it) {
    const std::array<double, 3> now = {std::stod((*it)[1]), std::stod((*it)[2]), std::stod((*it)[3])};
    // Inside the declared ranges.
    EXPECT_TRUE(now[0] >= 0 && now[0] <= 600 && now[1] >= 0 && now[1] <= 400 && now[2] >= -300 &&
                now[2] <= 0);
    if ((*it)[6].matched) {
      const auto row = static_cast<Eigen::Index>(std::stoul((*it)[6]) - 1);
      const double sense = plan.rows.states.direction[0][row];
      EXPECT_GT((now[0] - before[0]) * sense, 0) << it->str();
      EXPECT_NEAR(std::stod((*it)[4]), plan.rows.states.feed[row], 1e-6);
      ++seen;
    }
    before = now;
  }
  EXPECT_EQ(seen, plan.rows.rows());
}

TEST(PlanNextOne, SaysSoWhereOnlyADecoyWouldSeparate) {
  // GIVEN a logged column that nobody can set, constant beside a scale error's column
  const Machine machine = parse_machine(model_text(), "model.xml");
  Confusable pair = confusable_pairs()[1];
  pair.header = "X[mm],Y[mm],Z[mm],dirX,t[s],V_supply[V]";
  pair.adds[1] = "custom:axis=X,input=V_supply,branch=tool,transform=2,dof=X,unit=V,term=k*X*V_supply";
  const Measurement old = survey(pair, 0, machine, 11);
  // WHEN the two are to be separated
  const Plan plan = plan_next(model_text(), machine, old, pair.adds[0], pair.adds[1], built_in_effects());
  // THEN no row does, and the column is named
  EXPECT_FALSE(plan.separable);
  EXPECT_NE(plan.sentence.find("cannot be separated by"), std::string::npos) << plan.sentence;
  EXPECT_NE(plan.sentence.find("V_supply is logged"), std::string::npos) << plan.sentence;
}

TEST(PlanNextOne, ProposesNothingWhereTheRowsTellAlready) {
  // GIVEN two effects that one and the same survey shows quite differently
  const Machine machine = parse_machine(model_text(), "model.xml");
  const Measurement old = survey(confusable_pairs()[0], 0, machine, 13);
  const Plan plan = plan_next(model_text(), machine, old, "backlash", "scale-error", built_in_effects());
  // THEN there is nothing to measure, and the sheets are empty but sound
  EXPECT_TRUE(plan.told_already) << plan.sentence;
  EXPECT_EQ(plan.rows.rows(), 0U);
  EXPECT_EQ(plan_gcode(plan).find("G1"), std::string::npos);
  EXPECT_NE(plan_csv(plan).find("X[mm],Y[mm],Z[mm]"), std::string::npos);
}

TEST(PlanNextOne, TakesTheWishedNumberOfPoints) {
  const Machine machine = parse_machine(model_text(), "model.xml");
  const Confusable pair = confusable_pairs()[0];
  const Measurement old = survey(pair, 1, machine, 12);
  PlanOptions options;
  options.points = 9;
  const Plan nine =
      plan_next(model_text(), machine, old, pair.adds[0], pair.adds[1], built_in_effects(), options);
  EXPECT_EQ(nine.rows.rows(), 9U);
  options.points = 3;
  const Plan three =
      plan_next(model_text(), machine, old, pair.adds[0], pair.adds[1], built_in_effects(), options);
  EXPECT_LT(three.worse().planned, nine.worse().planned);
}

}  // namespace
}  // namespace vernier::plan_test
