// SPDX-License-Identifier: GPL-3.0-or-later
#include <gtest/gtest.h>

#include <algorithm>
#include <set>
#include <string>
#include <string_view>
#include <vector>

#include "tests/unit/house/tracked_files.h"

namespace vernier::house {
namespace {

bool has_ending(std::string_view path, const std::vector<std::string_view>& endings) {
  return std::any_of(endings.begin(), endings.end(),
                     [&](std::string_view end) { return path.ends_with(end); });
}

// Sources that a header of their name declares. A test, a bench and a command are programs or parts of one.
bool wants_header(std::string_view path) {
  const std::vector<std::string_view> folders = {"comp/",     "tables/", "hal/",
                                                 "firmware/", "tools/",  "tests/support/"};
  return path.ends_with(".cpp") && !path.starts_with("tools/commands/") &&
         std::any_of(folders.begin(), folders.end(), [&](std::string_view f) { return path.starts_with(f); });
}

// `headers`: all of the repository. A port's own version of a function of the core stands under the name of
// the core's header, which it includes.
bool is_paired(std::string_view path, const std::string& text, const std::set<std::string>& headers) {
  const std::string stem(path.substr(0, path.size() - 4));
  if (headers.contains(stem + ".h") || text.find("\nint main(") != std::string::npos) return true;
  const std::string name = stem.substr(stem.rfind('/') + 1);
  return text.find("/" + name + ".h\"\n") != std::string::npos;
}

TEST(Sources, MissingHeaderIsDetected) {
  EXPECT_TRUE(wants_header("tools/fit/a.cpp"));
  EXPECT_FALSE(wants_header("tools/commands/a.cpp"));
  EXPECT_FALSE(is_paired("tools/fit/a.cpp", "#include \"tools/fit/b.h\"\n", {"tools/fit/b.h"}));
  EXPECT_TRUE(is_paired("tools/fit/a.cpp", "", {"tools/fit/a.h"}));
  EXPECT_TRUE(is_paired("tools/fit/a.cpp", "\nint main() {}", {}));
  EXPECT_TRUE(is_paired("firmware/daemon/a.cpp", "#include \"firmware/core/a.h\"\n", {}));
}

TEST(Sources, HaveAHeaderOfTheirName) {
  const auto files = tracked_files();
  if (files.empty()) GTEST_SKIP() << "not a git checkout: no list of tracked files";
  const std::set<std::string> headers(files.begin(), files.end());
  std::size_t seen = 0;
  for (const std::string& file : files) {
    if (!wants_header(file)) continue;
    ++seen;
    EXPECT_TRUE(is_paired(file, text_of(file), headers)) << file << " has no header of its name";
  }
  EXPECT_GT(seen, 200u) << "the walk over the sources found next to nothing";
}

// What a person wrote as program text, by its ending or its first line.
bool wants_licence(std::string_view path, std::string_view text) {
  if (path.starts_with("tests/data/") || path.starts_with("tests/golden/")) return false;
  return text.starts_with("#!") || path.ends_with("CMakeLists.txt") ||
         has_ending(path, {".h", ".cpp", ".in", ".c", ".S", ".ld", ".js", ".mjs", ".css", ".html", ".cmake",
                           ".sh", ".awk", ".dtsi", ".service"});
}

// As LICENSE has it: what runs beside a machine, and the rest; what LinuxCNC loads is made with its headers.
std::string_view licence_of(std::string_view path) {
  if (path.starts_with("firmware/linuxcnc/")) return "GPL-3.0-or-later";
  static const std::set<std::string_view> kBesideAMachine = {"comp", "tables", "hal", "firmware"};
  return kBesideAMachine.contains(path.substr(0, path.find('/'))) ? "Apache-2.0" : "GPL-3.0-or-later";
}

// Its licence line stands at the top, behind what must be first.
bool says_its_licence(std::string_view path, std::string_view text) {
  std::size_t end = 0;
  for (int line = 0; line < 2 && end != std::string_view::npos; ++line) end = text.find('\n', end + 1);
  const std::string wanted = std::string("SPDX-License-") + "Identifier: " + std::string(licence_of(path));
  return text.substr(0, end).find(wanted) != std::string_view::npos;
}

TEST(Sources, MissingOrWrongLicenceIsDetected) {
  const std::string gpl = std::string("// SPDX-License-") + "Identifier: GPL-3.0-or-later\n";
  EXPECT_TRUE(says_its_licence("tools/a.cpp", gpl));
  EXPECT_TRUE(says_its_licence("tools/build", "#!/bin/sh\n" + gpl));
  EXPECT_FALSE(says_its_licence("comp/a.cpp", gpl));
  EXPECT_TRUE(says_its_licence("firmware/linuxcnc/a.cpp", gpl));
  EXPECT_FALSE(says_its_licence("tools/a.cpp", "int a;\nint b;\n" + gpl));
  EXPECT_TRUE(wants_licence("tests/run", "#!/usr/bin/env bash\n"));
  EXPECT_FALSE(wants_licence("README.md", "# Vernier"));
}

TEST(Sources, SayTheirLicence) {
  const auto files = tracked_files();
  if (files.empty()) GTEST_SKIP() << "not a git checkout: no list of tracked files";
  std::size_t seen = 0;
  for (const std::string& file : files) {
    const std::string text = text_of(file);
    if (!wants_licence(file, text)) continue;
    ++seen;
    EXPECT_TRUE(says_its_licence(file, text)) << file << " does not say " << licence_of(file);
  }
  EXPECT_GT(seen, 500u) << "the walk over the sources found next to nothing";
}

// Of a room of tools: `import` begins a module directive of C++20 where it stands first in a line.
std::string namespace_of(const std::string& room) {
  return "vernier::" + (room == "import" ? "importer" : room);
}

TEST(Sources, OfARoomStandInItsNamespace) {
  const auto files = tracked_files();
  if (files.empty()) GTEST_SKIP() << "not a git checkout: no list of tracked files";
  std::size_t seen = 0;
  for (const std::string& file : files) {
    if (!file.starts_with("tools/") || !has_ending(file, {".h", ".cpp"})) continue;
    const std::string room = file.substr(6, file.find('/', 6) - 6);
    const std::string text = text_of(file);
    for (std::size_t at = 0; (at = text.find("\nnamespace vernier", at)) != std::string::npos; ++at) {
      const std::string name = text.substr(at + 11, text.find(' ', at + 11) - at - 11);
      EXPECT_TRUE(name == namespace_of(room) || name.starts_with(namespace_of(room) + "::"))
          << file << " opens " << name;
      ++seen;
    }
  }
  EXPECT_GT(seen, 300u) << "the walk over the sources found next to nothing";
}

// What costs a compiler seconds stands in tools/maths once (decompositions.h); a matrix of a size that is
// known when it is compiled is cheap and free.
std::string decomposition_in(const std::string& text) {
  for (const char* word : {"completeOrthogonalDecomposition", "colPivHouseholderQr", "householderQr()",
                           "partialPivLu", "fullPivLu", "bdcSvd", "jacobiSvd", "BDCSVD", "umeyama"})
    if (text.find(word) != std::string::npos) return word;
  return "";
}

/// "constexpr double", "inline constexpr std::size_t" ...
bool is_number(std::string_view declared) {
  for (const std::string_view word : {"static ", "inline "})
    if (declared.starts_with(word)) declared.remove_prefix(word.size());
  const std::vector<std::string_view> types = {"double",      "int",   "unsigned",
                                               "std::size_t", "Index", "Eigen::Index"};
  if (!declared.starts_with("constexpr ")) return false;
  declared.remove_prefix(std::string_view("constexpr ").size());
  return std::find(types.begin(), types.end(), declared) != types.end() ||
         declared.starts_with("std::uint") || declared.starts_with("std::int");
}

/// The first line on which a number gets a name and nothing says what it stands for: no comment on it or
/// above, nor above the constants that it follows. What converts units (kUmPerMm) says so itself; empty:
/// none.
std::string number_without_a_word(const std::string& text) {
  bool said = false;
  std::size_t begin = 0;
  while (begin < text.size()) {
    const std::size_t end = std::min(text.find('\n', begin), text.size());
    std::string line = text.substr(begin, end - begin);
    begin = end + 1;
    line.erase(0, line.find_first_not_of(' '));
    const std::size_t name = line.find(" k"), equals = line.find(" = ");
    const bool number = is_number(line.substr(0, std::min(name, line.size()))) &&
                        equals != std::string::npos && name < equals &&
                        line.find_first_of("0123456789", equals) != std::string::npos &&
                        line.find('[', name) > equals;
    if (!number) {
      said = line.starts_with("//");
      continue;
    }
    const bool converts = line.substr(name, equals - name).find("Per") != std::string::npos ||
                          line.find("std::numbers::", equals) != std::string::npos;
    // A long one is broken after its "=" or before its comment.
    const bool goes_on = end < text.size() && line.find(';') == std::string::npos;
    said = said || converts || goes_on || line.find("//") != std::string::npos;
    if (!said) return line;
  }
  return "";
}

TEST(Sources, NumberWithoutAWordIsDetected) {
  EXPECT_EQ(number_without_a_word("int a;\n  constexpr double kMost = 3;\n"), "constexpr double kMost = 3;");
  EXPECT_EQ(number_without_a_word("  constexpr double kMost = 3;  // times the noise\n"), "");
  EXPECT_EQ(number_without_a_word("// times\nconstexpr int kA = 1;\nconstexpr int kB = 2;\n"), "");
  EXPECT_EQ(number_without_a_word("constexpr double kUmPerMm = 1e3;\n"), "");
}

TEST(Sources, NumbersThatWereChosenSayWhatTheyAre) {
  // Rooms that measure and judge.
  const std::vector<std::string> rooms = {
      "check",      "compile",  "derive", "diagnose", "effects",  "evaluate",  "fit",      "import",
      "kinematics", "lint",     "map",    "maths",    "model",    "offline",   "part",     "plan",
      "probe",      "residual", "safety", "simulate", "timebase", "tolerance", "vibration"};
  std::size_t seen = 0;
  for (const std::string& file : tracked_files()) {
    const bool judges = std::any_of(rooms.begin(), rooms.end(), [&](const std::string& room) {
      return file.starts_with("tools/" + room + "/");
    });
    if (!judges || !has_ending(file, {".h", ".cpp"})) continue;
    ++seen;
    EXPECT_EQ(number_without_a_word(text_of(file)), "") << file;
  }
  if (seen == 0) GTEST_SKIP() << "not a git checkout: no list of tracked files";
}

TEST(Sources, DecompositionIsDetected) {
  EXPECT_EQ(decomposition_in("x = a.colPivHouseholderQr().solve(b);"), "colPivHouseholderQr");
  EXPECT_EQ(decomposition_in("x = maths::least_squares(a, b);"), "");
}

TEST(Sources, DecompositionsOfAnySizeStandInMaths) {
  std::size_t seen = 0;
  for (const std::string& file : tracked_files()) {
    if (!has_ending(file, {".h", ".cpp"}) || file.starts_with("tools/maths/") ||
        file.starts_with("tests/unit/house/"))
      continue;
    ++seen;
    EXPECT_EQ(decomposition_in(text_of(file)), "") << file;
  }
  if (seen == 0) GTEST_SKIP() << "not a git checkout: no list of tracked files";
}

}  // namespace
}  // namespace vernier::house
