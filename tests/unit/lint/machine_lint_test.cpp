// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/lint/machine_lint.h"

#include <gtest/gtest.h>

#include <filesystem>

#include "tools/text/files.h"

namespace vernier::machine_lint_test {

using namespace vernier::lint;
using namespace vernier::text;
namespace {

std::vector<std::string> lines_of(const std::string& text) {
  std::vector<std::string> lines;
  for (const LintFinding& finding : lint_machine(text, "m.xml").findings)
    lines.push_back(in_one_line(finding));
  return lines;
}
bool some_line_has(const std::vector<std::string>& lines, const std::string& part) {
  for (const std::string& line : lines)
    if (line.find(part) != std::string::npos) return true;
  ADD_FAILURE() << "nothing says: " << part << "\n" << testing::PrintToString(lines);
  return false;
}

TEST(MachineLint, EveryErrorIsSaidAtOnce) {
  const auto lines = lines_of(R"(<machine name="bad">
  <variables>
    <static>
      <EC0Y value="0,001" nominal="0" unit="rad"/>
      <offset value="1" unit="inch"/>
      <len value="5mm"/>
      <BaseShift X="0"/>
      <offset value="2"/>
    </static>
    <machineaxes>
      <X rotary="false" min="0" max="600" maxcorection="0.5"/>
      <Y min="0" max="400"/>
      <Q min="0" max="0.4"/>
      <B min="-90" max="90"/>
    </machineaxes>
    <comptables>
      <table axis="Xm" fit="X Y"><station loc="0"/></table>
      <table axis="X" fit="X Y rZ"><station loc="0"/><station loc="100"/><station loc="50"/></table>
    </comptables>
  </variables>
  <transforms><sixdof n="1" X="X+lXx+ofset+len" Y="Y+lXy" rZ="EC0Y*(Y" rY="B"/></transforms>
</machine>)");
  some_line_has(lines, "m.xml:4: error: \"0,001\": value must be a number -- decimal comma?");
  some_line_has(lines, "m.xml:5: warning: \"inch\": unknown unit, of offset -- did you mean in?");
  some_line_has(lines,
                "m.xml:6: error: \"5mm\": value must be a number -- write the unit as the attribute unit=");
  some_line_has(lines, "m.xml:8: error: \"offset\": this name occurs twice");
  some_line_has(lines,
                "m.xml:11: error: \"maxcorection\": unknown attribute of <X> -- did you mean maxcorrection?");
  some_line_has(lines, "m.xml:13: warning: \"Q\": no transform uses this axis");
  some_line_has(lines, "m.xml:13: warning: \"Q\": a travel of 0.4 mm -- is the travel in metres or inches?");
  some_line_has(lines, "m.xml:14: warning: \"B\": the axis has no rotary=\"true\"");
  some_line_has(lines, "m.xml:17: error: \"Xm\": the machine has no axis of this name");
  some_line_has(lines, "m.xml:18: error: \"50\": stations must increase");
  some_line_has(lines,
                "m.xml:18: warning: \"X\": the attribute fit frees the column rZ, which no transform uses");
  some_line_has(lines,
                "m.xml:21: error: \"ofset\": unknown name, in X=\"X+lXx+ofset+len\" -- did you mean offset?");
  some_line_has(lines, "m.xml:21: error: ");
  some_line_has(lines, "in rZ=\"EC0Y*(Y\"");
}

TEST(MachineLint, BrokenXmlIsOneError) {
  const auto lines = lines_of("<machine>\n<variables>\n</machine>");
  ASSERT_GE(lines.size(), 1u);
  EXPECT_NE(lines.back().find("m.xml:3: error"), std::string::npos) << lines.back();
}

TEST(MachineLint, OddMeaningsAreWarnings) {
  const MachineLint lint = lint_machine(R"(<machine><variables><static>
    <big value="80" nominal="0" unit="mm"/>
    <arc value="3" nominal="0" unit="arcsec"/></static>
    <machineaxes><X min="0" max="600" maxcorrection="125"/><A rotary="true" min="-1.57" max="1.57"/></machineaxes>
    <inputs><T unit="Celsius"/></inputs>
    <comptables><table axis="X"><station loc="0"/><station loc="900"/></table></comptables></variables>
    <transforms><sixdof X="X+lXx" rX="A" Y="big"/></transforms></machine>)",
                                        "m.xml");
  EXPECT_TRUE(lint.machine.has_value());
  std::vector<std::string> lines;
  for (const LintFinding& finding : lint.findings) {
    EXPECT_NE(finding.weight, LintWeight::kError) << in_one_line(finding);
    lines.push_back(in_one_line(finding));
  }
  some_line_has(lines, "\"big\": 80 mm off its nominal -- µm written as mm?");
  some_line_has(lines, "\"arc\": no transform uses this static");
  some_line_has(lines, "\"X\": maxcorrection of 125 mm -- is the value in µm?");
  some_line_has(lines, "\"A\": turns by 3.14 deg only -- radians?");
  some_line_has(lines, "\"Celsius\": unknown unit");
  some_line_has(lines, "\"T\": no transform uses this input");
  some_line_has(lines, "stations outside the travel");
  some_line_has(lines, "BaseShift is missing");
}

TEST(MachineLint, ReferenceMachinesHaveNothingWorseThanARemark) {
  std::size_t seen = 0;
  for (const auto& entry :
       std::filesystem::directory_iterator(std::string(VERNIER_SOURCE_DIR) + "/tables/machines")) {
    if (entry.path().extension() != ".xml") continue;
    ++seen;
    for (const LintFinding& finding :
         lint_machine(read_file(entry.path().string()), entry.path().filename().string()).findings)
      EXPECT_EQ(finding.weight, LintWeight::kRemark) << in_one_line(finding);
  }
  EXPECT_GE(seen, 12u);
}

TEST(MachineLint, NameOfAMeasuredColumnIsAnError) {
  const auto lines = lines_of(
      R"(<machine name="m"><variables><machineaxes>
<setup min="0" max="600"/>
<X min="0" max="400"/></machineaxes><inputs>
<correctionX unit="degC" reference="20"/></inputs></variables>
<transforms><sixdof X="X+0*correctionX" Y="setup"/></transforms></machine>)");
  some_line_has(lines, "m.xml:2: error: \"setup\": measurement files use this name for a measured column");
  some_line_has(lines, "m.xml:4: error: \"correctionX\": measurement files use this name");
}

}  // namespace
}  // namespace vernier::machine_lint_test
