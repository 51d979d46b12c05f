// SPDX-License-Identifier: GPL-3.0-or-later
// Manual pages come from the same definitions as --help; a letterhead stands on every kind of report.
#include <gtest/gtest.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <sstream>

#include "tools/text/files.h"

namespace vernier::manual_test {

using namespace vernier::text;
namespace {

namespace fs = std::filesystem;

struct Manual : testing::Test {
  Manual() { fs::create_directories(folder); }
  ~Manual() override { fs::remove_all(folder); }
  int run(const std::string& words) const {
    const int status = std::system(
        ("cd '" + folder + "' && PATH=" VERNIER_BIN_DIR ":$PATH sh -ec \"" + words + "\" >out.txt 2>&1")
            .c_str());
    return WIFEXITED(status) ? WEXITSTATUS(status) : -1;
  }
  std::string said() const { return read_file(folder + "/out.txt"); }
  const std::string folder = testing::TempDir() + "manual_" + std::to_string(getpid());
};

TEST_F(Manual, HasAPageForEachCommandOfTheHelp) {
  ASSERT_EQ(run("vernier manual -o man && vernier --help >help.txt"), 0) << said();
  std::istringstream help(read_file(folder + "/help.txt"));
  bool commands = false;
  std::size_t count = 0;
  for (std::string line; std::getline(help, line);) {
    commands = commands || line == "Measure:";
    if (!commands || line.size() < 3 || line[0] != ' ' || line[2] == ' ') continue;
    const std::string name = line.substr(2, line.find(' ', 2) - 2);
    if (name == "help") continue;
    EXPECT_TRUE(fs::exists(folder + "/man/vernier-" + name + ".1")) << name;
    ++count;
  }
  EXPECT_GT(count, 30u);
  const std::string page = read_file(folder + "/man/vernier-import-table.1");
  for (const char* words : {".TH VERNIER-IMPORT-TABLE 1", ".SH NAME\n", ".SH OPTIONS\n", "\\-\\-deviation",
                            "\\-\\-save\\-profile"})
    EXPECT_NE(page.find(words), std::string::npos) << words << page.substr(0, 300);
}

TEST_F(Manual, WhatMayBeLeftOutStandsInBrackets) {
  ASSERT_EQ(run("vernier manual -o man"), 0) << said();
  EXPECT_NE(read_file(folder + "/man/vernier-compare.1").find("\\fIMACHINE\\fR [\\fIMEAS\\fR...]"),
            std::string::npos);
  EXPECT_NE(read_file(folder + "/man/vernier-fit.1").find("\\fIMACHINE\\fR \\fIMEAS\\fR..."),
            std::string::npos);
}

TEST_F(Manual, IsGoodTroff) {
  if (std::system("command -v groff >/dev/null") != 0) GTEST_SKIP() << "no groff";
  ASSERT_EQ(run("vernier manual -o man; for page in man/*.1; do groff -man -Tutf8 -K utf8 -ww \\$page "
                "2>>warnings >/dev/null; done; "
                "test ! -s warnings"),
            0)
      << read_file(folder + "/warnings").substr(0, 1000);
}

TEST_F(Manual, LetterheadStandsOnEveryReport) {
  write_file(folder + "/shop.txt", "# of the shop\ncompany = Muster & Sohn\noperator = A\n");
  const std::string data = std::string(VERNIER_SOURCE_DIR) + "/tests/data/hidden/bridge_lag_cyclic/";
  const std::string head = " --letterhead shop.txt --header operator=B --header 'serial number=47<11'";
  for (const std::string& words :
       {"compare " + data + "model.xml " + data + "survey.csv --datum", "map " + data + "model.xml",
        "evaluate iso230-2 " + std::string(VERNIER_SOURCE_DIR) + "/tests/data/iso230_2/ecmc.csv --axis X"}) {
    ASSERT_EQ(run("vernier " + words + " -o r.html" + head), 0) << words << said();
    const std::string page = read_file(folder + "/r.html");
    EXPECT_NE(page.find("<p class=\"company\">Muster &amp; Sohn</p>"), std::string::npos) << words;
    EXPECT_NE(page.find("<dt>operator</dt><dd>B</dd>"), std::string::npos) << words;
    EXPECT_NE(page.find("<dd>47&lt;11</dd>"), std::string::npos) << words;
  }
  write_file(folder + "/shop.txt", "company\n");
  EXPECT_EQ(run("vernier map " + data + "model.xml -o r.html --letterhead shop.txt"), 1);
  EXPECT_NE(said().find("shop.txt:1: \"company\""), std::string::npos) << said();
}

TEST_F(Manual, SurveyComesBackFromItsWorkbook) {
  ASSERT_EQ(run("vernier new gantry --axis X:0:600 --axis Y:0:400 -o m.xml --measurements s.xlsx --errors "
                "positioning && "
                "vernier new gantry --axis X:0:600 --axis Y:0:400 -o m2.xml --measurements s2.xlsx --errors "
                "positioning"),
            0)
      << said();
  EXPECT_EQ(read_file(folder + "/s.xlsx"), read_file(folder + "/s2.xlsx")) << "same input, same bytes";
  // Positions come back; the readings are still to be filled in, and that is said.
  EXPECT_EQ(run("vernier import table s.xlsx -o s.csv --machine m.xml"), 1);
  EXPECT_NE(said().find("the columns of readings are empty (x[mm]"), std::string::npos) << said();
  EXPECT_NE(said().find("X[mm]"), std::string::npos) << said();
  // Only what an instrument along each axis sees is free.
  const std::string machine = read_file(folder + "/m.xml");
  EXPECT_NE(machine.find("<table axis=\"X\" fit=\"X\">"), std::string::npos);
  EXPECT_NE(machine.find("<table axis=\"Y\" fit=\"Y\">"), std::string::npos);
  EXPECT_NE(machine.find("<EC0Y value=\"0\" nominal=\"0\" unit=\"rad\" Hide=\"true\""), std::string::npos);
}

}  // namespace
}  // namespace vernier::manual_test
