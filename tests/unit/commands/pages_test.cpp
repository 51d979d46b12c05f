// SPDX-License-Identifier: GPL-3.0-or-later
// What the pages print is what the programs do: their blocks are run as they stand, from the folder that they
// say.
#include <gtest/gtest.h>
#include <netinet/in.h>
#include <sys/socket.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <cstdlib>
#include <filesystem>
#include <map>
#include <nlohmann/json.hpp>
#include <regex>
#include <sstream>
#include <utility>
#include <vector>

#include "tools/model/machine_reader.h"
#include "tools/text/files.h"
#include "tools/text/words.h"

namespace vernier::pages_test {

using namespace vernier::text;
namespace {

namespace fs = std::filesystem;

/// The fenced blocks of a kind, in order.
std::vector<std::string> blocks(const std::string& page, const std::string& kind) {
  std::vector<std::string> list;
  std::istringstream in(page);
  bool inside = false;
  for (std::string line; std::getline(in, line);) {
    if (!inside && line == "```" + kind) {
      inside = true;
      list.emplace_back();
    } else if (inside && line == "```") {
      inside = false;
    } else if (inside) {
      list.back() += line + "\n";
    }
  }
  return list;
}

/// All commands of a page, in their order.
std::string script_of(const std::string& page) {
  std::string script;
  for (const std::string& block : blocks(page, "sh")) script += block;
  return script;
}

std::string page(const std::string& name) { return read_file(std::string(VERNIER_SOURCE_DIR) + "/" + name); }

/// A port that nobody has at the moment: other tests run boards too.
int free_port() {
  const int socket = ::socket(AF_INET, SOCK_STREAM, 0);
  sockaddr_in address{};
  address.sin_family = AF_INET;
  address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
  socklen_t size = sizeof address;
  EXPECT_EQ(::bind(socket, reinterpret_cast<sockaddr*>(&address), size), 0);
  EXPECT_EQ(::getsockname(socket, reinterpret_cast<sockaddr*>(&address), &size), 0);
  ::close(socket);
  return ntohs(address.sin_port);
}

/// A folder that looks like the root of a fresh checkout: what it has is there, what it builds goes aside.
class Pages : public testing::Test {
 protected:
  Pages() {
    fs::create_directories(folder_ + "/build");
    for (const char* name : {"tables", "tests", "tools"})
      fs::create_directory_symlink(std::string(VERNIER_SOURCE_DIR) + "/" + name, folder_ + "/" + name);
  }
  ~Pages() override { fs::remove_all(folder_); }

  int run(const std::string& script) {
    write_file(folder_ + "/script", script);
    const int status = std::system(
        ("cd '" + folder_ + "' && PATH=" VERNIER_BIN_DIR ":$PATH timeout 300 bash -em script >out.txt 2>&1")
            .c_str());
    said_ = read_file(folder_ + "/out.txt");
    return WIFEXITED(status) ? WEXITSTATUS(status) : -1;
  }

