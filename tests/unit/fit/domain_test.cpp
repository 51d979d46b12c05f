// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/fit/coverage/domain.h"

#include <gtest/gtest.h>

#include "tools/fit/fit.h"
#include "tools/model/chain/chain.h"
#include "tools/model/machine_reader.h"
#include "tools/model/machine_writer.h"

namespace vernier::domain_test {

using namespace vernier::fit;
using namespace vernier::model;
namespace {

/// A learned term k*RMS in its domain over RMS and T, with the statics that `add` writes.
std::string machine_text() {
  std::string statics;
  for (const DomainStatic& item : open_domain("domain1", {{"a_RMS", "g"}, {"T", "degC"}}))
    statics += "<" + item.name + " value=\"" + std::to_string(item.value) + "\" Hide=\"true\"/>\n";
  return "<machine name=\"m\"><variables><static>\n<k value=\"0\" nominal=\"0\"/>\n" + statics +
         "</static><machineaxes><X min=\"0\" max=\"100\"/></machineaxes><inputs><a_RMS unit=\"g\" "
         "reference=\"0\"/>"
         "<T unit=\"degC\" reference=\"20\"/></inputs></variables><transforms><sixdof n=\"1\" X=\"X+" +
         domain_weight("domain1", {"a_RMS", "T"}) + "*(k*a_RMS)\"/></transforms></machine>";
}

constexpr const char* kTraining =
    "X[mm],a_RMS[g],T[degC],x[mm],role\n0,0.1,19,0.001,fit\n10,0.2,21,10.002,fit\n20,0.3,20,20.003,fit\n"
    "30,0.3,30,30.003,check\n";

TEST(Domain, IsClosedAroundTheRowsOfTheFitAlone) {
  const std::string text = machine_text();
  const Machine machine = parse_machine(text, "m.xml");
  const Measurement rows = parse_measurement(kTraining, "m.csv", machine);
  ASSERT_EQ(domain_ranges(machine).size(), 2u);
  EXPECT_TRUE(domain_ranges(machine)[0].open);
  const FitResult fitted = fit::fit(machine, rows);
  EXPECT_NEAR(fitted.estimates[0].value, 0.01, 1e-9);
  const std::string closed =
      close_domains(update_machine_text(text, fitted.machine, true), fitted.machine, rows);
  const Machine trained = parse_machine(closed, "m.xml");
  const auto ranges = domain_ranges(trained);
  EXPECT_EQ(ranges[0].quantity, "a_RMS");
  EXPECT_DOUBLE_EQ(ranges[0].low, 0.1);
  EXPECT_DOUBLE_EQ(ranges[0].high, 0.3);
  EXPECT_DOUBLE_EQ(ranges[1].low, 19);
  EXPECT_DOUBLE_EQ(ranges[1].high, 21);  // the check row of 30 degC is none of training
  EXPECT_DOUBLE_EQ(ranges[1].fade, 0.2);
  EXPECT_NEAR(*trained.inputs[0].max, 0.34, 1e-12);  // where a board holds the input, and the weight is 0
  EXPECT_NEAR(*trained.inputs[1].min, 18.6, 1e-12);
  EXPECT_EQ(close_domains(closed, trained, rows), closed);  // closed ones stay
}

TEST(Domain, FadesTheTermToNothingAndSaysWhere) {
  const std::string text = machine_text();
  const Machine machine = parse_machine(text, "m.xml");
  const Measurement training = parse_measurement(kTraining, "m.csv", machine);
  Machine fitted = fit::fit(machine, training).machine;
  const Machine trained =
      parse_machine(close_domains(update_machine_text(text, fitted, true), fitted, training), "m.xml");
  const Measurement use = parse_measurement(
      "X[mm],a_RMS[g],T[degC],x[mm]\n0,0.2,20,0\n0,0.2,21.1,0\n0,0.2,21.2,0\n0,0.2,40,0\n0,0.31,20,0\n0,-5,"
      "20,0\n",
      "m.csv", trained);
  const Eigen::Matrix3Xd d = deviation(trained, use.states);
  const double whole = 0.002;
  EXPECT_NEAR(d(0, 0), whole, 1e-12);
  EXPECT_NEAR(d(0, 1), whole / 2, 1e-12);  // half-way through the fade of 0.2 degC
  EXPECT_NEAR(d(0, 2), 0, 1e-12);
  EXPECT_EQ(d(0, 3), 0);
  EXPECT_NEAR(d(0, 4), 0.0031 / 2, 1e-12);
  EXPECT_EQ(d(0, 5), 0);
  const auto uses = domain_use(trained, use);
  EXPECT_EQ(uses[0].faded, 2u);
  EXPECT_EQ(uses[0].gone, 1u);
  EXPECT_EQ(uses[1].faded, 3u);
  EXPECT_GE(uses[1].gone, 1u);
  EXPECT_EQ(uses[1].most, 40);
}

}  // namespace
}  // namespace vernier::domain_test
