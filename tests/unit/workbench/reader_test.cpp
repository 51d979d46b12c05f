// SPDX-License-Identifier: GPL-3.0-or-later
// Files are read by a process of their own: whatever a file does to it, the server goes on.
#include <filesystem>

#include "tests/unit/workbench/rig.h"
#include "tools/workbench/file_reader.h"

namespace vernier::reader_test {

using namespace vernier::text;
using namespace vernier::workbench;
namespace {

/// A program that stands for `vernier`.
std::string script(const test::Folder& folder, const std::string& text) {
  const std::string path = folder.beside("program");
  write_file(path, "#!/bin/sh\n" + text + "\n");
  std::filesystem::permissions(path, std::filesystem::perms::owner_all);
  return path;
}

const std::multimap<std::string, std::string> kBoth = {{"machine", "m.xml"}, {"measurement", "m.csv"}};
const char* const kBody =
    R"({"machine":"m.xml","measurements":["m.csv"],"values":{},"add":"backlash:axis=X","term":"k*X","unit":"mm"})";

/// Every request that takes reading a file.
const ApiRequest kReading[] = {{"PUT", "/api/file", {{"name", "new.xml"}}, test::kSmallMachine},
                               {"PUT", "/api/file", {{"name", "new.csv"}}, test::kSmallRows},
                               {"GET", "/api/excluded", {{"name", "m.csv"}}, ""},
                               {"GET", "/api/rows", kBoth, ""},
                               {"GET", "/api/parameters", kBoth, ""},
                               {"POST", "/api/predict", {}, kBody},
                               {"POST", "/api/explain", {}, kBody},
                               {"GET", "/api/names", {{"machine", "m.xml"}}, ""},
                               {"POST", "/api/term", {}, kBody},
                               {"GET", "/api/kind", {{"name", "m.csv"}}, ""},
                               {"POST", "/api/sheet", {}, R"({"name":"m.csv","machine":"m.xml"})"},
                               {"GET", "/api/safety", {{"machine", "m.xml"}}, ""}};

struct WorkbenchReader : testing::Test {
  WorkbenchReader() {
    write_file(folder.in("m.xml"), test::kSmallMachine);
    write_file(folder.in("m.csv"), test::kSmallRows);
  }
  test::Folder folder;
};

TEST_F(WorkbenchReader, AFileThatKillsItsReaderHarmsItsRequestOnly) {
  Api api(folder.project(), script(folder, "kill -SEGV $$"), "test", test::described());
  for (const ApiRequest& request : kReading) {
    const ApiReply reply = api.reply(request);
    EXPECT_EQ(reply.status, 422) << request.path;
    EXPECT_NE(reply.body.find("signal 11"), std::string::npos) << request.path << reply.body;
  }
  EXPECT_FALSE(std::filesystem::exists(folder.in("new.xml")));
  EXPECT_FALSE(std::filesystem::exists(folder.in("new.csv")));
  EXPECT_EQ(api.reply({"GET", "/api/project", {}, ""}).status, 200);
}

TEST_F(WorkbenchReader, AnotherOneReadsTheNextFile) {
  const std::string mark = folder.beside("dies");
  Api api(folder.project(),
          script(folder, "if [ -e '" + mark + "' ]; then rm '" + mark + "'; kill -KILL $$; fi; exec '" +
                             test::program() + "' \"$@\""),
          "test", test::described());
  write_file(mark, "");
  EXPECT_EQ(api.reply(kReading[0]).status, 422);
  for (const ApiRequest& request : kReading) {
    const ApiReply reply = api.reply(request);
    EXPECT_EQ(reply.status, 200) << request.path << reply.body;
  }
  EXPECT_EQ(read_file(folder.in("new.xml")), test::kSmallMachine);
}

TEST_F(WorkbenchReader, OneThatSaysNothingIsEnded) {
  const Project project(folder.project());
  FileReader reader(script(folder, "exec sleep 1000"), project, 0.2);
  const ApiReply reply = reader.reply(kReading[0]);
  EXPECT_EQ(reply.status, 422);
  EXPECT_NE(reply.body.find("no answer"), std::string::npos) << reply.body;
}

TEST_F(WorkbenchReader, OneThatTalksNonsenseIsEnded) {
  const Project project(folder.project());
  FileReader reader(script(folder, "exec cat /dev/zero"), project, 5);
  EXPECT_EQ(reader.reply(kReading[0]).status, 422);
  FileReader none(folder.beside("no such program"), project, 5);
  EXPECT_EQ(none.reply(kReading[0]).status, 422);
}

TEST_F(WorkbenchReader, WhatNestsOrAddsWithoutEndIsRefusedWithItsPlace) {
  Api api(folder.project(), test::program(), "test", test::described());
  std::string nested = "<machine name=\"m\">\n", sum = "k*X";
  for (int i = 0; i < 20'000; ++i) nested += "<a>";
  for (int i = 0; i < 60'000; ++i) sum += "+1";
  const ApiReply deep = api.reply({"PUT", "/api/file", {{"name", "deep.xml"}}, nested});
  EXPECT_EQ(deep.status, 422);
  EXPECT_NE(deep.body.find("deep.xml:2"), std::string::npos) << deep.body;
  const ApiReply term =
      api.reply({"POST", "/api/term", {}, R"({"machine":"m.xml","unit":"mm","term":")" + sum + "\"}"});
  EXPECT_EQ(term.status, 200);
  EXPECT_NE(term.body.find("too long"), std::string::npos) << term.body.substr(0, 300);
  const ApiReply brackets = api.reply({"POST", "/api/term", {}, "{\"a\":" + std::string(100'000, '[') + "}"});
  EXPECT_EQ(brackets.status, 422);
}

TEST_F(WorkbenchReader, AHistoryThatNestsTooDeeplyIsRefused) {
  std::filesystem::create_directory(folder.in(".vernier"));
  write_file(folder.in(".vernier/history.json"),
             "[{\"command\":\"c\",\"undone\":false,\"on_board\":false,\"outputs\":" +
                 std::string(200'000, '[') + std::string(200'000, ']') + "}]");
  EXPECT_THROW(Api(folder.project(), test::program(), "test", test::described()), InputError);
}

}  // namespace
}  // namespace vernier::reader_test
