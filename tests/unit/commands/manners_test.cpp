// SPDX-License-Identifier: GPL-3.0-or-later
// What the program answers to those who are still learning it.
#include <gtest/gtest.h>
#include <sys/wait.h>
#include <unistd.h>
#include <nlohmann/json.hpp>

#include <fmt/format.h>
#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <random>
#include <sstream>

#include "tools/text/files.h"
#include "tools/text/similar.h"

namespace vernier::manners_test {

using namespace vernier::text;
namespace {

namespace fs = std::filesystem;

class Manners : public testing::Test {
 protected:
  Manners() {
    fs::create_directories(folder_);
    write_file(folder_ + "/m.xml",
               "<machine><variables><static><k value=\"0\" nominal=\"0\" "
               "unit=\"inch\"/></static><machineaxes><X min=\"0\" "
               "max=\"600\"/><Q min=\"0\" max=\"9\"/></machineaxes></variables><transforms><sixdof "
               "X=\"X+k*X\"/></transforms></machine>");
    write_file(folder_ + "/rows.csv", "X[mm],Q[mm],x[mm]\n0,0,0\n100,1,100.01\n300,2,300.02\n");
    write_file(folder_ + "/sheet.csv", "X (mm);Q (mm);x (mm)\n0,5;0;0,5\n100;1;100,01\n");
  }
  ~Manners() override { fs::remove_all(folder_); }

  int run(const std::string& line) {
    const std::string command =
        "cd '" + folder_ + "' && PATH=" VERNIER_BIN_DIR ":$PATH && { " + line + "; } >out.txt 2>&1";
    const int status = std::system(command.c_str());
    said_ = read_file(folder_ + "/out.txt");
    return WIFEXITED(status) ? WEXITSTATUS(status) : -1;
  }
  bool said(const std::string& part) const { return said_.find(part) != std::string::npos; }

