// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/workbench/files/sheets.h"

#include "tests/unit/workbench/rig.h"
#include "tools/fit/fit.h"
#include "tools/text/error.h"
#include "tools/workbench/files/rows.h"

namespace vernier::sheets_test {

using namespace vernier::fit;
using namespace vernier::importer;
using namespace vernier::model;
using namespace vernier::text;
using namespace vernier::workbench;
namespace {

using nlohmann::json;

const char* const kGerman = "X soll;Abweichung X\r\nmm;\xB5m\r\n0,00;1,5\r\n100,00;-2,5\r\n200,00;3,0\r\n";

struct Desk : testing::Test {
  Desk() : api(folder.project(), test::program(), "test", test::described()) {
    write_file(folder.in("m.xml"), test::kSmallMachine);
    write_file(folder.in("rows.csv"), test::kSmallRows);
    write_file(folder.in("german.csv"), kGerman);
  }
  json get(const std::string& path, const std::multimap<std::string, std::string>& query) {
    return json::parse(api.reply({"GET", path, query, ""}).body);
  }
  test::Folder folder;
  Api api;
};

TEST(Sheets, AMeasurementFileIsToldFromASpreadsheetByItsFirstLine) {
  EXPECT_TRUE(begins_as_measurement("# a remark\nX[mm],x[mm],run\n"));
  EXPECT_TRUE(begins_as_measurement("\xEF\xBB\xBFX[mm],x[mm]\n1,2,3\n"));  // its error is in another line
  EXPECT_FALSE(begins_as_measurement(kGerman));
  EXPECT_FALSE(begins_as_measurement("X (mm),x (mm)\n0,1\n"));
  EXPECT_FALSE(begins_as_measurement("X,x\n0,1\n")) << "without a unit";
  EXPECT_FALSE(begins_as_measurement("joint_a1 [deg],joint_a2 [deg],Tx [mm]\n1,2,3\n")) << "no reading";
  EXPECT_FALSE(begins_as_measurement(""));
}

TEST_F(Desk, AWorkbookHasNoLinesToShow) {
  write_file(folder.in("w.xlsx"), std::string("PK\x03\x04\0\0\n\0b", 9));
  EXPECT_TRUE(get("/api/lines", {{"name", "w.xlsx"}, {"line", "1"}})["lines"].empty());
  EXPECT_EQ(get("/api/lines", {{"name", "rows.csv"}, {"line", "1"}})["lines"].size(), 3u);
}

TEST_F(Desk, FilesOfAPrinterAreKnownByTheirContents) {
  write_file(folder.in("printer.cfg"),
             "[printer]\nkinematics: corexy\n#*# [bed_mesh default]\n#*# points =\n");
  write_file(folder.in("klippy.log"), "Stats 1: x\nprobe: at 30.000,30.000 bed will contact at z=0.14\n");
  write_file(folder.in("heightmap.csv"),
             "RepRapFirmware height map file v2 generated at 2026-01-01 10:00\naxis0\n");
  write_file(folder.in("console.txt"), "Bed X: 10.0 Y: 10.0 Z: 0.1\n");
  for (const char* name : {"printer.cfg", "klippy.log", "heightmap.csv", "console.txt"})
    EXPECT_EQ(get("/api/kind", {{"name", name}})["kind"], "printer") << name;
  EXPECT_EQ(get("/api/kind", {{"name", "rows.csv"}})["kind"], "measurement");
  EXPECT_EQ(get("/api/kind", {{"name", "german.csv"}})["kind"], "sheet");
}

TEST(Sheets, APreviewIsWhatTheImportDoes) {
  const auto preview = sheet_preview(kGerman, "german.csv", {});
  EXPECT_EQ(preview["decimal"], "comma");
  EXPECT_EQ(preview["separator"], "semicolon");
  EXPECT_EQ(preview["n_rows"], 3);
  EXPECT_TRUE(preview["message"].is_null()) << preview["message"];
  EXPECT_EQ(preview["columns"][1]["use"], "deviation");
  EXPECT_NE(preview["csv"].dump().find("99.9975"), std::string::npos) << preview["csv"];
  const auto open = sheet_preview("Pos;Anzeige\n0,0;1,5\n10,0;2,5\n", "dial.csv", {});
  EXPECT_NE(open["message"].get<std::string>().find("no column of the table is a reading"),
            std::string::npos);
  SheetWords words;
  words.columns = {"X[mm]=1"};
  words.deviations = {"X[um]=2"};
  EXPECT_TRUE(sheet_preview("Pos;Anzeige\n0,0;1,5\n10,0;2,5\n", "dial.csv", words)["message"].is_null());
}

TEST(Sheets, ADoubtfulUnitIsConfirmedByTheMeaningOfItsColumn) {
  const std::string table = "Soll X [mm];Abw. X [mm]\n0;0,0\n100;3,2\n200;5,4\n300;9,1\n400;13,9\n";
  const auto refused = sheet_preview(table, "t.csv", {});
  EXPECT_NE(refused["message"].get<std::string>().find("half of the deviations"), std::string::npos);
  EXPECT_FALSE(refused["columns"][0].contains("doubt"));
  const auto& column = refused["columns"][1];
  EXPECT_NE(column["doubt"].get<std::string>().find("half of the deviations"), std::string::npos);
  // The button of the page states what the column already is.
  SheetWords words;
  words.deviations = {column["name"].get<std::string>() + "[" + column["unit"].get<std::string>() + "]=2"};
  const auto confirmed = sheet_preview(table, "t.csv", words);
  EXPECT_TRUE(confirmed["message"].is_null()) << confirmed["message"];
  EXPECT_FALSE(confirmed["columns"][1].contains("doubt"));
}

TEST_F(Desk, PointsOfDistancesAreAskedForAndTaken) {
  write_file(folder.in("square.csv"), "Strecke;Soll;Ist\nAB;60;60,1\nAC;100;99,9\n");
  write_file(
      folder.in("xy.xml"),
      "<machine name=\"m\"><variables><machineaxes><X min=\"0\" max=\"300\"/><Y min=\"0\" max=\"300\"/>"
      "</machineaxes></variables><transforms><sixdof n=\"1\" X=\"X\" Y=\"Y\"/></transforms></machine>");
  const auto ask = [&](json request) {
    request["name"] = "square.csv";
    return json::parse(api.reply({"POST", "/api/sheet", {}, request.dump()}).body);
  };
  const json open = ask({{"machine", "xy.xml"}});
  EXPECT_EQ(open["points"]["names"], (json{"A", "B", "C"})) << open;
  EXPECT_EQ(open["points"]["missing"], open["points"]["names"]);
  EXPECT_EQ(open["points"]["axes"][1], (json{{"name", "Y"}, {"unit", "mm"}}));
  EXPECT_NE(open["message"].get<std::string>().find("--point \"A=X,Y\""), std::string::npos) << open;
  EXPECT_EQ(open["columns"].dump().find("doubt"), std::string::npos);
  const json read = ask({{"machine", "xy.xml"}, {"point", {"A=0,0", "B=60,0", "C=60,80"}}});
  EXPECT_TRUE(read["message"].is_null()) << read;
  EXPECT_EQ(read["n_rows"], 5);
  // The table stays that of the file.
  EXPECT_EQ(read["columns"].size(), 3u);
  EXPECT_EQ(read["rows"][1][0], "A-C");
  // A list needs the axes of a machine; a tolerance is a number of the request.
  write_file(folder.in("list.csv"), "Punkt;X [mm];Y [mm]\nA;0;0\nB;61;0\nC;60;80\n");
  EXPECT_NE(ask({{"nominal", "list.csv"}})["message"].get<std::string>().find("choose a machine"),
            std::string::npos);
  EXPECT_FALSE(ask({{"machine", "xy.xml"}, {"nominal", "list.csv"}})["message"].is_null());
  EXPECT_TRUE(ask({{"machine", "xy.xml"}, {"nominal", "list.csv"}, {"tolerance", 2}})["message"].is_null());
}

TEST_F(Desk, TheLogOfARobotHasItsJointsInTheOrderOfTheMachine) {
  write_file(folder.in("arm.xml"),
             "<machine name=\"m\"><variables><machineaxes><turret rotary=\"true\"/><elbow rotary=\"true\"/>"
             "</machineaxes></variables><transforms><sixdof n=\"1\" rZ=\"turret\"/>"
             "<sixdof n=\"2\" X=\"300\" rZ=\"elbow\"/><sixdof n=\"3\" X=\"200\"/></transforms></machine>");
  const auto ask = [&](const std::string& log, const json& column) {
    write_file(folder.in("log.csv"), log);
    const json request{{"name", "log.csv"}, {"machine", "arm.xml"}, {"column", column}};
    return json::parse(api.reply({"POST", "/api/sheet", {}, request.dump()}).body);
  };
  const std::string rows = "P1;0;90;300;200;7\nP2;90;0.5;3;499;7\nP3;30;80;195;333;9\n";
  const json open = ask("Name;A1;A2;X;Y;Z\n" + rows, nullptr);
  EXPECT_EQ(open["robot"].dump(),
            R"([{"column":1,"name":"turret","unit":"deg"},)"
            R"({"column":2,"name":"elbow","unit":"deg"},)"
            R"({"column":3,"name":"x","unit":"mm"},{"column":4,"name":"y","unit":"mm"},)"
            R"({"column":5,"name":"z","unit":"mm"}])");
  EXPECT_NE(open["message"].get<std::string>().find("press \"This assignment is right\""), std::string::npos);
  // Joints that have their names are shown too, beside the point.
  const json named = ask("Name;turret [deg];elbow [deg];X;Y;Z\n" + rows, nullptr);
  EXPECT_EQ(named["robot"], open["robot"]);
  // The button states what it shows.
  json words = json::array();
  for (const json& one : open["robot"])
    words.push_back(one["name"].get<std::string>() + "[" + one["unit"].get<std::string>() +
                    "]=" + std::to_string(one["column"].get<int>() + 1));
  const json read = ask("Name;A1;A2;X;Y;Z\n" + rows, words);
  EXPECT_TRUE(read["message"].is_null()) << read["message"];
  EXPECT_FALSE(read.contains("robot"));
  // Joints alone: nothing to assign, and the way to use them.
  const json joints = ask("Name;A1;A2\nP1;0;90\nP2;90;0.5\nP3;30;80\n", nullptr);
  EXPECT_TRUE(joints["robot"].empty());
  EXPECT_NE(joints["message"].get<std::string>().find("in the field \"nominal\""), std::string::npos);
}

TEST(Sheets, WordsOfARequestAreTextsAndLists) {
  EXPECT_EQ(sheet_words(json{{"column", {"X[mm]=1"}}, {"skip", 2}}).skip, 2u);
  const importer::SheetWords words = sheet_words(json{{"fill", {"T"}}, {"one-motion", true}});
  EXPECT_EQ(words.fill, std::vector<std::string>{"T"});
  EXPECT_TRUE(words.one_motion);
  EXPECT_FALSE(sheet_words(json::object()).one_motion);
  EXPECT_EQ(sheet_words(json{{"directions", "from-order"}}).directions, "from-order");
  EXPECT_THROW(sheet_words(json{{"column", "X[mm]=1"}}), InputError);
  EXPECT_THROW(sheet_words(json{{"unit", 3}}), InputError);
  EXPECT_THROW(sheet_words(json{{"set", {1}}}), InputError);
}

TEST_F(Desk, ASpreadsheetIsKeptAndABrokenMeasurementIsNot) {
  EXPECT_EQ(get("/api/kind", {{"name", "german.csv"}})["kind"], "sheet");
  EXPECT_EQ(get("/api/kind", {{"name", "rows.csv"}})["kind"], "measurement");
  EXPECT_EQ(api.reply({"PUT", "/api/file", {{"name", "other.csv"}}, kGerman}).status, 200);
  EXPECT_EQ(api.reply({"PUT", "/api/file", {{"name", "bad.csv"}}, "X[mm],x[mm]\n1,2\n3,4,5\n"}).status, 422);
}

TEST_F(Desk, TheSheetIsThatOfTheCommand) {
  const json sheet = get("/api/safety", {{"machine", "m.xml"}});
  EXPECT_EQ(sheet["rules"].size(), 12u);
  EXPECT_TRUE(sheet["ok"].get<bool>()) << sheet["refusal"];
  EXPECT_TRUE(sheet["rules"][3]["value"].is_null()) << "no fit wrote this file";
}

TEST_F(Desk, DatumIsFittedBeforeRowsAreShown) {
  // The instrument stands 5 mm off; the machine lets its set-up be fitted.
  std::string machine = test::kSmallMachine;
  machine.insert(machine.find("</static>"),
                 "<BaseShift X=\"0\" Y=\"0\" Z=\"0\" rX=\"0\" rY=\"0\" rZ=\"0\"/>");
  write_file(folder.in("b.xml"), machine);
  write_file(folder.in("off.csv"),
             "X[mm],Y[mm],x[mm],y[mm]\n0,0,5.001,0\n50,10,55,10.001\n100,60,104.999,60\n0,100,5,99.999\n");
  const Project project(folder.project());
  RowCache rows(project);
  const auto largest = [&](bool datum) {
    const auto loaded = rows.get("b.xml", {"off.csv"}, datum);
    return residuals(loaded->machine, loaded->measurement).cwiseAbs().maxCoeff();
  };
  EXPECT_NEAR(largest(false), 5, 0.01);
  EXPECT_LT(largest(true), 0.003);
}

TEST_F(Desk, EveryFileHasItsOwnSetUp) {
  std::string machine = test::kSmallMachine;
  machine.insert(machine.find("</static>"),
                 "<BaseShift X=\"0\" Y=\"0\" Z=\"0\" rX=\"0\" rY=\"0\" rZ=\"0\"/>");
  write_file(folder.in("b.xml"), machine);
  write_file(folder.in("off.csv"),
             "X[mm],Y[mm],x[mm],y[mm]\n0,0,5.001,0\n50,10,55,10.001\n100,60,104.999,60\n0,100,5,99.999\n");
  // The second instrument is 1.5 m from the first.
  write_file(folder.in("far.csv"),
             "X[mm],Y[mm],x[mm],y[mm]\n0,0,1500.001,0\n50,10,1550,10.001\n100,60,1599.999,60\n"
             "0,100,1500,99.999\n");
  const Project project(folder.project());
  RowCache rows(project);
  const auto loaded = rows.get("b.xml", {"off.csv", "far.csv"}, true);
  EXPECT_LT(residuals(loaded->machine, loaded->measurement).cwiseAbs().maxCoeff(), 0.003);
}

TEST_F(Desk, RowsMeasuredWithACorrectionFindItsImageInTheFolder) {
  const std::string in = "cd '" + folder.project() + "' && '" + test::program() + "' ";
  std::string machine = test::kSmallMachine;
  machine.replace(machine.find("value=\"0\""), 9, "value=\"1e-4\"");
  write_file(folder.in("run.xml"), machine);
  ASSERT_EQ(std::system((in + "compile run.xml -o image >out.txt 2>&1").c_str()), 0)
      << read_file(folder.in("out.txt"));
  const std::string fingerprint = json::parse(read_file(folder.in("image/bound.json")))["fingerprint"];
  // With the correction on X stands 1e-4 Y short of what was commanded, and the reading is right.
  write_file(folder.in("on.csv"), "X[mm],Y[mm],x[mm],corrected\n10,100,10.0," + fingerprint +
                                      "\n20,50,20.0," + fingerprint + "\n");
  const Project project(folder.project());
  RowCache rows(project);
  const auto loaded = rows.get("run.xml", {"on.csv"}, false);
  EXPECT_LT(residuals(loaded->machine, loaded->measurement).cwiseAbs().maxCoeff(), 1e-5);
  const std::string blob = rows_blob(*loaded);
  EXPECT_NE(blob.find("\"corrected\":true"), std::string::npos);
  EXPECT_EQ(std::system((in + "compare run.xml on.csv --images=. >out.txt 2>&1").c_str()), 0)
      << read_file(folder.in("out.txt"));
}

TEST_F(Desk, ParametersSayHowWellTheyAreKnown) {
  const Project project(folder.project());
  RowCache cache(project);
  const json before = parameters_json(*cache.get("m.xml", {"rows.csv"}, false));
  ASSERT_EQ(before[0]["name"], "k");
  EXPECT_TRUE(before[0]["std"].is_null());
  const std::string in = "cd '" + folder.project() + "' && '" + test::program() + "' ";
  ASSERT_EQ(std::system((in + "fit m.xml rows.csv -o f.xml --json f.json >out.txt 2>&1").c_str()), 0);
  const json fitted = json::parse(read_file(folder.in("f.json")))["parameters"][0];
  const json after = parameters_json(*cache.get("f.xml", {"rows.csv"}, false))[0];
  EXPECT_EQ(after["from"], fitted["from"]);
  // The file keeps the factor as 4-byte numbers.
  EXPECT_NEAR(after["std"].get<double>(), fitted["std"].get<double>(), 1e-6 * fitted["std"].get<double>());
  ASSERT_EQ(std::system((in + "set f.xml k=0.001 -o s.xml >out.txt 2>&1").c_str()), 0);
  EXPECT_TRUE(parameters_json(*cache.get("s.xml", {"rows.csv"}, false))[0]["std"].is_null())
      << "changed by hand since";
}

}  // namespace
}  // namespace vernier::sheets_test