  const std::string folder_ = testing::TempDir() + "pages_" + std::to_string(getpid());
  std::string said_;
};

TEST_F(Pages, TutorialRunsAsPrinted) {
  const std::string text = page("tools/docs/tutorial.md");
  const std::string script = script_of(text);
  EXPECT_EQ(run(script), 0) << said_;
  // The figures that the page prints.
  for (const char* figure :
       {"bed > Y (bridge) > X (carriage) > Z (ram) > tool", "3.129 um", "3.374 um",
        "The residual is 3.3 times the noise", "X error repeats every 62.76 mm", "period 63.62 +- 0.14 mm",
        "check rows 2.468 um", "check rows 1.285 um", "verdict: consistent"})
    EXPECT_NE(said_.find(figure), std::string::npos) << figure << " is not what the commands print\n"
                                                     << said_;
  for (const char* picture :
       {"tutorial_where.png", "tutorial_why.png", "tutorial_improve.png", "before_after.svg"})
    EXPECT_TRUE(fs::exists(std::string(VERNIER_SOURCE_DIR) + "/tools/docs/img/" + picture)) << picture;
}

/// The numbers of a text, and the text without them.
std::pair<std::vector<double>, std::string> numbers_of(const std::string& text) {
  const std::regex number("[0-9]+\\.[0-9]+");
  std::vector<double> numbers;
  for (std::sregex_iterator it(text.begin(), text.end(), number), end; it != end; ++it)
    numbers.push_back(std::stod(it->str()));
  return {numbers, std::regex_replace(text, number, "")};
}

TEST_F(Pages, PictureOfReadmeIsThatOfItsScript) {
  const std::string folder = VERNIER_SOURCE_DIR "/tools/docs/img/";
  ASSERT_EQ(run("python3 '" + folder + "before_after.py' \"$(command -v vernier)\" >picture.svg"), 0)
      << said_;
  const auto [made, made_text] = numbers_of(read_file(folder_ + "/picture.svg"));
  const auto [kept, kept_text] = numbers_of(read_file(folder + "before_after.svg"));
  EXPECT_EQ(made_text, kept_text);
  ASSERT_EQ(made.size(), kept.size());
  constexpr double kPixel = 0.3;  // another compiler rounds otherwise
  for (std::size_t i = 0; i < made.size(); ++i) EXPECT_NEAR(made[i], kept[i], kPixel) << "number " << i;
}

TEST_F(Pages, ConformityAndPlanRunAsPrinted) {
  const std::string text = page("tools/docs/conformity.md");
  const std::string script = script_of(text);
  EXPECT_EQ(run(script), 0) << said_;
  const auto printed = blocks(text, "text");
  ASSERT_EQ(printed.size(), 1u);
  EXPECT_NE(said_.find(printed[0]), std::string::npos) << printed[0] << "is not in\n" << said_;
  EXPECT_EQ(run(script_of(page("tools/docs/plan.md"))), 0) << said_;
  EXPECT_NE(said_.find("the remaining uncertainty comes from"), std::string::npos) << said_;
}

/// A stranger's way: from a German spreadsheet to ISO 230-2 values, a named cause and a table for the
/// control.
TEST_F(Pages, FirstHourRunsAsPrinted) {
  const std::string script = script_of(page("tools/docs/first_hour.md"));
  ASSERT_EQ(run(script), 0) << said_;
  for (const char* figure :
       {"Windows-1252, columns separated by semicolon, decimal comma", "92.120 um", "tolerance 50: not met",
        "25.750 um", "31.245 um", "12.194 um", "verdict: missing-effect",
        "X carriage: backlash, reversal value B -23.7 +- 0.4 um", "fit rows 6.701 um", "check rows 8.848 um",
        "check rows 1.355 um", "verdict: consistent", "safe to run: every rule of the safety sheet is met"})
    EXPECT_NE(said_.find(figure), std::string::npos) << figure << " is not what the commands print\n"
                                                     << said_;
  const std::string left = folder_ + "/build/first_hour/";
  // The truth (tests/data/router/make.py): 24 um of backlash, of which the fit is sure to 0.4 um.
  std::istringstream table(read_file(left + "linuxcnc/X.comp"));
  std::size_t lines = 0;
  for (double nominal = 0, forward = 0, reverse = 0; table >> nominal >> forward >> reverse; ++lines)
    EXPECT_NEAR(forward - reverse, 0.024, 0.0012) << nominal;
  EXPECT_GE(lines, 5u);
  const nlohmann::json json = nlohmann::json::parse(read_file(left + "iso230-2_X.json"));
  EXPECT_EQ(json["header"]["serial number"], "4711");
  EXPECT_EQ(json["header"]["operator"], "K. Muster");
  const std::string report = read_file(left + "iso230-2_X.html");
  EXPECT_NE(report.find("<p class=\"company\">Muster Maschinenbau GmbH</p>"), std::string::npos);
  EXPECT_NE(report.find("<dt>serial number</dt><dd>4711</dd>"), std::string::npos);
  if (std::system("command -v chromium >/dev/null") == 0) {
    EXPECT_EQ(read_file(left + "iso230-2_X.pdf").substr(0, 5), "%PDF-");
  }
}

TEST_F(Pages, TouchRunsAsPrinted) {
  const std::string text = page("tools/docs/touch.md");
  const std::string script = script_of(text);
  ASSERT_EQ(run(script), 0) << said_;
  const auto printed = blocks(text, "text");
  ASSERT_EQ(printed.size(), 5u);
  for (const std::string& lines : printed)
    EXPECT_NE(said_.find(lines), std::string::npos) << lines << "is not in\n" << said_;
  // The truth (tests/data/touch/make.py), within the uncertainties that the fits state.
  const struct {
    const char* machine;
    const char* name;
    double truth, std;
  } rows[] = {{"printer", "twist", 0.08, 0.0036},
              {"printer", "sag", -0.15, 0.0042},
              {"mill", "squareness", -0.0034, 0.0002},
              {"mill", "scaleX", 40, 11},
              {"mill", "scaleY", -25, 11},
              {"square", "C0Y", 60e-6, 5.8e-7},
              {"square_printer", "EC0Y", 0.0012062, 0.4e-6}};  // calc_skew of Klipper, to 1 urad
  for (const auto& row : rows) {
    const model::Machine machine = model::read_machine(folder_ + "/build/touch/" + row.machine + ".xml");
    EXPECT_NEAR(machine.statics[*machine.find_static(row.name)].value, row.truth, 2.5 * row.std) << row.name;
  }
  EXPECT_NE(read_file(folder_ + "/build/touch/skew/vernier.cfg").find("xy_skew = -0.001205614"),
            std::string::npos);
}

TEST_F(Pages, CameraRunsAsPrinted) {
  const std::string text = page("tools/docs/camera.md");
  const std::string script = script_of(text);
  ASSERT_EQ(run(script), 0) << said_;
  const auto printed = blocks(text, "text");
  ASSERT_EQ(printed.size(), 1u);
  std::istringstream lines(printed[0]);
  for (std::string line; std::getline(lines, line);)
    EXPECT_NE(said_.find(line + "\n"), std::string::npos) << line << " is not in\n" << said_;
  EXPECT_NE(said_.find("verdict: consistent"), std::string::npos) << said_;
  // The truth (tests/data/camera/make.py), within the uncertainties that the fit states.
  const model::Machine machine = model::read_machine(folder_ + "/build/camera/robot.xml");
  ASSERT_EQ(machine.tool_shifts.size(), 1u);
  const std::array<double, 6> truth = {62, -18, -95, 4, -7, 91},
                              std = {0.037, 0.076, 0.34, 0.0081, 0.0049, 0.064};
  for (std::size_t i = 0; i < 6; ++i)
    EXPECT_NEAR(machine.tool_shifts[0].value[i], truth[i], 2.5 * std[i]) << i;
}

TEST_F(Pages, RTestRunsAsPrinted) {
  std::string script;
  for (const std::string& block : blocks(page("tools/docs/import.md"), "sh"))
    if (block.find("tests/data/rtest") != std::string::npos) script += block;
  ASSERT_EQ(run(script), 0) << said_;
  // The truth (tests/data/rtest/make.py).
  const model::Machine machine = model::read_machine(folder_ + "/build/rtest_fitted.xml");
  constexpr double kPosition_mm = 0.002, kDirection_deg = 2.0 / 3600;  // as the page says
  const std::map<std::string, double> truth = {{"xB", 0.012},   {"zB", -0.018},  {"xC", 0.031},
                                               {"yC", -0.044},  {"rxB", 0.0023}, {"rzB", -0.0201},
                                               {"rxC", 0.0042}, {"ryC", -0.0057}};
  for (const auto& [name, value] : truth)
    EXPECT_NEAR(machine.statics[*machine.find_static(name)].value, value,
                name[0] == 'r' ? kDirection_deg : kPosition_mm)
        << name;
  // Without the options the deviations are taken along the axes of the machine: the command says so.
  ASSERT_EQ(run("vernier import table tests/data/rtest/rtest.csv --preview"), 0) << said_;
  EXPECT_NE(said_.find("note: the axis C rotates"), std::string::npos) << said_;
  EXPECT_NE(said_.find("--column \"x[um]=dX [um]\""), std::string::npos) << said_;
}

TEST_F(Pages, ReadmeRunsAsPrinted) {
  std::string script;
  for (const std::string& block : blocks(page("README.md"), "sh")) {
    // The first block installs and builds: what runs this test has been built by it.
    if (block.find("./tools/demo") != std::string::npos) continue;
    script += block;
  }
  const std::string port = std::to_string(free_port());
  script += "\n";
  for (std::size_t at = 0; (at = script.find("1502", at)) != std::string::npos;) script.replace(at, 4, port);
  const std::string copy = "cp tests/data/board/xy_simulated.toml build/board.toml\n";
  ASSERT_NE(script.find(copy), std::string::npos);
  script.insert(script.find(copy) + copy.size(), "sed -i 's/1502/" + port + "/' build/board.toml\n");
  EXPECT_EQ(run(script), 0) << said_;
  for (const char* figure : {"98.78 um", "1.419 um"})
    EXPECT_NE(said_.find(figure), std::string::npos) << figure;
}

TEST_F(Pages, ExamplesOfTheFormatsAreGoodFiles) {
  const auto machines = blocks(page("tools/docs/machine_file.md"), "xml");
  const auto tables = blocks(page("tools/docs/measurement_file.md"), "csv");
  ASSERT_EQ(machines.size(), 1u);
  ASSERT_EQ(tables.size(), 1u);
  write_file(folder_ + "/m.xml", machines[0]);
  write_file(folder_ + "/meas.csv", tables[0]);
  ASSERT_EQ(run("vernier new bridge --axis X:0:600 --axis Y:0:400 --axis Z:-300:0 -o b.xml\n"
                "vernier lint m.xml --json machine.json\nvernier lint b.xml meas.csv --json meas.json\n"),
            0)
      << said_;
  for (const char* result : {"/machine.json", "/meas.json"}) {
    const nlohmann::json json = nlohmann::json::parse(read_file(folder_ + result));
    for (const auto& finding : json["findings"])
      // Two rows cannot move all axes; nothing else may be odd about an example.
      EXPECT_TRUE(finding["weight"] == "remark" ||
                  finding["what"].get<std::string>().find("never moves") != std::string::npos)
          << finding.dump();
  }
}

TEST(Links, OfTheFirstPagesLeadSomewhere) {
  for (const std::string name :
       {"README.md", "tools/docs/tutorial.md", "tools/docs/new.md", "tools/docs/lint.md",
        "tools/docs/machine_file.md", "tools/docs/measurement_file.md", "tools/docs/figures.md",
        "tools/docs/import.md", "tools/docs/board.md", "tools/docs/first_hour.md", "tools/docs/touch.md"}) {
    const std::string text = page(name);
    const fs::path folder = (fs::path(VERNIER_SOURCE_DIR) / name).parent_path();
    for (std::size_t at = 0; (at = text.find("](", at)) != std::string::npos; ++at) {
      std::string link = text.substr(at + 2, text.find(')', at) - at - 2);
      link = link.substr(0, link.find('#'));
      if (link.empty() || link.starts_with("http")) continue;
      EXPECT_TRUE(fs::exists(folder / link)) << name << ": " << link;
    }
  }
}

}  // namespace
}  // namespace vernier::pages_test
