// SPDX-License-Identifier: GPL-3.0-or-later
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <map>
#include <sstream>

#include "tests/unit/house/includes.h"

namespace vernier::house {
namespace {

std::size_t wrong(const std::string& path, const std::string& text) {
  return wrong_includes(path, text).size();
}

TEST(Includes, EveryWrongDirectionIsDetected) {
  EXPECT_EQ(wrong("comp/a.h", "#include \"tables/image_format.h\"\n"), 1u);
  EXPECT_EQ(wrong("comp/a.h", "#include <vector>\n"), 1u);
  EXPECT_EQ(wrong("tables/a.cpp", "#include <string>\n"), 1u);
  EXPECT_EQ(wrong("tables/a.cpp", "#include \"hal/clock.h\"\n"), 1u);
  EXPECT_EQ(wrong("hal/clock.h", "#include \"comp/compensator.h\"\n"), 1u);
  EXPECT_EQ(wrong("hal/clock.h", "#include \"hal/linux/timer.h\"\n"), 1u);
  EXPECT_EQ(wrong("hal/linux/a.cpp", "#include \"comp/compensator.h\"\n"), 1u);
  EXPECT_EQ(wrong("hal/linux/a.cpp", "#include \"hal/sim/plant.h\"\n"), 1u);
  EXPECT_EQ(wrong("hal/sim/a.cpp", "#include \"tables/image_view.h\"\n"), 1u);
  EXPECT_EQ(wrong("hal/clock.h", "#include \"hal/support/output_file.h\"\n"), 1u);
  EXPECT_EQ(wrong("hal/support/a.cpp", "#include \"hal/linux/timer.h\"\n"), 1u);
  EXPECT_EQ(wrong("comp/a.h", "#include \"hal/support/output_file.h\"\n"), 1u);
  EXPECT_EQ(wrong("firmware/core/cycle/cycle.cpp", "#include \"hal/sim/plant.h\"\n"), 1u);
  EXPECT_EQ(wrong("firmware/core/cycle/cycle.cpp", "#include \"tools/model/chain/chain.h\"\n"), 1u);
  EXPECT_EQ(wrong("firmware/core/cycle/cycle.cpp", "#include \"tests/support/a.h\"\n"), 1u);
  EXPECT_EQ(wrong("tools/fit/a.cpp", "#include \"hal/clock.h\"\n"), 1u);
  EXPECT_EQ(wrong("tools/model/a.cpp", "#include \"tools/fit/fit.h\"\n"), 1u);
  EXPECT_EQ(wrong("tools/fit/a.cpp", "#include \"tests/support/a.h\"\n"), 1u);
  EXPECT_EQ(wrong("tools/fit/a.cpp", "#include \"tools/commands/command.h\"\n"), 1u);
  EXPECT_EQ(wrong("tools/model/a.cpp", "#include \"tools/attic/a.h\"\n"), 1u);
  EXPECT_EQ(wrong("tools/attic/a.cpp", "#include \"tools/model/chain/chain.h\"\n"), 1u);
  EXPECT_EQ(wrong("tools/fit/a.cpp", "  #  include \"fit.h\"\n"), 1u);
}

TEST(Includes, EveryAllowedDirectionPasses) {
  EXPECT_EQ(wrong("comp/a.h", "#include <cstdint>\n#include \"comp/fixed.h\"\n// #include <vector>\n"), 0u);
  EXPECT_EQ(wrong("tables/a.cpp", "#include \"comp/fixed.h\"\n#include \"tables/image_view.h\"\n"), 0u);
  EXPECT_EQ(wrong("hal/board.h", "#include \"hal/clock.h\"\n#include \"comp/quantity.h\"\n"), 0u);
  EXPECT_EQ(wrong("hal/linux/a.cpp", "#include <modbus.h>\n#include \"hal/clock.h\"\n"), 0u);
  EXPECT_EQ(wrong("hal/sim/a.cpp", "#include \"comp/compensator.h\"\n"), 0u);
  EXPECT_EQ(wrong("hal/support/a.h", "#include \"comp/wide.h\"\n#include \"hal/probe_line.h\"\n"), 0u);
  EXPECT_EQ(wrong("hal/linux/a.h", "#include \"hal/support/edge_queue.h\"\n"), 0u);
  EXPECT_EQ(wrong("comp/probing/a.h", "#include \"comp/compensator.h\"\n"), 0u);
  EXPECT_EQ(wrong("firmware/core/a.h", "#include \"tables/records.h\"\n#include \"hal/board.h\"\n"), 0u);
  EXPECT_EQ(wrong("hal/support/a.cpp", "#include <string>\n#include \"hal/support/a.h\"\n"), 0u);
  EXPECT_EQ(wrong("firmware/daemon/report.cpp", "#include \"hal/support/output_file.h\"\n"), 0u);
  EXPECT_EQ(wrong("tools/model/a.cpp", "#include \"hal/support/output_file.h\"\n"), 0u);
  EXPECT_EQ(wrong("firmware/daemon/main.cpp", "#include \"hal/linux/board.h\"\n"), 0u);
  EXPECT_EQ(wrong("firmware/linuxcnc/vernier_hal.cpp",
                  "#include \"hal/linux/file_lock.h\"\n#include \"firmware/daemon/settings/key_file.h\"\n"),
            0u);
  EXPECT_EQ(wrong("firmware/linuxcnc/joints.cpp", "#include \"hal/linux/file_lock.h\"\n"), 1u);
  EXPECT_EQ(wrong("firmware/core/a.cpp", "#include \"firmware/linuxcnc/joints.h\"\n"), 1u);
  EXPECT_EQ(wrong("tools/simulate/a.cpp",
                  "#include \"firmware/core/cycle/cycle.h\"\n#include \"hal/sim/plant.h\"\n"),
            0u);
  EXPECT_EQ(wrong("tools/fit/a.cpp", "#include \"tools/model/chain/chain.h\"\n#include \"comp/fixed.h\"\n"),
            0u);
  EXPECT_EQ(wrong("tests/unit/comp/a.cpp", "#include \"tools/model/chain/chain.h\"\n"), 0u);
}

TEST(Includes, MessageNamesFileLineAndWord) {
  const auto messages = wrong_includes("comp/a.h", "#include <cstdint>\n#include <vector>\n");
  ASSERT_EQ(messages.size(), 1u);
  EXPECT_EQ(messages[0], "comp/a.h:2: \"vector\": comp and tables take freestanding headers only");
}

TEST(Includes, NoRoomOfToolsUsesOneAbove) { EXPECT_EQ(rooms_that_run_up(), std::vector<std::string>{}); }

TEST(Names, TypesOfAHeaderAreFound) {
  EXPECT_EQ(
      declared_types("struct A {\nclass B : public C {\nenum class D : int {\nstruct E;\nstruct F {};\n"),
      (std::vector<std::string>{"A", "B", "D", "F"}));
}

TEST(Names, NoTypeNameStandsTwice) {
  namespace fs = std::filesystem;
  const fs::path root = VERNIER_SOURCE_DIR;
  std::map<std::string, std::string> seen;
  for (const char* folder : {"comp", "tables", "hal", "firmware", "tools"}) {
    for (auto it = fs::recursive_directory_iterator(root / folder); it != fs::recursive_directory_iterator();
         ++it) {
      if (it->path().filename() == "node_modules") it.disable_recursion_pending();
      if (!it->is_regular_file() || it->path().extension() != ".h") continue;
      std::ostringstream text;
      text << std::ifstream(it->path()).rdbuf();
      const std::string path = fs::relative(it->path(), root).string();
      for (const std::string& name : declared_types(text.str())) {
        const auto [first, is_new] = seen.emplace(name, path);
        EXPECT_TRUE(is_new) << name << " is defined in " << first->second << " and in " << path;
      }
    }
  }
  EXPECT_GT(seen.size(), 100u) << "the walk over the headers found next to nothing";
}

TEST(Includes, HouseFollowsItsDirections) {
  namespace fs = std::filesystem;
  const fs::path root = VERNIER_SOURCE_DIR;
  std::size_t files = 0;
  for (const char* folder : {"comp", "tables", "hal", "firmware", "tools", "tests"}) {
    for (auto it = fs::recursive_directory_iterator(root / folder); it != fs::recursive_directory_iterator();
         ++it) {
      if (it->path().filename() == "node_modules") it.disable_recursion_pending();
      const auto extension = it->path().extension();
      if (!it->is_regular_file() || (extension != ".h" && extension != ".cpp" && extension != ".c")) continue;
      std::ostringstream text;
      text << std::ifstream(it->path()).rdbuf();
      ++files;
      for (const auto& message : wrong_includes(fs::relative(it->path(), root).string(), text.str())) {
        ADD_FAILURE() << message;
      }
    }
  }
  EXPECT_GT(files, 10u) << "the walk over the sources found next to nothing";
}

}  // namespace
}  // namespace vernier::house
