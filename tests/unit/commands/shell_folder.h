// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <gtest/gtest.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cstdlib>
#include <filesystem>
#include <string>

#include "tools/text/files.h"

namespace vernier::commands_test {

/// A test with a folder of its own, in which a shell runs commands.
struct ShellFolder : testing::Test {
  explicit ShellFolder(const std::string& name)
      : folder(testing::TempDir() + name + "_" + std::to_string(getpid())) {
    std::filesystem::create_directories(folder);
  }
  ~ShellFolder() override { std::filesystem::remove_all(folder); }

  /// Exit status of shell commands; `said` holds their output.
  int run(const std::string& commands) {
    text::write_file(folder + "/call.sh", commands + "\n");
    const int status = std::system(
        ("cd '" + folder + "' && PATH=" VERNIER_BIN_DIR ":$PATH sh -e call.sh >said.txt 2>&1").c_str());
    said = text::read_file(folder + "/said.txt");
    return WIFEXITED(status) ? WEXITSTATUS(status) : -1;
  }

  const std::string folder;
  std::string said;
};

}  // namespace vernier::commands_test
