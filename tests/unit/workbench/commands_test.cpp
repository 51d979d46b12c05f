// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/workbench/runs/commands.h"

#include <algorithm>

#include "tests/unit/workbench/rig.h"
#include "tools/text/error.h"
#include "tools/text/process.h"

namespace vernier::commands_test {

using namespace vernier::text;
using namespace vernier::workbench;
namespace {

using nlohmann::json;

struct Rig {
  Rig() {
    write_file(folder.in("m.xml"), test::kSmallMachine);
    write_file(folder.in("rows.csv"), test::kSmallRows);
  }
  std::string typed(const json& request) const {
    return shell_text("vernier", table.plan(request, Project(folder.project())).arguments);
  }
  test::Folder folder;
  CommandTable table{test::described()};
};

TEST(WorkbenchCommand, IsWhatAPersonWouldType) {
  const Rig rig;
  EXPECT_EQ(
      rig.typed({{"command", "fit"}, {"machine", "m.xml"}, {"meas", {"rows.csv"}}, {"output", "new.xml"}}),
      "vernier fit m.xml rows.csv -o new.xml");
  EXPECT_EQ(
      rig.typed({{"command", "plan"},
                 {"machine", "m.xml"},
                 {"meas", {"rows.csv"}},
                 {"separate", {"backlash:axis=X", "it's:x=(1 2)"}},
                 {"points", 12}}),
      "vernier plan m.xml rows.csv --separate backlash:axis=X --separate 'it'\\''s:x=(1 2)' --points 12");
  EXPECT_EQ(rig.typed({{"command", "compare"},
                       {"machine", "m.xml"},
                       {"meas", {"rows.csv"}},
                       {"datum", true},
                       {"images", "."},
                       {"header", {"serial number=4711", "company=Muster & Sohn"}}}),
            "vernier compare m.xml rows.csv --datum --images . --header 'serial number=4711' --header "
            "'company=Muster & Sohn'");
  EXPECT_EQ(rig.typed({{"command", "import table"},
                       {"file", "rows.csv"},
                       {"decimal", "comma"},
                       {"deviation", {"X[um]=2"}},
                       {"output", "read.csv"}}),
            "vernier import table rows.csv --decimal comma --deviation 'X[um]=2' -o read.csv");
  EXPECT_EQ(
      rig.typed(
          {{"command", "upload"}, {"confirm", true}, {"revert", false}, {"to", "tcp://127.0.0.1:1502"}}),
      "vernier upload --confirm --to tcp://127.0.0.1:1502");
}

TEST(WorkbenchCommand, LooksAtAFleetAndChangesNothingOfIt) {
  const Rig rig;
  EXPECT_EQ(rig.typed({{"command", "fleet due"}, {"registry", "postgresql://u@h/fleet"}}),
            "vernier fleet due --registry postgresql://u@h/fleet");
  EXPECT_EQ(rig.typed({{"command", "fleet alike"}, {"registry", "m.xml"}}),
            "vernier fleet alike --registry m.xml");
  for (const char* what :
       {"rollout", "forget", "gateway", "batch", "task", "collect", "rename", "add", "", "status due"})
    EXPECT_THROW(rig.typed({{"command", std::string("fleet ") + what}, {"registry", "m.xml"}}), InputError)
        << what;
  for (const char* place : {"../fleet.db", "/tmp/fleet.db", "none.db", "--x", "postgresqlx://h"})
    EXPECT_THROW(rig.typed({{"command", "fleet due"}, {"registry", place}}), InputError) << place;
}

TEST(WorkbenchCommand, EveryExportOfTheProgramIsOnThePage) {
  const Rig rig;
  const auto has = [](const auto& list, const std::string& name) {
    return std::any_of(list.begin(), list.end(), [&](const auto& one) { return one["name"] == name; });
  };
  std::size_t formats = 0;
  for (const auto& command : test::described()) {
    const auto name = command["name"].template get<std::string>();
    if (!name.starts_with("export ")) continue;
    ++formats;
    ASSERT_TRUE(has(rig.table.allowed(), name)) << name;
    json request = {{"command", name}, {"machine", "m.xml"}, {"output", "out"}};
    EXPECT_EQ(rig.typed(request), "vernier " + name + " m.xml -o out");
    request["accept"] = {"measured-range", "check-rows"};
    EXPECT_EQ(rig.typed(request),
              "vernier " + name + " m.xml --accept measured-range --accept check-rows -o out");
    request["accept"] = {"everything"};
    EXPECT_THROW(rig.typed(request), InputError) << name;
    for (const char* output : {"../out", "/tmp/out", ".vernier", "-o"})
      EXPECT_THROW(rig.typed({{"command", name}, {"machine", "m.xml"}, {"output", output}}), InputError);
  }
  EXPECT_GE(formats, 11u);
  EXPECT_EQ(rig.typed({{"command", "export linuxcnc"}, {"machine", "m.xml"}, {"type", 0}, {"output", "lc"}}),
            "vernier export linuxcnc m.xml --type 0 -o lc");
  EXPECT_EQ(rig.typed({{"command", "compile"},
                       {"machine", "m.xml"},
                       {"accept", {"measured-range"}},
                       {"output", "image"}}),
            "vernier compile m.xml --accept measured-range -o image");
  EXPECT_EQ(
      rig.typed({{"command", "correct"}, {"machine", "m.xml"}, {"path", "rows.csv"}, {"output", "c.csv"}}),
      "vernier correct m.xml rows.csv -o c.csv");
  EXPECT_EQ(rig.typed({{"command", "map"}, {"machine", "m.xml"}, {"language", "de"}, {"output", "map.html"}}),
            "vernier map m.xml --language de -o map.html");
}

TEST(WorkbenchCommand, AnEmptyFieldIsCalledEmpty) {
  const Rig rig;
  try {
    rig.typed({{"command", "fleet due"}, {"registry", ""}});
    FAIL();
  } catch (const InputError& error) {
    EXPECT_STREQ(error.what(), "\"registry\": is empty: give a value");
  }
}

TEST(WorkbenchCommand, RefusesWhatIsNotInTheTable) {
  const Rig rig;
  const json good = {{"command", "fit"}, {"machine", "m.xml"}, {"meas", {"rows.csv"}}, {"output", "new.xml"}};
  const auto with = [&](const char* key, const json& value) {
    json changed = good;
    changed[key] = value;
    return changed;
  };
  EXPECT_NO_THROW(rig.typed(good));
  for (const json& bad : {with("command", "sh"),
                          with("command", "workbench"),
                          with("command", 3),
                          with("output", "/tmp/x.xml"),
                          with("output", "../x.xml"),
                          with("output", "-o"),
                          with("output", ".vernier/history.json"),
                          with("output", 7),
                          with("machine", "none.xml"),
                          with("machine", "../m.xml"),
                          with("machine", "--help"),
                          with("meas", "rows.csv"),
                          with("meas", json::array()),
                          with("meas", {"/etc/passwd"}),
                          with("images", ".."),
                          with("images", true),
                          with("machine", "."),
                          with("residuals", "r.csv"),  // an option of fit that the page may not use
                          with("solver", "ceres"),
                          with("json", "-"),
                          with("loss", "least"),
                          with("loss", "--json=/tmp/x"),
                          with("loss", "a\nb"),
                          with("loss", ""),
                          with("extra", "x"),
                          with("effect", "x"),
                          json::array(),
                          json("fit")})
    EXPECT_THROW(rig.typed(bad), InputError) << bad;
}

TEST(WorkbenchCommand, ThePageGetsWhatTheProgramDeclaresOfAllowedOptionsOnly) {
  const Rig rig;
  const auto options = [&](const std::string& name) {
    for (const auto& command : rig.table.allowed())
      if (command["name"] == name) return command["options"];
    return nlohmann::ordered_json();
  };
  const auto option = [&](const std::string& command, const std::string& name) {
    for (const auto& one : options(command))
      if (one["name"] == name) return one;
    return nlohmann::ordered_json();
  };
  EXPECT_EQ(option("fit", "loss")["words"], nlohmann::ordered_json({"squared", "huber", "cauchy"}));
  EXPECT_EQ(option("fit", "loss")["default"], "squared");
  EXPECT_EQ(option("diagnose", "most")["low"], 1);
  EXPECT_EQ(option("diagnose", "most")["high"], 10);
  EXPECT_EQ(option("fit", "machine")["kind"], "reads");
  EXPECT_EQ(option("improve", "output")["kind"], "writes-folder");
  // The command itself can do without it; the page must keep its result.
  EXPECT_EQ(option("fit", "output")["required"], true);
  EXPECT_TRUE(option("fit", "residuals").is_null());
  // The positions of a tracker's points may be in another file.
  EXPECT_EQ(option("import tracker", "nominal")["kind"], "reads");
  EXPECT_EQ(option("import tracker", "machine")["kind"], "reads");
  // A note of the page asks for it.
  for (const char* importer : {"import table", "import tracker", "import probe"})
    EXPECT_EQ(option(importer, "directions")["words"], nlohmann::ordered_json({"from-order"})) << importer;
  EXPECT_TRUE(options("sh").is_null());
}

TEST(WorkbenchCommand, EveryAllowedOptionThatNamesAFileIsConfined) {
  // An option that is not marked as a file at its declaration would let the page name any path.
  const Rig rig;
  std::size_t files = 0;
  for (const auto& command : rig.table.allowed())
    for (const auto& option : command["options"]) {
      const auto kind = option["kind"].get<std::string>(), help = option["help"].get<std::string>();
      if (kind != "text") {
        files += kind.starts_with("reads") || kind.starts_with("writes") ? 1 : 0;
        continue;
      }
      // These only tell of a file: the place of a circle in the files' order, a line of a report's head and
      // its language, free parameters beside those of the machine file, a tool of the machine file, a name
      // inside of the files of Klipper (letters, digits, - and _ only).
      if (option["name"] == "plane" || option["name"] == "header" || option["name"] == "language" ||
          option["name"] == "free" || (command["name"] == "correct" && option["name"] == "tool") ||
          (command["name"] == "export klipper" && option["name"] == "profile"))
        continue;
      for (const char* word :
           {"file", "folder", "directory", "(CSV", "(XML", "(HTML", ".csv", ".xml", "report"})
        EXPECT_EQ(help.find(word), std::string::npos)
            << command["name"] << " --" << option["name"] << ": " << help;
    }
  EXPECT_GT(files, 60u);
}

TEST(WorkbenchCommand, ATableThatTheProgramDoesNotFulfilIsOurFault) {
  auto lacking = test::described();
  for (auto& command : lacking)
    if (command["name"] == "fit") command["options"].erase(command["options"].begin());
  EXPECT_THROW(CommandTable{lacking}, std::logic_error);
}

TEST(WorkbenchCommand, QuotingSurvivesAShell) {
  const std::string hostile = "a'b \"$(touch x)\" `y` \\ ; & | * ?";
  RunningProcess running;
  const auto result = run_process(
      "/bin/sh", {"-c", shell_text("printf %s", {hostile})}, "/", 10000, [](std::string_view) {}, running);
  EXPECT_EQ(result.exit, 0);
  EXPECT_EQ(result.out, hostile);
}

TEST(Process, LinesExitAndBothPipesArrive) {
  RunningProcess running;
  std::vector<std::string> lines;
  const auto result = run_process(
      "/bin/sh", {"-c", "echo one >&2; echo out; printf two >&2; exit 3"}, "/", 10000,
      [&](std::string_view line) { lines.emplace_back(line); }, running);
  EXPECT_EQ(result.exit, 3);
  EXPECT_EQ(result.out, "out\n");
  EXPECT_EQ(lines, (std::vector<std::string>{"one", "two"}));
}

TEST(Process, CancelEndsItAndItsChildren) {
  RunningProcess running;
  std::thread later([&] {
    while (running.group == 0) std::this_thread::yield();
    running.cancel();
  });
  const auto result = run_process(
      "/bin/sh", {"-c", "sleep 1000 & sleep 1000; echo never"}, "/", 10000, [](std::string_view) {}, running);
  later.join();
  EXPECT_EQ(result.exit, 128 + 9);
  EXPECT_TRUE(result.out.empty());
}

TEST(Process, TooMuchOutputEndsIt) {
  RunningProcess running;
  const auto result = run_process(
      "/bin/sh", {"-c", "yes"}, "/", 100000, [](std::string_view) {}, running);
  EXPECT_EQ(result.exit, 70);
}

TEST(Process, WhatCannotBeStartedSaysSo) {
  RunningProcess running;
  EXPECT_EQ(run_process(
                "/no/such/program", {}, "/", 1000, [](std::string_view) {}, running)
                .exit,
            127);
}

}  // namespace
}  // namespace vernier::commands_test
