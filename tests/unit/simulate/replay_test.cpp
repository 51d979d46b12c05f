// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/simulate/replay.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <random>

#include "tools/model/chain/prediction.h"
#include "tools/model/machine_reader.h"
#include "tools/text/error.h"

namespace vernier::replay_test {

using namespace vernier::compile;
using namespace vernier::model;
using namespace vernier::simulate;
using namespace vernier::text;
namespace {

/// 0.1 mm/m of scale and, where asked for, growth with a temperature that lags.
std::string machine_text(const std::string& more) {
  return fmt::format(
      R"xml(<machine><variables><static><k value="1e-4" nominal="0"/><c value="0.01" nominal="0"/></static>
  <machineaxes><X min="0" max="600"/><Y min="0" max="400"/></machineaxes>
  <inputs><T unit="degC" reference="20" min="10" max="40"/></inputs></variables>
  <transforms><sixdof n="1" X="X+k*X{}" Y="Y"/></transforms></machine>)xml",
      more);
}

/// Readings of the machine itself, with times `step` seconds apart where step is above 0.
Measurement readings(const std::string& text, double step_s) {
  const Machine machine = parse_machine(text, "m.xml");
  std::mt19937_64 random(5);
  std::uniform_real_distribution<double> share(0, 1);
  std::string csv = step_s > 0 ? "X[mm],Y[mm],T[degC],x[mm],t[s]\n" : "X[mm],Y[mm],T[degC],x[mm]\n";
  for (int i = 0; i < 30; ++i) {
    csv += fmt::format("{:.4f},{:.4f},{:.3f},0", 600 * share(random), 400 * share(random), 20 + i * 0.1);
    csv += step_s > 0 ? fmt::format(",{}\n", i * step_s) : "\n";
  }
  Measurement m = parse_measurement(csv, "rows.csv", machine);
  const Eigen::VectorXd read = predict(machine, m);
  for (std::size_t i = 0; i < m.observations.size(); ++i)
    m.observations[i].value = read[static_cast<Eigen::Index>(i)];
  return m;
}

ReplayResult replayed(const std::string& text, double step_s) {
  const Machine machine = parse_machine(text, "m.xml");
  const auto image = load_image(compile_machine(machine, text, {}).image, machine);
  return replay(*image, readings(text, step_s), {});
}

TEST(Replay, RowsWithoutTimeAreStoodAt) {
  const ReplayResult still = replayed(machine_text(""), 0), timed = replayed(machine_text(""), 2);
  EXPECT_GT(still.before.norm(), 0.1);
  EXPECT_LT(still.after.cwiseAbs().maxCoeff(), 2e-6);
  EXPECT_LT((still.after - timed.after).cwiseAbs().maxCoeff(), 2e-6);
  EXPECT_EQ(still.not_active, 0U);
  EXPECT_EQ(timed.ticks, 29U * 2000 + 1);
}

TEST(Replay, NeedsTimeWhereATermGoesWithIt) {
  EXPECT_THROW(replayed(machine_text("+c*lag(T-20,300)"), 0), InputError);
  // A tick of a thousand seconds' record is made when it is asked for.
  EXPECT_LT(replayed(machine_text("+c*lag(T-20,300)"), 30).after.cwiseAbs().maxCoeff(), 1e-4);
}

TEST(Replay, AFileWithoutTimesIsStoodAtBesideAFileWithTimes) {
  const std::string text = machine_text("");
  const Machine machine = parse_machine(text, "m.xml");
  const auto image = load_image(compile_machine(machine, text, {}).image, machine);
  for (const bool timed_first : {true, false}) {
    Measurement both = readings(text, timed_first ? 2 : 0);
    append_measurement(both, readings(text, timed_first ? 0 : 2));
    const ReplayResult result = replay(*image, both, {});
    EXPECT_EQ(result.ticks, 29U * 2000 + 1 + 30);
    EXPECT_LT(result.after.cwiseAbs().maxCoeff(), 2e-6);
  }
  const std::string lagging = machine_text("+c*lag(T-20,300)");
  Measurement both = readings(lagging, 2);
  append_measurement(both, readings(lagging, 0));
  const Machine slow = parse_machine(lagging, "m.xml");
  const auto slow_image = load_image(compile_machine(slow, lagging, {}).image, slow);
  EXPECT_THROW(replay(*slow_image, both, {}), InputError);
}

TEST(Replay, NeedsATimeThatGrows) {
  const std::string text = machine_text("");
  const Machine machine = parse_machine(text, "m.xml");
  const auto image = load_image(compile_machine(machine, text, {}).image, machine);
  Measurement m = readings(text, 1);
  m.states.time[7] = m.states.time[6];
  EXPECT_THROW(replay(*image, m, {}), InputError);
}

}  // namespace
}  // namespace vernier::replay_test
