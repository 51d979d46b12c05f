// SPDX-License-Identifier: GPL-3.0-or-later
#include <gtest/gtest.h>
#include <unistd.h>

#include "tests/unit/import/ballbar_data.h"
#include "tools/import/ballbar/b5r_reader.h"
#include "tools/import/ballbar/ballbar_file.h"
#include "tools/import/ballbar/ballbar_motion.h"
#include "tools/text/error.h"

namespace vernier::b5r_reader_test {

using namespace vernier::importer;
using namespace vernier::text;
namespace {

const BallbarFile& the_file() {
  static const BallbarFile kFile = read_b5r(ballbar_data("ur10e_xy_100mm.b5r"));
  return kFile;
}

TEST(B5rReader, ReadsPlaneRunsAndSeries) {
  const BallbarFile& file = the_file();
  EXPECT_EQ(file.axis_a, "X");
  EXPECT_EQ(file.axis_b, "Y");
  EXPECT_EQ(file.instrument, "QC20-W");
  EXPECT_EQ(file.machine, "UR10e Error Map");
  EXPECT_EQ(file.nominal_length_mm, 100);
  EXPECT_EQ(file.radius_mm, 100);
  EXPECT_EQ(file.programmed_feed_mm_min, 5000);
  ASSERT_EQ(file.runs.size(), 2u);
  EXPECT_EQ(file.runs[0].direction, +1);
  EXPECT_EQ(file.runs[1].direction, -1);
  EXPECT_EQ(file.runs[0].reading_mm.size(), 3182u);
  EXPECT_EQ(file.runs[1].reading_mm.size(), 2976u);
  EXPECT_EQ(file.runs[0].end - file.runs[0].start + 1, 1590u);
  EXPECT_EQ(file.runs[1].end - file.runs[1].start + 1, 1442u);
  ASSERT_EQ(file.simulations.size(), 2u);
  EXPECT_EQ(file.simulations[0].label, "CCW");
  EXPECT_EQ(file.simulations[1].reading_mm.size(), 1442u);
}

TEST(B5rReader, EveryReadingAndAngleIsThatOfTheTable) {
  std::istringstream table(text_of(ballbar_data("readings.csv")));
  std::string line;
  std::getline(table, line);
  std::size_t rows = 0;
  while (std::getline(table, line)) {
    const auto row = cells(line);
    const BallbarRun& run = the_file().runs[row[0] == "CCW" ? 0 : 1];
    const auto index = static_cast<std::size_t>(std::stoul(row[1]));
    ASSERT_EQ(run.reading_mm.at(index), std::stod(row[4])) << line;
    const bool inside = index >= run.start && index <= run.end;
    ASSERT_EQ(inside, row[2] == "1") << line;
    // The table prints five digits.
    if (inside) {
      ASSERT_NEAR(circle_point(the_file(), run, index).angle_deg, std::stod(row[3]), 0.51e-5) << line;
    }
    ++rows;
  }
  EXPECT_EQ(rows, 3182u + 2976u);
}

TEST(B5rReader, EveryPrintedResultIsRead) {
  std::istringstream table(text_of(ballbar_data("features.csv")));
  std::string line;
  std::getline(table, line);
  std::size_t rows = 0, read = 0;
  while (std::getline(table, line)) {
    const auto row = cells(line);
    ++rows;
    if (row[0].starts_with("RUN_")) {
      const auto& features = the_file().runs[row[0] == "RUN_CCW" ? 0 : 1].features;
      for (const auto& feature : features)
        read += feature.name == row[2] && feature.value == std::stod(row[4]);
    } else {
      const auto value = printed_result(the_file(), row[0], row[1], row[2]);
      ASSERT_TRUE(value.has_value()) << line;
      EXPECT_EQ(*value, std::stod(row[4])) << line;
      ++read;
    }
  }
  EXPECT_EQ(rows, 194u);
  EXPECT_EQ(read, rows);
}

struct Damage {
  const char *from, *to;
  const char* message;  // what the error must name, place included
};

class B5rReaderDamage : public ::testing::TestWithParam<Damage> {};

TEST_P(B5rReaderDamage, IsAnErrorThatNamesLineAndWord) {
  const ScratchFile file(
      "damaged.b5r", replaced(text_of(ballbar_data("ur10e_xy_100mm.b5r")), GetParam().from, GetParam().to));
  try {
    read_b5r(file.path());
    FAIL() << "accepted";
  } catch (const InputError& error) {
    EXPECT_EQ(std::string(error.what()).rfind(file.path() + GetParam().message, 0), 0u) << error.what();
  }
}

INSTANTIATE_TEST_SUITE_P(
    B5r, B5rReaderDamage,
    ::testing::Values(Damage{"-0.29488", "-0.29x88", ":95: \"-0.29x88\""},
                      Damage{"+0.31745 ", "+0.31745, ", ":96: \"+0.31745,\""},
                      Damage{"-0.29488", "nan", ":95: \"nan\""},
                      Damage{"<START_INDEX>796", "<START_INDEX>3182", ":92: \"3182\""},
                      Damage{"<START_INDEX>796", "<START_INDEX>2385", ":93: \"2385\""},
                      Damage{"<START_INDEX>796", "<START_INDEX>-1", ":92: \"-1\""},
                      Damage{"<START_INDEX>796", "<START_INDEX>7.5", ":92: \"7.5\""},
                      Damage{"<RUN_DIRECTION>CCW</RUN_DIRECTION>\n<RUN_TEMP",
                             "<RUN_DIRECTION>UP</RUN_DIRECTION>\n<RUN_TEMP", ":90: \"UP\""},
                      Damage{"VIEW=\"+A+B\"", "VIEW=\"+A-B\"", ":13: \"+A-B\""},
                      Damage{"<B_AXIS_NAME>Y", "<B_AXIS_NAME>X", ":15: \"X\""},
                      Damage{"<SAMPLE_RATE>200.000", "<SAMPLE_RATE>0", ":94: \"0\""},
                      Damage{"<NOMINAL_LENGTH>100</NOMINAL_LENGTH>\n", "", ":6: \"NOMINAL_LENGTH\""},
                      Damage{"<END_ANGLE>360", "<END_ANGLE>361", ":10: \"361\""},
                      Damage{"</TEST_SPEC>", "</TEST_SPEX>", ":57: "},
                      Damage{"TEST_DOCUMENT", "TEST_DOKUMENT", ""}));

TEST(B5rReader, MissingFileIsAnError) {
  EXPECT_THROW(read_b5r(ballbar_data("no-such-file.b5r")), InputError);
}

TEST(B5rReader, TextCutAnywhereIsAnError) {
  const std::string text = text_of(ballbar_data("ur10e_xy_100mm.b5r"));
  for (std::size_t size = 0; size < text.size() - 20; size += 997) {
    const ScratchFile file("cut.b5r", text.substr(0, size));
    EXPECT_THROW(read_b5r(file.path()), InputError) << size;
  }
}

}  // namespace
}  // namespace vernier::b5r_reader_test
