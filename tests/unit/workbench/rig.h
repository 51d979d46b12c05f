// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <gtest/gtest.h>
#include <unistd.h>

#include <filesystem>
#include <string>
#include <thread>

#include "tools/text/files.h"
#include "tools/text/process.h"
#include "tools/workbench/server.h"

namespace vernier::test {

/// A folder of its own for a test, gone at its end.
class Folder {
 public:
  Folder()
      : path_(testing::TempDir() + "workbench_" + std::to_string(getpid()) + "_" +
              testing::UnitTest::GetInstance()->current_test_info()->name()) {
    std::filesystem::remove_all(path_);
    std::filesystem::create_directories(path_ + "/project");
  }
  ~Folder() { std::filesystem::remove_all(path_); }
  Folder(const Folder&) = delete;
  Folder& operator=(const Folder&) = delete;

  std::string project() const { return path_ + "/project"; }
  std::string beside(const std::string& name) const { return path_ + "/" + name; }
  std::string in(const std::string& name) const { return project() + "/" + name; }

 private:
  std::string path_;
};

inline const char* kSmallMachine =
    "<machine name=\"small\"><variables><static><k value=\"0\" nominal=\"0\" unit=\"rad\"/></static>\n"
    "<machineaxes><X min=\"0\" max=\"100\"/><Y min=\"0\" max=\"100\"/></machineaxes>\n"
    "<inputs><T unit=\"degC\" reference=\"20\"/></inputs></variables>\n"
    "<transforms><sixdof n=\"1\" X=\"X+k*Y\" Y=\"Y\"/></transforms></machine>\n";
inline const char* kSmallRows =
    "X[mm],Y[mm],x[mm],run\n0,0,0.001,a\n50,50,50.0112,a\n# a remark\n100,100,100.0198,b\n0,100,0.0203,b\n";

/// The program that was built beside the tests.
inline std::string program() { return std::string(VERNIER_BIN_DIR) + "/vernier"; }

/// Its commands and options, as it hands them to the workbench.
inline const nlohmann::ordered_json& described() {
  static const nlohmann::ordered_json kCommands = [] {
    text::RunningProcess running;
    return nlohmann::ordered_json::parse(
        text::run_process(
            program(), {"completion", "json"}, "/", 1 << 22, [](std::string_view) {}, running)
            .out);
  }();
  return kCommands;
}

}  // namespace vernier::test
