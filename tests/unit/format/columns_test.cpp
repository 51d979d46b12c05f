// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/format/columns.h"

#include <gtest/gtest.h>

#include <map>
#include <set>
#include <string>
#include <string_view>
#include <vector>

namespace vernier::format {
namespace {

TEST(Columns, HaveOneMeaningAndAKnownUnitEach) {
  std::set<std::string> names;
  for (const ColumnGroup& group : column_groups()) {
    EXPECT_TRUE(find_unit(group.unit)) << group.unit;
    EXPECT_FALSE(group.words && *group.unit != '\0') << group.names[0] << ": words have no unit";
    for (const char* const name : group.list()) {
      EXPECT_TRUE(names.insert(name).second) << name << " is in two groups";
      EXPECT_EQ(find_column(name), &group) << name;
    }
  }
  EXPECT_EQ(find_column("X"), nullptr) << "names are case-sensitive";
  EXPECT_EQ(find_column("a1"), nullptr) << "a kind without a column of its own";
}

TEST(Columns, HeadingsHaveTheUnitOfTheTable) {
  EXPECT_EQ(heading(columns::kFeed), "feed[mm/min]");
  EXPECT_EQ(heading("nx"), "nx");
  EXPECT_EQ(heading("T_column", "degC"), "T_column[degC]");
  EXPECT_EQ(headings(columns::kCentre), "cx[mm],cy[mm],cz[mm]");
  EXPECT_STREQ(column_unit("T_column"), "");
  EXPECT_EQ(reading_column_names(),
            "x y z rx ry rz length d ax ay az distance ix iy same on bx by bz brx bry brz");
}

TEST(Columns, OfAnAxisAreTakenApart) {
  const auto is_axis = [](const std::string& name) { return name == "X" || name == "dirX"; };
  const auto quantity = [&](const char* name) { return axis_column_named(name, is_axis)->quantity; };
  for (const AxisColumnEntry& column : kAxisColumns)
    if (column.quantity != AxisQuantity::kSense) {
      EXPECT_EQ(quantity(axis_column(column.quantity, "X").c_str()), column.quantity) << column.prefix;
    }
  EXPECT_EQ(quantity("dirX"), AxisQuantity::kPosition) << "an axis of that very name comes first";
  EXPECT_EQ(axis_column_named("dirX", [](const std::string& name) { return name == "X"; })->quantity,
            AxisQuantity::kSense);
  EXPECT_FALSE(axis_column_named("dirY", is_axis));
  EXPECT_FALSE(axis_column_named("dir", is_axis));
  EXPECT_EQ(axis_heading(AxisQuantity::kSpeed, "C", true), "vC[deg/s]");
  EXPECT_EQ(axis_heading(AxisQuantity::kSense, "C", true), "dirC");
}

/// Is the column of this name a reading in a file with this header?
bool reads(const std::vector<CsvColumn>& header, std::string_view name) {
  const auto find = [&](std::string_view other) -> const CsvColumn* {
    for (const CsvColumn& column : header)
      if (column.name == other) return &column;
    return nullptr;
  };
  const CsvColumn* const column = find(name);
  return column != nullptr && is_reading(*column, find);
}

// Older files may have these names for other things.
TEST(Columns, OfALaterVersionAreReadingsOnlyWithWhatBelongsToThem) {
  EXPECT_TRUE(reads({{"x", "mm"}}, "x"));
  EXPECT_TRUE(reads({{"length", "mm"}}, "length")) << "the missing centre is an error of the file";
  EXPECT_FALSE(reads({{"distance", "mm"}}, "distance"));
  EXPECT_TRUE(reads({{"distance", "mm"}, {"from", ""}}, "distance"));
  EXPECT_FALSE(reads({{"ix", "A"}}, "ix"));
  EXPECT_TRUE(reads({{"ix", "arcsec"}}, "ix"));
  EXPECT_FALSE(reads({{"ax", ""}, {"ay", ""}}, "ax"));
  EXPECT_TRUE(reads({{"ax", ""}, {"ay", ""}, {"az", ""}}, "ax"));
  EXPECT_FALSE(reads({{"ax", ""}, {"ay", ""}, {"az", "mm/s^2"}}, "ax"));
  EXPECT_FALSE(reads({{"cx", "mm"}}, "cx")) << "stands beside a reading, is none";
}

TEST(Columns, NamesOfTermsAreReserved) {
  for (const char* name : {"t", "feed", "curv", "visit", "nx", "ny", "nz", "run"})
    EXPECT_TRUE(is_name_of_terms(name)) << name;
  for (const char* name : {"x", "u", "setup", "T_column"}) EXPECT_FALSE(is_name_of_terms(name)) << name;
}

TEST(Columns, RolesAreFitAndCheck) {
  EXPECT_TRUE(is_role("fit") && is_role("check"));
  EXPECT_FALSE(is_role("") || is_role("Fit"));
}

TEST(Columns, RotationAboutARotaryAxisIsItsReading) {
  EXPECT_EQ(angle_about("C"), "rz");
  EXPECT_EQ(angle_about("X"), std::nullopt);
  EXPECT_EQ(angle_about("AB"), std::nullopt);
}

TEST(Units, OfEveryDimensionContainItsBaseUnit) {
  for (const Dimension dimension : all_dimensions()) {
    if (dimension == Dimension::kNone) continue;
    const auto base = find_unit(base_unit(dimension));
    ASSERT_TRUE(base);
    EXPECT_EQ(base->dimension, dimension) << base->name;
    bool listed = false;
    for (const std::string& name : units_of(dimension)) {
      EXPECT_EQ(find_unit(name)->dimension, dimension) << name;
      listed = listed || name == base->name;
    }
    EXPECT_TRUE(listed) << base->name;
  }
}

}  // namespace
}  // namespace vernier::format
