// SPDX-License-Identifier: GPL-3.0-or-later
// Rows that were measured with the correction on: a plan builds on them and asks for none.
#include <gtest/gtest.h>

#include <fmt/format.h>

#include "tools/model/machine_reader.h"
#include "tools/plan/offers.h"

namespace vernier::measured_on_test {

using namespace vernier::model;
using namespace vernier::plan;
namespace {

Machine machine() {
  return parse_machine(R"xml(<machine><variables><static><s value="0" nominal="0"/></static>
    <machineaxes><X/><Y/></machineaxes></variables>
    <transforms><sixdof X="X+s*X" Y="Y"/></transforms></machine>)xml",
                       "m.xml");
}

/// A grid of 10 mm, every other row with a correction of its own.
Measurement rows() {
  std::string text = "X[mm],Y[mm],x[mm],y[mm],correctionX[um],correctionY[um],corrected\n";
  for (int i = 0; i < 40; ++i)
    text += fmt::format("{},{},0,0,{},{}\n", 10 * (i % 8), 10 * (i / 8), i % 2 == 0 ? 3.1 * i : 0,
                        i % 2 == 0 ? "-7,0123456789abcdef" : ",");
  return parse_measurement(text, "rows.csv", machine());
}

TEST(PlanFromCorrectedRows, OffersAreCommandedAndCarryNoCorrection) {
  const Offers offers = offer_rows(machine(), rows(), {}, 200);
  ASSERT_EQ(offers.existing, 40U);
  EXPECT_GT(offers.rows.correction[0].head(40).abs().maxCoeff(), 0.1);
  EXPECT_EQ(offers.rows.correction[0].tail(200).abs().maxCoeff(), 0);
  EXPECT_EQ(offers.rows.correction[1].tail(200).abs().maxCoeff(), 0);
  int on_grid = 0;
  for (std::size_t row = 40; row < 240; ++row) {
    EXPECT_TRUE(offers.rows.corrected[row].empty());
    const double x = offers.rows.states.axis[0][static_cast<Eigen::Index>(row)];
    on_grid += x == 10 * std::round(x / 10) ? 1 : 0;
  }
  EXPECT_GT(on_grid, 40);  // half of the poses are recorded ones, those at the ends moved inside
}

TEST(PlanFromCorrectedRows, AppendedRowsKeepWhatEachHas) {
  const Measurement all = rows();
  const Measurement some = select_rows(all, {2, 0});
  EXPECT_EQ(some.correction[0][0], all.correction[0][2]);
  EXPECT_EQ(some.corrected[1], "0123456789abcdef");
  Measurement planned = select_rows(all, {4});
  planned.correction.clear();
  planned.corrected.clear();
  const Measurement both = append_rows(all, planned);
  EXPECT_EQ(both.correction[1][0], all.correction[1][0]);
  EXPECT_EQ(both.correction[1][40], 0);
  EXPECT_EQ(both.corrected[40], "");
}

}  // namespace
}  // namespace vernier::measured_on_test
