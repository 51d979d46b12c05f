// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/workbench/runs/commands.h"

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
    return shell_text("vernier", plan_command(request, Project(folder.project())).arguments);
  }
  test::Folder folder;
};

TEST(WorkbenchCommand, IsWhatAPersonWouldType) {
  const Rig rig;
  EXPECT_EQ(
      rig.typed(
          {{"command", "fit"}, {"machine", "m.xml"}, {"measurements", {"rows.csv"}}, {"output", "new.xml"}}),
      "vernier fit m.xml rows.csv -o new.xml");
  EXPECT_EQ(
      rig.typed({{"command", "plan"},
                 {"machine", "m.xml"},
                 {"measurements", {"rows.csv"}},
                 {"separate", {"backlash:axis=X", "it's:x=(1 2)"}},
                 {"points", 12}}),
      "vernier plan m.xml rows.csv --separate backlash:axis=X --separate 'it'\\''s:x=(1 2)' --points 12");
  EXPECT_EQ(rig.typed({{"command", "compare"},
                       {"machine", "m.xml"},
                       {"measurements", {"rows.csv"}},
                       {"datum", true},
                       {"images", true},
                       {"header", {"serial number=4711", "company=Muster & Sohn"}}}),
            "vernier compare m.xml rows.csv --datum --images=. --header 'serial number=4711' --header "
            "'company=Muster & Sohn'");
  EXPECT_EQ(rig.typed({{"command", "import"},
                       {"kind", "table"},
                       {"files", {"rows.csv"}},
                       {"decimal", "comma"},
                       {"deviations", {"X[um]=2"}},
                       {"output", "read.csv"}}),
            "vernier import table rows.csv --decimal comma --deviation 'X[um]=2' -o read.csv");
  EXPECT_EQ(
      rig.typed(
          {{"command", "upload"}, {"confirm", true}, {"revert", false}, {"to", "tcp://127.0.0.1:1502"}}),
      "vernier upload --confirm --to tcp://127.0.0.1:1502");
}

TEST(WorkbenchCommand, LooksAtAFleetAndChangesNothingOfIt) {
  const Rig rig;
  EXPECT_EQ(rig.typed({{"command", "fleet"}, {"what", "due"}, {"registry", "postgresql://u@h/fleet"}}),
            "vernier fleet due --registry postgresql://u@h/fleet");
  EXPECT_EQ(rig.typed({{"command", "fleet"}, {"what", "alike"}, {"registry", "m.xml"}}),
            "vernier fleet alike --registry m.xml");
  for (const char* what : {"rollout", "forget", "gateway", "batch", "task", "collect", "rename", "add", "", "status due"})
    EXPECT_THROW(rig.typed({{"command", "fleet"}, {"what", what}, {"registry", "m.xml"}}), InputError)
        << what;
  for (const char* place : {"../fleet.db", "/tmp/fleet.db", "none.db", "--x", "postgresqlx://h"})
    EXPECT_THROW(rig.typed({{"command", "fleet"}, {"what", "due"}, {"registry", place}}), InputError)
        << place;
}

TEST(WorkbenchCommand, RefusesWhatIsNotInTheTable) {
  const Rig rig;
  const json good = {
      {"command", "fit"}, {"machine", "m.xml"}, {"measurements", {"rows.csv"}}, {"output", "new.xml"}};
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
                          with("measurements", "rows.csv"),
                          with("measurements", json::array()),
                          with("measurements", {"/etc/passwd"}),
                          with("loss", "--json=/tmp/x"),
                          with("loss", "a\nb"),
                          with("loss", ""),
                          with("extra", "x"),
                          with("effect", "x"),
                          json::array(),
                          json("fit")})
    EXPECT_THROW(rig.typed(bad), InputError) << bad;
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
