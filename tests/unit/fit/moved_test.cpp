// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/fit/coverage/moved.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <random>

#include "tools/fit/fit.h"
#include "tools/model/chain/prediction.h"
#include "tools/model/fit_record.h"
#include "tools/model/machine_reader.h"

namespace vernier::moved_test {

using namespace vernier::fit;
using namespace vernier::model;
namespace {

constexpr std::size_t kRows = 150, kMovedFrom = 80;
constexpr double kU_mm = 1e-3;

/// Three slides, a turning table and a swivelling head; location errors and tables free.
const char* const kFiveAxes = R"xml(<machine name="five"><variables>
  <static>
    <oC value="0" nominal="0" unit="mm" /><tB value="0" nominal="0" unit="deg" /><sq value="0" nominal="0" unit="rad" />
    <TX value="0" Hide="true" unit="mm" /><TZ value="-150" Hide="true" unit="mm" />
    <BaseShift X="0" Y="0" Z="0" rX="0" rY="0" rZ="0" />
  </static>
  <machineaxes>
    <X min="0" max="600" /><Y min="0" max="500" /><Z min="-400" max="0" />
    <B rotary="true" min="-90" max="90" /><C rotary="true" min="-180" max="180" />
  </machineaxes>
  <comptables>
    <table axis="X" fit="X Y Z rX rY rZ"><station loc="0" /><station loc="300" /><station loc="600" /></table>
    <table axis="B" fit="X Y Z"><station loc="-90" /><station loc="0" /><station loc="90" /></table>
  </comptables></variables>
  <transforms branch="tool">
    <sixdof n="1" X="X+lXx" Y="lXy" Z="lXz" rX="rXx" rY="rXy" rZ="rXz" />
    <sixdof n="2" X="-sq*Y" Y="Y" Z="Z" />
    <sixdof n="3" X="lBx" Y="lBy" Z="lBz" rX="tB" rY="B" />
    <sixdof n="4" X="TX" Z="TZ" />
  </transforms>
  <transforms branch="workpiece"><sixdof n="1" X="oC" rZ="C" /></transforms></machine>)xml";

/// The machine surveyed with small errors; from row kMovedFrom on with a tool longer by `tool_mm` and read
/// from a set-up shifted by `set_up_mm`.
FitResult surveyed(double tool_mm, double set_up_mm, bool with_u) {
  const Machine model = parse_machine(kFiveAxes, "five.xml");
  Machine truth = model;
  std::mt19937_64 random(5);
  std::normal_distribution<double> normal;
  std::uniform_real_distribution<double> place(0, 1);
  for (Static& item : truth.statics)
    if (!item.hidden) item.value = (item.unit == "rad" ? 2e-5 : 4e-3) * normal(random);
  for (Table& table : truth.tables)
    for (Station& station : table.stations)
      for (std::size_t c = 0; c < 6; ++c)
        if (table.free[c]) station.value[c] = (c < 3 ? 8e-3 : 1e-3) * normal(random);
  std::string csv =
      std::string("X[mm],Y[mm],Z[mm],B[deg],C[deg],x[mm],y[mm],z[mm]") + (with_u ? ",u[mm]\n" : "\n");
  for (std::size_t row = 0; row < kRows; ++row)
    csv += fmt::format("{},{},{},{},{},0,0,0{}\n", 600 * place(random), 500 * place(random),
                       -400 * place(random), 180 * place(random) - 90, 360 * place(random) - 180,
                       with_u ? fmt::format(",{}", kU_mm) : "");
  Measurement rows = parse_measurement(csv, "survey.csv", model);
  const Eigen::VectorXd before = predict(truth, rows);
  for (Static& item : truth.statics)
    if (item.name == "TZ") item.value -= tool_mm;
  const Eigen::VectorXd after = predict(truth, rows);
  for (std::size_t i = 0; i < rows.observations.size(); ++i) {
    Observation& o = rows.observations[i];
    const bool moved = o.row >= kMovedFrom;
    o.value = (moved ? after : before)[static_cast<Eigen::Index>(i)] + kU_mm * normal(random) +
              (moved && o.kind == ObservationKind::kY ? set_up_mm : 0);
  }
  return fit::fit(model, rows);
}

TEST(Moved, SoundSurveyHasNoMove) {
  for (const bool with_u : {true, false}) {
    const FitResult result = surveyed(0, 0, with_u);
    EXPECT_LT(result.machine.fitted->disturbed, 0.1) << result.machine.fitted->disturbance;
  }
}

// The longer tool turns with the head: no step in any reading, and most of what the nominal machine misses.
TEST(Moved, ToolChangedInTheMiddleIsSaidWithItsRow) {
  for (const bool with_u : {true, false}) {
    const FitResult result = surveyed(0.3, 0, with_u);
    EXPECT_GT(result.machine.fitted->disturbed, 2);
    // The header is line 1.
    EXPECT_EQ(result.machine.fitted->disturbance,
              fmt::format("the tool moved before survey.csv:{}", kMovedFrom + 2));
  }
}

TEST(Moved, SetUpShiftedInTheMiddleIsSaid) {
  const FitResult result = surveyed(0, 0.2, true);
  EXPECT_GT(result.machine.fitted->disturbed, 2);
  EXPECT_NE(result.machine.fitted->disturbance, "");
}

}  // namespace
}  // namespace vernier::moved_test
