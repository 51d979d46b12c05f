// SPDX-License-Identifier: GPL-3.0-or-later
#include <fmt/format.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <nlohmann/json.hpp>

#include "tools/text/files.h"
#include "tools/vibration/feature_rows.h"

namespace vernier::features_command_test {

using namespace vernier::format;
using namespace vernier::text;
using namespace vernier::vibration;
namespace {

const std::string kFolder = testing::TempDir() + "features_command_" + std::to_string(getpid()) + "/";

int run(const std::string& arguments) {
  const std::string command = VERNIER_BIN_DIR "/vernier features " + arguments + " > " + kFolder + "out 2>&1";
  const int status = std::system(command.c_str());
  return WIFEXITED(status) ? WEXITSTATUS(status) : -1;
}

double position_mm(double t) {
  return 20 * std::sin(2.2 * t + std::sin(0.9 * t)) + 2 * std::sin(9 * t) * std::sin(0.4 * t);
}
double acceleration_mm_s2(double t) {
  const double h = 1e-4;
  return (position_mm(t + h) - 2 * position_mm(t) + position_mm(t - h)) / (h * h);
}

/// Rows each 20 ms over 20 s, and a record at 1 kHz whose clock began 1.25 s later.
void write_files() {
  std::filesystem::create_directories(kFolder);
  std::string rows = "t[s],X[mm],x[mm],run\n", record = "t[s],table[g],base[g]\n";
  for (int i = 0; i < 1000; ++i)
    rows += fmt::format("{:.3f},{:.7f},{:.7f},a\n", i * 0.02, position_mm(i * 0.02), position_mm(i * 0.02));
  for (int i = 0; i < 17000; ++i)
    record +=
        fmt::format("{:.3f},{:.9f},0.5\n", i * 0.001, 0.5 + acceleration_mm_s2(i * 0.001 + 1.25) / 9806.65);
  write_file(kFolder + "rows.csv", rows);
  write_file(kFolder + "record.csv", record);
}

TEST(FeaturesCommand, AddsTheFeaturesOfTheWindowThatEndsAtTheRow) {
  write_files();
  ASSERT_EQ(run(kFolder + "record.csv --rows " + kFolder +
                "rows.csv --difference own=table-base --align table=X --window 800"
                " --features RMS,KURTOSIS,FREQUENCY --json " +
                kFolder + "j.json -o " + kFolder + "out.csv"),
            0);
  const auto json = nlohmann::json::parse(read_file(kFolder + "j.json"));
  EXPECT_NEAR(json["clock"]["offset_s"].get<double>(), 1.25, 1e-3);
  EXPECT_NEAR(json["clock"]["rate"].get<double>(), 1, 1e-4);
  const CsvFile out = parse_csv(read_file(kFolder + "out.csv"), "out.csv");
  ASSERT_EQ(out.columns.size(), 4u + 9u);
  EXPECT_EQ(out.columns[10].name, "own_RMS");
  EXPECT_EQ(out.columns[10].unit, "g");
  // Row 500 is t = 10 s, sample 8750 of the record; its window begins at 7951.
  std::vector<double> x;
  for (int i = 7951; i <= 8750; ++i) x.push_back(acceleration_mm_s2(i * 0.001 + 1.25) / 9806.65);
  Fourier fourier(800);
  const SignalFeatures expected = signal_features(x, 1000, fourier);
  EXPECT_NEAR(std::stod(out.rows[500][10]), expected[2], 2e-3 * expected[2]);  // a sample to either side
  EXPECT_NEAR(std::stod(out.rows[500][11]), expected[6], 2e-2);
  EXPECT_EQ(out.rows[10][10], "");                              // no full window yet
  EXPECT_EQ(json["rows_without_window"].get<int>(), 103 + 87);  // before its first full window, after its end
}

TEST(FeaturesCommand, RefusesWhatItCannotReadAndWritesNothing) {
  write_files();
  const std::string to = " -o " + kFolder + "never.csv";
  write_file(kFolder + "uneven.csv", "t[s],a[g]\n0,1\n0.1,1\n0.3,2\n");
  EXPECT_EQ(run(kFolder + "uneven.csv" + to), 1);
  EXPECT_NE(read_file(kFolder + "out").find("uneven.csv:3: \"0.1\""), std::string::npos)
      << read_file(kFolder + "out");
  write_file(kFolder + "cell.csv", "a[g]\n0\nx\n");
  EXPECT_EQ(run(kFolder + "cell.csv --rate 100" + to), 1);
  EXPECT_EQ(run(kFolder + "record.csv --features RMS,LOUDNESS" + to), 1);
  EXPECT_EQ(run(kFolder + "record.csv --difference own=table-roof" + to), 1);
  EXPECT_FALSE(std::filesystem::exists(kFolder + "never.csv"));
}

TEST(FeaturesCommand, FollowsPositionsWhereThereIsNoCommonClock) {
  std::filesystem::create_directories(kFolder);
  std::string rows = "X[mm],x[mm]\n", record = "X[mm],a[g]\n";
  for (int i = 0; i < 50; ++i) rows += fmt::format("{},0\n", i + 20);
  for (int i = 0; i < 2000; ++i) record += fmt::format("{},{}\n", i * 0.05, i % 2 == 0 ? i : -i);
  write_file(kFolder + "rows.csv", rows);
  write_file(kFolder + "record.csv", record);
  ASSERT_EQ(run(kFolder + "record.csv --rate 500 --rows " + kFolder +
                "rows.csv --by-position X --reach 30 --window 100 --features PEAK -o " + kFolder + "out.csv"),
            0);
  const CsvFile out = parse_csv(read_file(kFolder + "out.csv"), "out.csv");
  EXPECT_EQ(std::stod(out.rows[0][2]), 400);  // at 20 mm: sample 400
  EXPECT_EQ(std::stod(out.rows[49][2]), 1380);
}

}  // namespace
}  // namespace vernier::features_command_test
