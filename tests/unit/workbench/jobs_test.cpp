// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/workbench/runs/jobs.h"

#include <chrono>

#include "tests/unit/workbench/rig.h"
#include "tools/workbench/api.h"
#include "tools/workbench/files/rows.h"

namespace vernier::jobs_test {

using namespace vernier::text;
using namespace vernier::workbench;
namespace {

using nlohmann::json;

struct Rig {
  Rig() {
    write_file(folder.in("m.xml"), test::kSmallMachine);
    write_file(folder.in("rows.csv"), test::kSmallRows);
  }
  json post(const std::string& path, const json& body) {
    return json::parse(api.reply({"POST", path, {}, body.dump()}).body);
  }
  json get(const std::string& path, const std::multimap<std::string, std::string>& query = {}) {
    return json::parse(api.reply({"GET", path, query, ""}).body);
  }
  json finish(json job) {
    while (job.at("state") == "running") {
      std::this_thread::sleep_for(std::chrono::milliseconds(5));
      job = get("/api/jobs", {{"id", std::to_string(job["id"].get<int>())}});
    }
    return job;
  }
  json run(const json& request) { return finish(post("/api/jobs", request)); }
  test::Folder folder;
  Api api{folder.project(), test::program(), "test", test::described()};
};

const json kFit = {{"command", "fit"}, {"machine", "m.xml"}, {"meas", {"rows.csv"}}, {"output", "new.xml"}};

TEST(Job, GivesTheResultOfTheCommandItShows) {
  Rig rig;
  const json job = rig.run(kFit);
  ASSERT_EQ(job["state"], "done") << job;
  EXPECT_EQ(job["command"], "vernier fit m.xml rows.csv -o new.xml");
  RunningProcess running;
  const auto typed = run_process(
      "/bin/sh", {"-c", test::program() + " fit m.xml rows.csv -o other.xml --json -"}, rig.folder.project(),
      1 << 20, [](std::string_view) {}, running);
  EXPECT_EQ(job["result"], json::parse(typed.out));
  // Only the records of their commands differ: each has the name of its file.
  const auto machine = [&](const char* name) {
    const std::string text = read_file(rig.folder.in(name));
    return text.substr(0, text.find("<!-- made by: "));
  };
  EXPECT_EQ(machine("new.xml"), machine("other.xml"));
}

TEST(Job, FailureSaysFileLineAndWord) {
  Rig rig;
  write_file(rig.folder.in("rows.csv"), "X[mm],Y[mm],x[mm]\n1,2,3\n1,two,3\n");
  const json job = rig.run(kFit);
  EXPECT_EQ(job["state"], "failed");
  EXPECT_EQ(job["exit"], 1);
  EXPECT_NE(job["message"].get<std::string>().find("rows.csv:3: \"two\""), std::string::npos)
      << job["message"];
  EXPECT_FALSE(std::filesystem::exists(rig.folder.in("new.xml")));
  EXPECT_TRUE(rig.get("/api/history")["history"].empty());
}

TEST(Job, CancelEndsItAndWritesNothing) {
  Rig rig;
  std::string rows = "X[mm],Y[mm],t[s],x[mm],run\n";
  for (int i = 0; i < 20000; ++i)
    rows += std::to_string(i % 100) + "," + std::to_string(i % 97) + "," + std::to_string(i) + "," +
            std::to_string(i % 100 + 0.01 * (i % 13)) + ",r" + std::to_string(i % 5) + "\n";
  write_file(rig.folder.in("rows.csv"), rows);
  const json job = rig.post(
      "/api/jobs",
      {{"command", "diagnose"}, {"machine", "m.xml"}, {"meas", {"rows.csv"}}, {"machine-out", "new.xml"}});
  ASSERT_EQ(job["state"], "running") << job;
  rig.api.reply({"DELETE", "/api/jobs", {{"id", "1"}}, ""});
  EXPECT_EQ(rig.finish(job)["state"], "cancelled");
  EXPECT_FALSE(std::filesystem::exists(rig.folder.in("new.xml")));
}

TEST(History, ReplaysToTheSameBytesAndLeavesOutWhatWasUndone) {
  Rig rig;
  ASSERT_EQ(rig.run({{"command", "exclude"},
                     {"meas", "rows.csv"},
                     {"lines", "3"},
                     {"reason", "it's odd"},
                     {"output", "kept.csv"}})["state"],
            "done");
  ASSERT_EQ(rig.run({{"command", "add"},
                     {"effect", "backlash:axis=X"},
                     {"machine", "m.xml"},
                     {"output", "added.xml"}})["state"],
            "done");
  ASSERT_EQ(rig.run({{"command", "fit"},
                     {"machine", "added.xml"},
                     {"meas", {"kept.csv"}},
                     {"output", "fitted.xml"}})["state"],
            "done");
  ASSERT_EQ(rig.run({{"command", "set"},
                     {"machine", "fitted.xml"},
                     {"values", {"k=0.5"}},
                     {"output", "set.xml"}})["state"],
            "done");
  EXPECT_EQ(rig.post("/api/history", {{"do", "undo"}})["history"].back()["undone"], true);
  // Somewhere else, with the program in the path.
  std::filesystem::create_directories(rig.folder.beside("again"));
  for (const char* name : {"m.xml", "rows.csv", "history.sh"})
    std::filesystem::copy(rig.folder.in(name), rig.folder.beside("again"));
  RunningProcess running;
  const auto replay = run_process(
      "/bin/sh", {"-c", std::string("PATH=") + VERNIER_BIN_DIR + ":$PATH sh history.sh"},
      rig.folder.beside("again"), 1 << 20, [](std::string_view) {}, running);
  ASSERT_EQ(replay.exit, 0) << replay.err;
  for (const char* name : {"kept.csv", "added.xml", "fitted.xml"})
    EXPECT_EQ(read_file(rig.folder.beside("again/") + name), read_file(rig.folder.in(name))) << name;
  EXPECT_FALSE(std::filesystem::exists(rig.folder.beside("again/set.xml")));
  EXPECT_TRUE(std::filesystem::exists(rig.folder.in("set.xml")));
  // What comes after an undone step takes its place; a new session finds the rest.
  EXPECT_EQ(rig.post("/api/history", {{"do", "redo"}})["history"].back()["undone"], false);
  EXPECT_EQ(Api(rig.folder.project(), test::program(), "", test::described())
                .reply({"GET", "/api/history", {}, ""})
                .body,
            rig.api.reply({"GET", "/api/history", {}, ""}).body);
}

TEST(Rows, PredictionIsTheResidualOfTheMachineWithThatValue) {
  Rig rig;
  const Project project(rig.folder.project());
  RowCache rows(project);
  const auto loaded = rows.get("m.xml", {"rows.csv"}, false);
  const std::string blob = prediction_blob(*loaded, {{"k", 2e-4}});
  std::uint32_t length = 0;
  std::memcpy(&length, blob.data(), 4);
  const auto header = json::parse(blob.substr(4, length));
  ASSERT_EQ(header["residual"]["f32"][1], 4);
  float residual[4];
  std::memcpy(residual, blob.data() + 4 + length + header["residual"]["f32"][0].get<std::size_t>(),
              sizeof residual);
  const float wanted[4] = {1, 1.2F, -0.2F, 0.3F};  // 1 um, 11.2-10, 19.8-20, 20.3-20
  for (int i = 0; i < 4; ++i) EXPECT_NEAR(residual[i], wanted[i], 1e-3F) << i;
  EXPECT_EQ(rows.get("m.xml", {"rows.csv"}, false), loaded);  // kept
  write_file(rig.folder.in("rows.csv"), std::string(test::kSmallRows) + "1,1,1,b\n");
  EXPECT_NE(rows.get("m.xml", {"rows.csv"}, false), loaded);  // until the file changes
}

}  // namespace
}  // namespace vernier::jobs_test
