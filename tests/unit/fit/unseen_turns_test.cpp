// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/fit/coverage/unseen_turns.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cmath>

#include "tools/fit/fit.h"
#include "tools/fit/selection.h"
#include "tools/fit/solve.h"
#include "tools/model/machine_reader.h"
#include "tools/model/measurement.h"

namespace vernier::unseen_turns_test {

using namespace vernier::fit;
using namespace vernier::model;
namespace {

const Machine& line_machine() {
  static const Machine machine = parse_machine(
      "<machine name=\"line\"><variables><static><k value=\"0\" nominal=\"0\" unit=\"mm/mm\"/>"
      "<BaseShift X=\"0\" Y=\"0\" Z=\"0\" rX=\"0\" rY=\"0\" rZ=\"0\"/></static>"
      "<machineaxes><X min=\"0\" max=\"1000\"/><Y min=\"0\" max=\"500\"/></machineaxes></variables>"
      "<transforms><sixdof n=\"1\" X=\"X+k*X\" Y=\"Y\"/></transforms></machine>",
      "line.xml");
  return machine;
}

/// An interferometer along X, or with y_step along lines that lie so far apart: 50 um/m, 3 mm off, a reading
/// is 1 um out.
Measurement rows(double y_step) {
  std::string csv = "X[mm],Y[mm],x[mm],u[um]\n";
  for (int line = 0; line < 3; ++line)
    for (int i = 0; i <= 10; ++i) {
      const double at = 97.0 * i;
      csv += fmt::format("{},{},{:.7f},1\n", at, 200 + line * y_step,
                         at * (1 + 50e-6) + 3 + 0.001 * std::sin(2.1 * i + line));
    }
  return parse_measurement(csv, "rows.csv", line_machine());
}

std::vector<bool> unseen(const Measurement& m) {
  const ParameterSet parameters(line_machine(), setups_of_fit_rows(m));
  std::vector<bool> turns;
  const std::vector<bool> all = unseen_turns(line_machine(), m, parameters, 500);
  for (std::size_t i = 0; i < parameters.size(); ++i)
    if (parameters[i].kind == ParameterKind::kBaseShift && parameters[i].column >= 3) turns.push_back(all[i]);
  return turns;
}

TEST(UnseenTurns, OneLineSeesNoneAndSeveralSeeTheirOwn) {
  EXPECT_EQ(unseen(rows(0)), (std::vector<bool>{true, true, true}));
  EXPECT_EQ(unseen(rows(100)), (std::vector<bool>{true, true, false}));
}

TEST(UnseenTurns, AScaleIsNotTakenForACosineError) {
  const FitResult result = vernier::fit::fit(line_machine(), rows(0));
  EXPECT_TRUE(result.converged);
  EXPECT_LT(result.iterations, 30);
  for (const ParameterEstimate& one : result.estimates) {
    if (one.name == "k") {
      EXPECT_NEAR(one.value, 50e-6, 4 * one.std + 1e-9);
    }
    // A turn by 0.6 deg would be a scale of -50 um/m: what stands here is none.
    if (one.name.starts_with("BaseShift.r")) {
      EXPECT_LT(std::abs(one.value), 1e-3) << one.name;
    }
  }
  EXPECT_LT(*result.after.rms_um, 1.0);
}

}  // namespace
}  // namespace vernier::unseen_turns_test
