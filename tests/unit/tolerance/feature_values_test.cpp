// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/tolerance/feature_values.h"

#include <gtest/gtest.h>

#include "tests/unit/tolerance/plate.h"
#include "tools/fit/coverage/point_readings.h"
#include "tools/fit/coverage/reach.h"
#include "tools/model/chain/chain.h"
#include "tools/text/error.h"

namespace vernier::tolerance_test {

using namespace vernier::fit;
using namespace vernier::model;
using namespace vernier::text;
using namespace vernier::tolerance;
namespace {

double value_of(const PartValues& values, std::size_t feature, PartCharacteristic what,
                const Eigen::VectorXd& rows) {
  for (const CharacteristicValue& value : values.values)
    if (value.feature == feature && value.what == what) return value.of(rows);
  return -1;
}

struct Plate {
  explicit Plate(const Machine& machine, const char* text = kBores)
      : part(place_part(machine, parse_part(text, "p.csv"), at_rest(machine))),
        values(part_values(part, PartFrame::kPart, "p.csv")),
        rows(values.map * Eigen::VectorXd(deviation(machine, part.states).reshaped())) {}
  PlacedPart part;
  PartValues values;
  Eigen::VectorXd rows;
};

TEST(PartValues, AScaleErrorIsSizeAndForm) {
  // Radial deviation k r cos^2: its mean is k r / 2, what is left k r cos(2 a) / 2, from -1/2 to 1/2.
  const double k = 1e-4, diameter = 40;
  const Plate plate(plate_machine(k, 0));
  for (std::size_t f = 0; f < 3; ++f) {
    EXPECT_NEAR(value_of(plate.values, f, PartCharacteristic::kSize, plate.rows), k * diameter / 2, 1e-9);
    EXPECT_NEAR(value_of(plate.values, f, PartCharacteristic::kForm, plate.rows), k * diameter / 2, 1e-9);
  }
}

TEST(PartValues, ASquarenessIsFormAndPlaceAndNoSize) {
  // Radial deviation s r sin(2 a) / 2, the largest at 45 deg: twelve points see 87 % of it, 24 see it.
  const double s = 1e-4;
  const Plate plate(plate_machine(0, s));
  EXPECT_NEAR(value_of(plate.values, 2, PartCharacteristic::kForm, plate.rows), s * 20, 1e-9);
  EXPECT_NEAR(value_of(plate.values, 2, PartCharacteristic::kSize, plate.rows), 0, 1e-9);
  EXPECT_GT(value_of(plate.values, 2, PartCharacteristic::kPosition, plate.rows), 1e-3);
}

TEST(PartValues, AMotionOfTheWholeIsNothing) {
  const Machine machine = plate_machine(0, 0);
  const Plate plate(machine);
  const Eigen::MatrixXd motions = rigid_motions(plate.part.point);
  for (Eigen::Index i = 0; i < 6; ++i) {
    const Eigen::VectorXd rows = plate.values.map * motions.col(i);
    // 1e-9 of the way that the motion makes the points go.
    EXPECT_LT(rows.cwiseAbs().maxCoeff(), 1e-9 * motions.col(i).cwiseAbs().maxCoeff());
  }
}

TEST(PartValues, DatumsAreWhatOthersAreMeasuredFrom) {
  // Only the third bore moves: seen from the datums it is off by all of that, seen from all by less.
  const Machine machine = plate_machine(0, 0);
  const auto moved = [&](const char* text) {
    const Plate plate(machine, text);
    Eigen::Matrix3Xd off = Eigen::Matrix3Xd::Zero(3, plate.part.point.cols());
    for (std::size_t i = 0; i < plate.part.features[2].count; ++i)
      off(0, static_cast<Eigen::Index>(plate.part.features[2].first + i)) = 0.01;
    const Eigen::VectorXd rows = plate.values.map * off.reshaped();
    return value_of(plate.values, 2, PartCharacteristic::kPosition, rows);
  };
  std::string free = kBores;
  for (auto at = free.find("yes"); at != std::string::npos; at = free.find("yes")) free.erase(at, 3);
  EXPECT_NEAR(moved(kBores), 0.02, 1e-9);  // a zone's diameter is twice the shift of the axis
  EXPECT_LT(moved(free.c_str()), 0.015);
}

TEST(PartValues, AFeatureAloneHasNoPlace) {
  const Machine machine = plate_machine(0, 0);
  const char* const alone = "feature,kind,x,y,z,position\na,point,100,100,-100,0.1\n";
  const PlacedPart part = place_part(machine, parse_part(alone, "p.csv"), at_rest(machine));
  EXPECT_THROW(part_values(part, PartFrame::kPart, "p.csv"), InputError);
  EXPECT_EQ(part_values(part, PartFrame::kMachine, "p.csv").values.size(), 1u);
}

}  // namespace
}  // namespace vernier::tolerance_test
