// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/import/logs/laser_file.h"

#include <gtest/gtest.h>

#include "tools/text/error.h"

namespace vernier::laser_file_test {

using namespace vernier::importer;
namespace {

const std::string kTargets =
    "HEADER::\r\nFile type  : rtl\r\nOwner      : Linear\r\nVersion no : V20.02.02\r\n\r\n"
    "TARGET DATA::\r\nFiletype  : ISO\r\nTarget-count: 3\r\nTargets :\r\n0.0000  100.0000 \r\n 200.0000 \r\n";
const std::string kUser = "\r\nUSER-TEXT::\r\nMachine: \r\nDate:2020-02-02 10:20:30\r\nAxis:X\r\n\r\n";

std::string file(const std::string& readings, const std::string& flags = "0 0 2 0", const char* runs = "2") {
  return kTargets + "Flags: " + flags + "\r\n" + kUser + "RUNS::\r\nRun-count:" + runs +
         "\r\n\r\nDEVIATIONS::\r\nRun Target Data:\r\n" + readings + "\r\nEOF::\r\n";
}

std::string read(const std::string& text, const std::string& axis = "",
                 RunSenses senses = RunSenses::kAsListed) {
  try {
    return measurement_csv(read_laser_file(text, "l.rtl", axis, senses).table);
  } catch (const text::InputError& error) {
    return std::string("refused: ") + error.what();
  }
}

const std::string kBoth =
    "1   1   0.5\r\n1   2   1.5\r\n1   3   2.5\r\n2   3   3\r\n2   2   2\r\n2   1   1\r\n";
const std::string kListedUp = "1 1 0.5\n1 2 1.5\n1 3 2.5\n2 1 1\n2 2 2\n2 3 3\n";

TEST(LaserFile, BothSensesByTheOrderOfTheLines) {
  EXPECT_EQ(read(file(kBoth)),
            "X[mm],dirX,run,x[mm]\n0,1,1,5e-04\n100,1,1,100.0015\n200,1,1,200.0025\n200,-1,1,200.003\n"
            "100,-1,1,100.002\n0,-1,1,0.001\n");
}

TEST(LaserFile, AxisMayBeSaid) { EXPECT_EQ(read(file(kBoth), "Y").substr(0, 20), "Y[mm],dirY,run,y[mm]"); }

TEST(LaserFile, SensesThatNothingSaysAreAskedFor) {
  EXPECT_NE(read(file(kListedUp)).find("--senses alternate"), std::string::npos);
  EXPECT_NE(read(file(kListedUp), "", RunSenses::kAlternate).find("\n0,-1,1,0.001\n"), std::string::npos);
  EXPECT_NE(read(file(kListedUp), "", RunSenses::kForward).find("\n0,1,2,0.001\n"), std::string::npos);
  EXPECT_NE(read(file(kListedUp, "0 1 2 0")).find("\n0,1,2,0.001\n"), std::string::npos);
}

TEST(LaserFile, ZerosThatFillATestOfOneSenseAreLeftOut) {
  const LaserFile one = read_laser_file(file("1 1 0.5\n1 2 1.5\n1 3 2.5\n2 3 0\n2 2 0\n2 1 0\n", "0 1 2 0"),
                                        "l.rtl", "", RunSenses::kAsListed);
  EXPECT_EQ(one.runs, 1u);
  EXPECT_EQ(one.left_out, 1u);
  EXPECT_EQ(one.table.line.size(), 3u);
}

TEST(LaserFile, WhatDoesNotAgreeIsRefusedWithItsPlace) {
  const std::pair<std::string, const char*> kBad[] = {
      {file("1 1 0.5\n1 4 1\n"), "l.rtl:25: \"4\": this target does not exist: the file has 3 targets"},
      {file("1 1 0.5\n1 2 x\n"), "l.rtl:25: \"x\": not a number"},
      {file("1 1 0.5\n1 2\n"), "l.rtl:25: \"1 2\": the line must contain run, target and deviation"},
      {file("1 1 0.5\n1 1 1\n", "0 1 2 0", "1"), "l.rtl:25: \"1\": this target occurs twice in run 1"},
      {file(kBoth, "0 0 2 0", "4"), "the section has 2 runs, but the file states 4"},
      {file("", "0 0 2 0", "0"), "no readings"},
      {"X[mm],x[mm]\n1,2\n", "not a file of linear laser runs"},
      {std::string("a\0b", 3), "bytes of value 0"},
  };
  for (const auto& [text, says] : kBad) EXPECT_NE(read(text).find(says), std::string::npos) << read(text);
  EXPECT_NE(read(file(kBoth), "C").find("do not state the unit of the deviations"), std::string::npos);
}

}  // namespace
}  // namespace vernier::laser_file_test
