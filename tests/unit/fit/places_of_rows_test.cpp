// SPDX-License-Identifier: GPL-3.0-or-later
// Which rows stand at one place, whenever they were read.
#include <gtest/gtest.h>

#include <random>
#include <set>

#include "tools/fit/noise/noise_layout.h"
#include "tools/model/machine_reader.h"

namespace vernier::places_of_rows_test {

using namespace vernier::fit;
namespace {

/// Rows of one axis at these positions.
model::Measurement rows_at(const std::vector<double>& positions) {
  const model::Machine machine = model::parse_machine(
      R"(<machine name="slide"><variables><machineaxes><X min="0" max="1500"/></machineaxes>
         </variables><transforms branch="tool"><sixdof n="1" X="X"/></transforms></machine>)",
      "machine.xml");
  std::string csv = "X[mm],x[mm]\n";
  for (const double x : positions) csv += std::to_string(x) + "," + std::to_string(x) + "\n";
  return model::parse_measurement(csv, "rows.csv", machine);
}

std::size_t count_of(const std::vector<int>& places) {
  return std::set<int>(places.begin(), places.end()).size();
}

TEST(PlacesOfRows, RevisitsWithinARepeatabilityAreOnePlaceInWhateverOrder) {
  std::mt19937_64 random(7);
  std::uniform_real_distribution<double> anywhere(0, 1500), again(-0.002, 0.002);
  for (int trial = 0; trial < 20; ++trial) {
    std::vector<double> targets(60), positions;
    for (double& x : targets) x = anywhere(random);
    for (int visit = 0; visit < 4; ++visit)
      for (const double x : targets) positions.push_back(x + again(random));
    const std::size_t found = count_of(places_of_rows(rows_at(positions)));
    EXPECT_GE(found, 57u) << trial;  // two targets may be neighbours by chance
    EXPECT_LE(found, 60u) << trial;
  }
}

TEST(PlacesOfRows, PositionsAtRandomAreEachAPlaceOfItsOwn) {
  std::mt19937_64 random(11);
  std::uniform_real_distribution<double> anywhere(0, 1500);
  for (int trial = 0; trial < 20; ++trial) {
    std::vector<double> positions(240);
    for (double& x : positions) x = anywhere(random);
    EXPECT_GE(count_of(places_of_rows(rows_at(positions))), 238u) << trial;
  }
}

TEST(PlacesOfRows, AGridReadAgainIsItsTargets) {
  std::vector<double> positions;
  for (int visit = 0; visit < 5; ++visit)
    for (int i = 0; i < 13; ++i) positions.push_back(75.0 * i);
  EXPECT_EQ(count_of(places_of_rows(rows_at(positions))), 13u);
}

}  // namespace
}  // namespace vernier::places_of_rows_test
