// SPDX-License-Identifier: GPL-3.0-or-later
// The table of reading kinds agrees with itself: names, forms, columns and units.
#include "tools/format/readings.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <set>
#include <string>

#include "tools/format/columns.h"

namespace vernier::format {
namespace {

TEST(ReadingKinds, AreFoundByTheirNames) {
  std::set<std::string> names;
  for (const ReadingKindEntry& entry : kReadingKinds) {
    EXPECT_EQ(kind_named(entry.name), entry.kind) << entry.name;
    EXPECT_TRUE(names.insert(entry.name).second) << entry.name << " is the name of two kinds";
    EXPECT_STREQ(name_of(entry.kind), entry.name);
    EXPECT_FALSE(std::string(entry.meaning).empty()) << entry.name;
  }
  EXPECT_EQ(kind_named("X"), std::nullopt);
}

// A kind is read from the column of its name. A direction is read from all its columns together, and its two
// angles have no column. A touch is read from a label.
TEST(ReadingKinds, HaveTheColumnsOfTheirForm) {
  for (const ReadingKindEntry& entry : kReadingKinds) {
    const ColumnGroup& group = reading_columns(entry.form);
    if (is_direction(entry.kind) || is_of_thing(entry.kind)) {
      EXPECT_EQ(find_column(entry.name), nullptr) << entry.name;
      continue;
    }
    ASSERT_LT(entry.component, group.count) << entry.name;
    EXPECT_STREQ(group.names[entry.component], entry.name);
  }
}

TEST(ReadingKinds, FormsHaveOneGroupOfReadingColumnsEach) {
  for (const ReadingFormEntry& form : kReadingForms) {
    const auto count =
        std::count_if(column_groups().begin(), column_groups().end(), [&](const ColumnGroup& group) {
          return group.use == ColumnUse::kReading && group.form == form.form;
        });
    EXPECT_EQ(count, 1) << form.meaning;
    const auto kinds = std::count_if(kReadingKinds.begin(), kReadingKinds.end(),
                                     [&](const ReadingKindEntry& kind) { return kind.form == form.form; });
    EXPECT_GT(kinds, 0) << form.meaning;
    // Columns taken together are the coordinates of a unit vector or a label: pure numbers, whatever the
    // reading is. The pose of a board has its units.
    const bool board = form.form == ReadingForm::kBoard || form.form == ReadingForm::kBoardRotation;
    const Dimension wanted = form.together && !board ? Dimension::kNone
                             : form.rotation         ? Dimension::kAngle
                                                     : Dimension::kLength;
    EXPECT_EQ(dimension_of(reading_columns(form.form)), wanted) << form.meaning;
  }
}

TEST(ReadingKinds, OfEveryFormCanBeSurveyed) {
  for (const ReadingFormEntry& form : kReadingForms) {
    const auto alone = std::count_if(kSurveyReadings.begin(), kSurveyReadings.end(), [&](const auto& survey) {
      return survey.form_count == 1 && survey.forms[0] == form.form;
    });
    EXPECT_EQ(alone, 1) << form.meaning;
  }
  EXPECT_EQ(survey_reading("pose")->list().size(), 2u);
  EXPECT_EQ(survey_reading("glance"), nullptr);
  EXPECT_EQ(survey_words("or"),
            "point, length, touch, pose, rotation, direction, distance, inclination, same, on, board, "
            "board-rotation "
            "or board-pose");
}

TEST(ReadingKinds, SayWhatTheyAre) {
  EXPECT_EQ(subject_of(ReadingKind::kY), "Y error");
  EXPECT_EQ(subject_of(ReadingKind::kRz), "rotation error about Z");
  EXPECT_EQ(subject_of(ReadingKind::kLength), "length error");
  EXPECT_EQ(subject_of(ReadingKind::kA2), "direction error");
  EXPECT_EQ(subject_of(ReadingKind::kIx), "inclination error of tool axis X");
  EXPECT_STREQ(unit_of(ReadingKind::kIx), "deg");
  EXPECT_STREQ(unit_of(ReadingKind::kDistance), "mm");
  EXPECT_TRUE(is_free_of_setup(ReadingKind::kD));
  EXPECT_FALSE(is_free_of_setup(ReadingKind::kX));
}

}  // namespace
}  // namespace vernier::format