  const std::string folder_ = testing::TempDir() + "manners_" + std::to_string(getpid());
  std::string said_;
};

TEST_F(Manners, MistypedCommandIsNamedWithTheOneMeant) {
  EXPECT_EQ(run("vernier fti m.xml rows.csv"), 1);
  EXPECT_TRUE(said("\"fti\" is not a command of vernier; did you mean vernier fit?")) << said_;
  EXPECT_EQ(run("vernier import tabel x"), 1);
  EXPECT_TRUE(said("did you mean vernier import table?")) << said_;
  EXPECT_EQ(run("vernier frobnicate"), 1);
  EXPECT_TRUE(said("\"frobnicate\" is not a command of vernier") && said("vernier help")) << said_;
  EXPECT_EQ(run("vernier fit m.xml rows.csv --outptu x.xml"), 1);
  EXPECT_TRUE(said("\"--outptu\": no option of this command; did you mean --output?")) << said_;
}

TEST_F(Manners, WordBehindOneDashIsNamedWithTheOneMeant) {
  EXPECT_EQ(run("vernier fit m.xml rows.csv -out z.xml"), 1);
  EXPECT_TRUE(said("\"-out\": did you mean --output?")) << said_;
  EXPECT_EQ(run("vernier fit m.xml rows.csv -jsn=r.json"), 1);
  EXPECT_TRUE(said("\"-jsn=r.json\": did you mean --json?")) << said_;
  EXPECT_EQ(run("vernier import table sheet.csv -decimal comma -o a.csv"), 1);
  EXPECT_TRUE(said("\"-decimal\": did you mean --decimal?")) << said_;
  EXPECT_EQ(run("vernier fit m.xml rows.csv -qqq"), 1);
  EXPECT_TRUE(said("\"-qqq\": this command has no such option; --help lists the options")) << said_;
  EXPECT_EQ(run("vernier import table sheet.csv -oread.csv --set -note=a"), 1);  // a value of --set
  EXPECT_FALSE(said("did you mean")) << said_;
  EXPECT_EQ(run("vernier import table sheet.csv -oread.csv"), 0) << said_;
  EXPECT_TRUE(fs::exists(folder_ + "/read.csv"));
}

TEST_F(Manners, AxisThatStoodStillIsAddedAsTheMessageTells) {
  write_file(folder_ + "/one.csv", "X[mm],x[mm]\n0,0\n100,100.01\n300,300.02\n");
  EXPECT_EQ(run("vernier fit m.xml one.csv -o f.xml"), 1);
  ASSERT_TRUE(said("vernier import table one.csv --set \"Q[mm]=POSITION\" -o NEW.csv")) << said_;
  EXPECT_EQ(
      run("vernier import table one.csv --set \"Q[mm]=7\" -o NEW.csv && vernier fit m.xml NEW.csv -o f.xml"),
      0)
      << said_;
}

TEST_F(Manners, CheckStatesItsVerdictAndTheFileThatItDoesNotWrite) {
  write_file(
      folder_ + "/c.xml",
      "<machine><variables><static><k value=\"0\" nominal=\"0\" unit=\"um/m\"/><BaseShift X=\"0\" Y=\"0\" "
      "Z=\"0\" rX=\"0\" rY=\"0\" rZ=\"0\"/></static><machineaxes><X min=\"0\" max=\"600\"/></machineaxes>"
      "</variables><transforms><sixdof X=\"X+k*X/1000000\"/></transforms></machine>");
  for (const auto& [name, reversal_mm] : {std::pair{"a.csv", 0.0}, {"b.csv", 0.0}, {"gap.csv", 0.04}}) {
    std::string rows = "X[mm],dirX,x[mm],u[um]\n";
    for (int i = 0; i < 40; ++i)  // readings scattered by 1 um, in a fixed order
      rows += std::to_string(15 * i) + (i % 4 < 2 ? ",1," : ",-1,") +
              std::to_string(15 * i + (i % 4 < 2 ? 0 : reversal_mm) + 0.001 * ((7 * i) % 5 - 2)) + ",1.4\n";
    write_file(folder_ + "/" + name, rows);
  }
  ASSERT_EQ(run("vernier fit c.xml a.csv -o f.xml"), 0) << said_;
  EXPECT_EQ(run("vernier check f.xml b.csv -o right.xml"), 0);
  EXPECT_TRUE(said("verdict: valid") && said("right.xml is not written: no parameter of the machine changed"))
      << said_;
  EXPECT_EQ(run("vernier check f.xml gap.csv -o right.xml"), 2);
  EXPECT_TRUE(said("verdict: changed. ") &&
              said("vernier: verdict changed, but no machine file is written: ") &&
              said("is no free parameter of f.xml; diagnose a longer measurement, and fit"))
      << said_;
  EXPECT_FALSE(fs::exists(folder_ + "/right.xml"));
}

/// A day of a machine had 86 million cycles, which took half a minute.
TEST_F(Manners, LongMeasurementIsCorrectedInASlowerLoop) {
  write_file(folder_ + "/a.xml",
             "<machine><variables><static><k value=\"0\"/></static><machineaxes>"
             "<X min=\"0\" max=\"600\" maxcorrection=\"0.5\" maxslew=\"1\"/></machineaxes></variables>"
             "<transforms><sixdof X=\"X+k*X\"/></transforms></machine>");
  const auto survey = [](int seconds_apart) {
    std::string rows = "t[s],X[mm],x[mm],u[um],role\n";
    for (int i = 0; i < 49; ++i) {  // 300 um/m, readings scattered by 0.5 um, in a fixed order
      const int x = 37 * i % 49 * 12;
      rows += std::to_string(seconds_apart * i) + "," + std::to_string(x) + "," +
              std::to_string(1.0003 * x + 0.0002 * (7 * i % 5 - 2)) + ",0.5," +
              (i % 4 == 3 ? "check" : "fit") + "\n";
    }
    return rows;
  };
  for (const auto& [apart, rate] :
       std::vector<std::pair<int, std::string>>{{60, "1 kHz"}, {1800, "200 Hz"}}) {
    write_file(folder_ + "/a.csv", survey(apart));
    EXPECT_EQ(run("vernier improve a.xml a.csv -o out --yes --json r.json"), 0) << said_;
    EXPECT_TRUE(said("\n" + rate + " loop, ")) << said_;
    const nlohmann::json loop = nlohmann::json::parse(read_file(folder_ + "/r.json"))["simulation"];
    EXPECT_LE(loop["ticks"].get<double>(), 2e7);
    EXPECT_GT(loop["rms_before_um"].get<double>(), 50);
    EXPECT_LT(loop["rms_after_um"].get<double>(), 0.5) << "a loop of " << rate;
  }
  write_file(folder_ + "/a.csv", survey(40'000));
  EXPECT_EQ(run("vernier improve a.xml a.csv -o out --yes"), 0) << said_;
  EXPECT_TRUE(said("the measurement lasts longer than eleven days; divide it into shorter files")) << said_;
}

TEST_F(Manners, RecordsInAnglesOnlyHaveFiguresInAngles) {
  write_file(folder_ + "/a.xml",
             "<machine><variables><static><BaseShift X=\"0\" Y=\"0\" Z=\"0\" rX=\"0\" rY=\"0\" "
             "rZ=\"0\"/></static><machineaxes><X min=\"0\" max=\"600\"/></machineaxes></variables>"
             "<transforms><sixdof X=\"X\"/></transforms></machine>");
  std::string rows = "X[mm],ry[arcsec],u[arcsec],role\n";
  for (int i = 0; i < 60; ++i)  // pitch of 8 arcsec, readings scattered by 0.3, in a fixed order
    rows += std::to_string(10 * i) + "," +
            std::to_string(8e-6 * (10 * i - 300) * (10 * i - 300) + 0.2 * ((7 * i) % 5 - 2)) + ",0.3," +
            (i % 4 == 3 ? "check" : "fit") + "\n";
  write_file(folder_ + "/a.csv", rows);
  EXPECT_EQ(run("vernier improve a.xml a.csv -o out --yes --json r.json"), 0) << said_;
  EXPECT_TRUE(said("the given model after a fit: rms of fit rows ") && said("urad") && !said("rows -"))
      << said_;
  const std::string json = read_file(folder_ + "/r.json");
  for (const char* key : {"rms_before_urad", "rms_urad", "check_rms_urad", "noise_urad"})
    EXPECT_EQ(json.find(std::string("\"") + key + "\": null"), std::string::npos) << key;
  for (const char* command : {"fit a.xml a.csv -o f.xml", "compare a.xml a.csv", "diagnose a.xml a.csv"}) {
    EXPECT_EQ(run(std::string("vernier ") + command), 0) << said_;
    EXPECT_FALSE(said("rows    -") || said("noise           -") || said(" -            -")) << said_;
  }
}

TEST_F(Manners, FitOfFewReadingsIsReadAgain) {
  // Fewer readings than parameters: nothing is left over that shows a noise.
  ASSERT_EQ(run("vernier new gantry --axis X:0:1200 --axis Y:0:800 --axis Z:-150:0 -o g.xml"), 0) << said_;
  write_file(folder_ + "/g.csv",
             "X[mm],Y[mm],Z[mm],x[mm],u[um]\n0,400,-50,0.001,0.5\n300,400,-50,300.004,0.5\n"
             "600,400,-50,600.009,0.5\n900,400,-50,900.011,0.5\n");
  ASSERT_EQ(run("vernier fit g.xml g.csv -o gf.xml"), 0) << said_;
  EXPECT_EQ(run("vernier compare gf.xml g.csv"), 0) << said_;
}

TEST_F(Manners, RobotIsCorrectedAsTheMessageTells) {
  ASSERT_EQ(run("vernier new robot -o r.xml && vernier set r.xml th1=0.01 -o e.xml"), 0) << said_;
  write_file(folder_ + "/p.csv", "J1[deg],J2[deg],J3[deg],J4[deg],J5[deg],J6[deg]\n10,-80,80,10,80,10\n");
  EXPECT_EQ(run("vernier correct e.xml p.csv -o c.csv"), 1);
  EXPECT_TRUE(said("no linear axis; correct with all its axes: --rotary")) << said_;
  EXPECT_EQ(run("vernier correct e.xml p.csv -o c.csv --rotary"), 0);
  EXPECT_TRUE(said("corrections up to 0.01 deg;")) << said_;
}

TEST_F(Manners, NumbersOfOptionsAreFiniteDecimalsAndCountsCount) {
  for (const char* line :
       {"vernier correct m.xml rows.csv -o c.csv --deviation nan",
        "vernier fit m.xml rows.csv --loss-scale 0x10", "vernier fit m.xml rows.csv --loss-scale inf"}) {
    EXPECT_EQ(run(line), 1) << line;
    EXPECT_TRUE(said("is no decimal number") || said("inf is not a positive number"))
        << line << ": " << said_;
  }
  EXPECT_EQ(run("vernier simulate m.xml --seed -1"), 1);
  EXPECT_TRUE(said("\"-1\" is no count")) << said_;
}

TEST_F(Manners, WithoutACommandTheFirstHourIsShown) {
  EXPECT_EQ(run("vernier"), 0);
  for (const char* command : {"new", "import table", "fit", "diagnose", "evaluate iso230-2", "workbench"})
    EXPECT_TRUE(said(std::string("vernier ") + command)) << command << "\n" << said_;
  EXPECT_TRUE(said("vernier --help")) << said_;
  EXPECT_LT(said_.size(), 1500U);
  // The commands of the list work as printed.
  const std::size_t at = said_.find("vernier new "), end = said_.find('\n', at);
  EXPECT_EQ(run(said_.substr(at, end - at)), 0) << said_;
}

TEST_F(Manners, HelpIsACommandToo) {
  EXPECT_EQ(run("vernier help"), 0);
  const std::string all = said_;
  EXPECT_EQ(run("vernier --help"), 0);
  EXPECT_EQ(said_, all);
  EXPECT_EQ(run("vernier help fit"), 0);
  EXPECT_TRUE(said("Usage: vernier fit")) << said_;
  EXPECT_EQ(run("vernier help import table"), 0);
  EXPECT_TRUE(said("--preview")) << said_;
  EXPECT_EQ(run("vernier help fti"), 1);
}

TEST_F(Manners, HelpFitsEightyColumns) {
  ASSERT_EQ(run("vernier help"), 0);
  std::vector<std::string> commands = {""};
  std::istringstream list(said_.substr(said_.find("\nMeasure:")));
  for (std::string line; std::getline(list, line);)
    if (line.size() > 3 && line.starts_with("  ") && line[2] != ' ')
      commands.push_back(line.substr(2, line.find(' ', 2) - 2));
  EXPECT_GT(commands.size(), 30u);
  commands.insert(commands.end(), {"import table", "import ballbar", "import ballbar-trace", "import tracker",
                                   "import probe", "import laser", "part s-shape"});
  for (const std::string& command : commands) {
    EXPECT_EQ(run("vernier " + command + " --help"), 0) << command;
    std::istringstream help(said_);
    for (std::string line; std::getline(help, line);) {
      std::size_t letters = 0;
      for (const char c : line) letters += (static_cast<unsigned char>(c) & 0xC0) != 0x80 ? 1 : 0;
      EXPECT_LE(letters, 80u) << command << ": " << line;
    }
  }
}

TEST_F(Manners, SwappedFilesAreRecognised) {
  EXPECT_EQ(run("vernier fit rows.csv m.xml -o f.xml"), 1);
  EXPECT_TRUE(
      said("rows.csv: this is a measurement file, but the machine file (XML) is expected here; did you mean "
           "vernier "
           "fit m.xml rows.csv -o f.xml?"))
      << said_;
  EXPECT_EQ(run("vernier compare m.xml m.xml"), 1);
  EXPECT_TRUE(said("this is a machine file, but a measurement file (CSV) is expected here")) << said_;
}

TEST_F(Manners, SpreadsheetIsRefusedWithTheCommandThatReadsIt) {
  for (const char* command :
       {"fit m.xml sheet.csv -o f.xml", "compare m.xml sheet.csv", "diagnose m.xml sheet.csv"}) {
    EXPECT_EQ(run(std::string("vernier ") + command), 1);
    EXPECT_TRUE(said("this command reads it: vernier import table sheet.csv -o sheet_read.csv")) << said_;
  }
  EXPECT_EQ(run("vernier import table sheet.csv -o sheet_read.csv && vernier compare m.xml sheet_read.csv"),
            0)
      << said_;
}

TEST_F(Manners, ImportThatFailsSaysWhatItUnderstood) {
  write_file(folder_ + "/odd.csv", "Soll;Ist\n0;0,1\n5;5,1\n");
  EXPECT_EQ(run("vernier import table odd.csv -o odd_read.csv"), 1);
  EXPECT_TRUE(said("columns separated by semicolon, decimal comma") &&
              said("no column of the table is a reading") &&
              said("--column \"X[mm]=Soll\" --column \"x[mm]=Ist\" for a measured position"))
      << said_;
  EXPECT_FALSE(said("this command reads it")) << said_;
  EXPECT_EQ(run("vernier import table odd.csv -o odd_read.csv --column 'X[mm]=Soll' --column 'x[mm]=Ist'"), 0)
      << said_;
  EXPECT_EQ(read_file(folder_ + "/odd_read.csv"), "X[mm],x[mm]\n0,0.1\n5,5.1\n");
}

TEST_F(Manners, UnknownUnitAndUnusedAxisAreWarnedOf) {
  run("vernier compare m.xml rows.csv");
  EXPECT_TRUE(said("\"inch\": unknown unit, of k -- did you mean in?")) << said_;
  EXPECT_TRUE(said("\"Q\": no transform uses this axis")) << said_;
}

TEST_F(Manners, CyclicErrorOfASlideAsksForItsPeriod) {
  EXPECT_EQ(run("vernier add cyclic-error:axis=X m.xml -o new.xml"), 1);
  EXPECT_TRUE(said("start.p is missing: the period in mm (pitch of the screw")) << said_;
  EXPECT_FALSE(fs::exists(folder_ + "/new.xml"));
  EXPECT_EQ(run("vernier add cyclic-error:axis=X,start.p=5 m.xml -o new.xml"), 0) << said_;
  EXPECT_NE(read_file(folder_ + "/new.xml").find("360*X/"), std::string::npos);
}

TEST_F(Manners, LintExitsByWhetherTheFilesAreOfUse) {
  EXPECT_EQ(run("vernier lint m.xml rows.csv"), 0) << said_;
  EXPECT_EQ(run("vernier lint m.xml sheet.csv --json lint.json"), 1) << said_;
  EXPECT_NE(read_file(folder_ + "/lint.json").find("\"weight\": \"error\""), std::string::npos);
}

/// Even targets do not distinguish the periods of a cyclic error; the backlash is certain.
TEST_F(Manners, ImproveAddsTheCertainEffectBeforeAnAmbiguousPeriod) {
  write_file(
      folder_ + "/axis.xml",
      "<machine name=\"axis\"><variables><static><c value=\"0\" unit=\"mm\"/></static><machineaxes>"
      "<X rotary=\"false\" min=\"0\" max=\"500\"/></machineaxes></variables><transforms branch=\"tool\">"
      "<sixdof n=\"1\" X=\"X+c\"/></transforms></machine>");
  std::mt19937_64 random(20261128);
  std::normal_distribution<double> noise(0, 0.8);
  std::string rows = "X[mm],x[mm],dirX,u[um],run,role\n";
  for (int run = 0; run < 5; ++run)
    for (const int sense : {1, -1})
      for (int k = 0; k <= 20; ++k) {
        const double x = 25 * (sense > 0 ? k : 20 - k);
        const double error_um =
            4.5 * sense + 3 * std::sin(2 * 3.14159265358979 * x / 63 + 0.4) + noise(random);
        rows += fmt::format("{},{:.6f},{},0.8,r{},{}\n", x, x + 1e-3 * error_um, sense, run,
                            run < 4 ? "fit" : "check");
      }
  write_file(folder_ + "/axis.csv", rows);
  ASSERT_EQ(run("vernier improve axis.xml axis.csv -o better --yes"), 0) << said_;
  EXPECT_TRUE(said("verdict: ambiguous") && said("+ X carriage: backlash") && said("no effect is added"))
      << said_;
  EXPECT_FALSE(said("+ X carriage: cyclic error: rms")) << said_;
  // The user has a machine to export, and the command that decides for one cause.
  EXPECT_TRUE(
      said("The file better/1_backlash.xml is the machine fitted without these causes, for vernier export."))
      << said_;
  EXPECT_TRUE(said("decide for one cause: vernier add 'cyclic-error:axis=X")) << said_;
  // No reading determines the period: the command names none of those that fit.
  EXPECT_TRUE(said("start.p=PERIOD' better/1_backlash.xml") &&
              said("a turn of a gear, in mm: the readings do not distinguish the periods "))
      << said_;
}

TEST_F(Manners, CorrectWritesNothingBeyondMaxcorrection) {
  const auto machine = [](const char* most) {
    return fmt::format(
        R"(<machine name="m"><variables><static><k value="0.001" nominal="0" unit="1"/></static><machineaxes>)"
        R"(<X rotary="false" min="0" max="300" maxcorrection="{}"/></machineaxes></variables>)"
        R"(<transforms branch="tool"><sixdof n="1" X="X+k*X"/></transforms></machine>)",
        most);
  };
  write_file(folder_ + "/far.xml", machine("0.25"));
  write_file(folder_ + "/near.xml", machine("0.35"));
  write_file(folder_ + "/list.csv", "X[mm]\n0\n300\n");
  EXPECT_EQ(run("vernier correct far.xml list.csv -o far.csv"), 2);
  EXPECT_TRUE(said(
      "the correction of X is up to 0.2997 mm, and its maxcorrection in the machine file permits 0.25 mm"))
      << said_;
  EXPECT_TRUE(said("largest in list.csv:3; 1 of 2 positions exceed a maxcorrection (line 3)")) << said_;
  EXPECT_FALSE(fs::exists(folder_ + "/far.csv"));
  EXPECT_EQ(run("vernier correct near.xml list.csv -o near.csv"), 0) << said_;
  // Backwards nothing moves.
  EXPECT_EQ(run("vernier correct far.xml near.csv --back -o back.csv"), 0) << said_;
}

TEST_F(Manners, ShellCompletesCommandsKindsOptionsAndFiles) {
  const auto completed = [&](const std::string& words) {
    // As bash calls it: the words typed so far, the cursor at the end of the last.
    run("vernier completion bash > c.sh && bash -c 'source ./c.sh; COMP_WORDS=(vernier " + words +
        "); COMP_CWORD=$((${#COMP_WORDS[@]} - 1)); _vernier; echo \"${COMPREPLY[@]}\"'");
    return said_;
  };
  EXPECT_EQ(completed("comp"), "compare compile completion\n");
  EXPECT_EQ(completed("import tab"), "table\n");
  EXPECT_EQ(completed("import table --dec"), "--decimal\n");
  EXPECT_EQ(completed("fit --resid"), "--residuals\n");
  EXPECT_EQ(completed("fit m."), "m.xml\n");
  // Files that the command reads; behind an option any file.
  EXPECT_EQ(run("touch kind.xml kind.csv kind.png kind.ngc && mkdir kind"), 0) << said_;
  EXPECT_EQ(completed("fit ki"), "kind.xml kind.csv kind\n");
  EXPECT_EQ(completed("lint ki"), completed("fit m.xml --json ki"));
  EXPECT_NE(said_.find("kind.png"), std::string::npos) << said_;
  EXPECT_EQ(completed("map ki"), "kind.xml kind\n");
  EXPECT_EQ(run("vernier completion zsh && vernier completion fish"), 0);
  EXPECT_TRUE(said("#compdef vernier") && said("-a diagnose -d")) << said_;
  EXPECT_EQ(run("vernier completion tcsh"), 1);
}

TEST(WordMeant, IsTheNearestThatIsNearEnough) {
  const std::vector<std::string> words = {"fit", "plan", "pose", "part", "compare", "compile", "diagnose"};
  EXPECT_EQ(word_meant("fti", words), "fit");
  EXPECT_EQ(word_meant("diagnos", words), "diagnose");
  EXPECT_EQ(word_meant("compair", words), "compare");
  EXPECT_EQ(word_meant("dia", words), "diagnose");
  EXPECT_EQ(word_meant("xyz", words), std::nullopt);
  EXPECT_EQ(letters_apart("flaw", "lawn"), 2u);
  EXPECT_EQ(letters_apart("ab", "ba"), 1u);
}

}  // namespace
}  // namespace vernier::manners_test
