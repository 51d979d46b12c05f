// SPDX-License-Identifier: GPL-3.0-or-later
#include <gtest/gtest.h>
#include <unistd.h>

#include "tests/unit/import/ballbar_data.h"
#include "tools/import/ballbar/ballbar_csv.h"
#include "tools/import/ballbar/ballbar_file.h"
#include "tools/import/ballbar/ballbar_motion.h"
#include "tools/import/ballbar/json_place.h"
#include "tools/import/ballbar/trace_reader.h"
#include "tools/text/error.h"

namespace vernier::trace_reader_test {

using namespace vernier::importer;
using namespace vernier::text;
namespace {

TraceSetup setup_6000() {
  TraceSetup setup;
  setup.feed_mm_min = 6000;
  return setup;
}

TEST(TraceReader, ReadsTheFragment) {
  const BallbarFile file = read_ballbar_trace(ballbar_data("ballbar_trace_fragment.json"), setup_6000());
  ASSERT_EQ(file.runs.size(), 1u);
  ASSERT_EQ(file.runs[0].reading_mm.size(), 34u);
  EXPECT_EQ(file.runs[0].reading_mm[0], -0.070085994597527415);
  EXPECT_EQ(file.runs[0].reading_mm[33], -0.055732364694930307);
  EXPECT_EQ(file.runs[0].direction, +1);
  EXPECT_NEAR(actual_feed_mm_min(file, file.runs[0]), 6000, 1e-9);
  // 100 mm/s on a radius of 100 mm for 5 ms are 5 mrad, half of it to the first sample.
  EXPECT_NEAR(circle_point(file, file.runs[0], 0).angle_deg, 180 + 0.0025 * 180 / std::acos(-1.0), 1e-9);
  EXPECT_EQ(file.notes.size(), 2u);
}

TEST(TraceReader, ClockwiseRunGoesTheOtherWay) {
  TraceSetup setup = setup_6000();
  setup.direction_of_zero = -1;
  const BallbarFile file = read_ballbar_trace(ballbar_data("ballbar_trace_fragment.json"), setup);
  EXPECT_EQ(file.runs[0].label, "CW");
  EXPECT_NEAR(circle_point(file, file.runs[0], 0).angle_deg, 180 - 0.0025 * 180 / std::acos(-1.0), 1e-9);
  EXPECT_GT(circle_point(file, file.runs[0], 0).velocity_mm_s[1], 0);
}

TEST(TraceReader, FragmentBecomesRows) {
  const BallbarFile file = read_ballbar_trace(ballbar_data("ballbar_trace_fragment.json"), setup_6000());
  const BallbarCsv csv = ballbar_csv({file}, {});
  EXPECT_EQ(csv.fit_rows, 34u);
  EXPECT_EQ(csv.check_rows, 0u);
}

/// A trace of full circles, one a deviation (mm): 1257 readings at 6000 mm/min on 100 mm.
std::string circles_text(const std::vector<double>& deviations_mm) {
  std::string text = "{\"ErrorUnits\": \"millimetres\", \"AxisUnderTest\": \"XYZ\", \"Runs\": [";
  for (std::size_t run = 0; run < deviations_mm.size(); ++run) {
    text += std::string(run == 0 ? "" : ",") + "\n{\"Direction\": " + std::to_string(run % 2) +
            ", \"Readings\": [";
    for (int i = 0; i < 1257; ++i) text += (i == 0 ? "" : ",") + std::to_string(deviations_mm[run]);
    text += "]}";
  }
  return text + "]}";
}

const std::vector<TraceCircle> kThreeCircles = {{"XY", 0}, {"YZ", 0}, {"ZX", 90}};

TEST(TraceReader, ThreeCirclesOfAPathAreThreeRunsInTheirPlanes) {
  const ScratchFile file("three.json", circles_text({0.001, 0.002, 0.003}));
  const std::vector<BallbarFile> files = read_trace_circles({file.path()}, setup_6000(), kThreeCircles);
  ASSERT_EQ(files.size(), 3u);
  EXPECT_EQ(files[1].axis_a + files[1].axis_b, "YZ");
  EXPECT_EQ(files[2].runs[0].reading_mm[0], 0.003);
  EXPECT_EQ(files[2].runs[0].first_deg, 90);
  EXPECT_EQ(files[1].runs[0].direction, -1);
  EXPECT_EQ(files[0].notes.size() + files[1].notes.size() + files[2].notes.size(), 2u);
  const BallbarCsv csv = ballbar_csv(files, {});
  EXPECT_EQ(csv.run_labels, (std::vector<std::string>{"XY CCW", "YZ CW", "ZX CCW"}));
  EXPECT_EQ(csv.fit_rows, 3u * 1257);
  EXPECT_NE(csv.text.find("X[mm],Y[mm],Z[mm],vX"), std::string::npos);
  EXPECT_EQ(csv.text.find("# ball bar: "), csv.text.rfind("# ball bar: ")) << "one file";
}

TEST(TraceReader, CirclesMayComeInSeveralFilesAndInBothSenses) {
  const ScratchFile first("first.json", circles_text({0.001, 0.002, 0.003})),
      second("second.json", circles_text({0.004, 0.005, 0.006}));
  const std::vector<BallbarFile> files =
      read_trace_circles({first.path(), second.path()}, setup_6000(), kThreeCircles);
  // XY: two runs of the first file; YZ: its last and the first of the second; ZX: the other two.
  ASSERT_EQ(files.size(), 4u);
  EXPECT_EQ(files[0].runs.size(), 2u);
  EXPECT_EQ(files[1].axis_a, "Y");
  EXPECT_EQ(files[2].axis_a, "Y");
  EXPECT_EQ(files[2].runs[0].reading_mm[0], 0.004);
  EXPECT_EQ(files[3].axis_a, "Z");
  EXPECT_EQ(files[3].runs.size(), 2u);
  const std::vector<std::string> labels = ballbar_csv(files, {}).run_labels;
  ASSERT_EQ(labels.size(), 6u);
  EXPECT_NE(labels[3].find("second YZ CCW"), std::string::npos) << labels[3];
}

TEST(TraceReader, RunsThatDoNotDivideAmongThePlanesAreRefused) {
  const ScratchFile file("four.json", circles_text({0, 0, 0, 0}));
  try {
    read_trace_circles({file.path()}, setup_6000(), kThreeCircles);
    FAIL() << "accepted";
  } catch (const InputError& error) {
    EXPECT_NE(std::string(error.what()).find("\"4 runs\": do not divide evenly among 3 planes"),
              std::string::npos)
        << error.what();
  }
}

struct Damage {
  const char *from, *to;
  const char* message;
};

class TraceReaderDamage : public ::testing::TestWithParam<Damage> {};

TEST_P(TraceReaderDamage, IsAnErrorThatNamesLineAndWord) {
  const ScratchFile file("damaged.json", replaced(text_of(ballbar_data("ballbar_trace_fragment.json")),
                                                  GetParam().from, GetParam().to));
  try {
    read_ballbar_trace(file.path(), setup_6000());
    FAIL() << "accepted";
  } catch (const InputError& error) {
    EXPECT_EQ(std::string(error.what()).rfind(file.path() + GetParam().message, 0), 0u) << error.what();
  }
}

INSTANTIATE_TEST_SUITE_P(Trace, TraceReaderDamage,
                         ::testing::Values(Damage{"-0.16441383149986355", "\"-0.164\"",
                                                  ":20: \"\"-0.164\"\""},
                                           Damage{"-0.16441383149986355", "null", ":20: \"null\""},
                                           Damage{"-0.16441383149986355", "-0.16x", ":20: \"-0.16x\""},
                                           Damage{"-0.16441383149986355", "-1e999", ":20: \"-1e999\""},
                                           Damage{"\"Direction\": 0", "\"Direction\": 2", ":17: \"2\""},
                                           Damage{"\"Direction\": 0,", "", ":16: "},
                                           Damage{"millimetres", "furlongs", ":10: \"\"furlongs\"\""},
                                           Damage{"\"Runs\": [", "\"Runs\": [], \"Rins\": [", ":15: \"[]\""},
                                           Damage{"\"ErrorUnits\": \"millimetres\",", "", ":1: "}));

TEST(JsonPlace, FindsTheLineOfAnyValue) {
  const std::string text = "{\n \"a\": [1,\n  {\"b\": 2},\n  3],\n \"c\":\n  4\n}";
  EXPECT_EQ(json_line(text, "/a/0"), 2u);
  EXPECT_EQ(json_line(text, "/a/1/b"), 3u);
  EXPECT_EQ(json_line(text, "/a/2"), 4u);
  EXPECT_EQ(json_line(text, "/c"), 6u);
  EXPECT_EQ(json_line(text, "/d"), 0u);
}

}  // namespace
}  // namespace vernier::trace_reader_test
