// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/model/machine.h"
#include "tools/model/machine_reader.h"
#include "tools/model/machine_writer.h"

#include <gtest/gtest.h>

namespace vernier::machine_test {

using namespace vernier::model;
using namespace vernier::text;
namespace {

const std::string kHead = "<machine name=\"m\">\n<variables>\n<static>\n";
std::string with(const std::string& statics, const std::string& axes, const std::string& rest,
                 const std::string& x = "X") {
  return kHead + statics + "</static>\n<machineaxes>\n" + axes + "</machineaxes>\n" + rest +
         "</variables>\n<transforms>\n<sixdof n=\"1\" X=\"" + x + "\"/>\n</transforms>\n</machine>\n";
}

/// Message of the error that this text gives, or "accepted".
std::string error_of(const std::string& text) {
  try {
    parse_machine(text, "m.xml");
  } catch (const InputError& error) {
    return error.what();
  }
  return "accepted";
}

TEST(MachineFile, ReadsAllThatTheFormatNames) {
  const Machine machine = parse_machine(R"XML(<?xml version="1.0"?>
<machine name="bridge" gravity="0 0 -1">
  <variables>
    <static>
      <alpha value="1e-4" nominal="0" unit="rad" note="squareness"/>
      <TP1Z value="-80" unit="mm" Hide="true"/>
      <Flag value="False"/>
      <BaseShift X="1" rZ="0.5"/>
      <BaseShift run="s2" X="2" Hide="true"/>
    </static>
    <machineaxes>
      <X rotary="false" min="0" max="600" maxcorrection="0.125" maxslew="5" scalefactor="1e-5"/>
      <C rotary="true" rollover="true"/>
      <TP rotary="false" Hide="true"/>
    </machineaxes>
    <inputs><T_column unit="degC" reference="20"/></inputs>
    <comptables multiply="3">
      <table axis="X" interpolation="cubic" fit="X rZ">
        <station loc="0" X="0.1"/><station loc="600" rZ="0.2"/>
      </table>
    </comptables>
  </variables>
  <transforms branch="workpiece"><sixdof n="1" rZ="C"/></transforms>
  <TransForms branch="tool"><sixdof n="1" X="X+lXx" Y="alpha*X"/><DH n="2" d="TP1Z*(TP=1)"/></TransForms>
</machine>)XML",
                                        "m.xml");
  EXPECT_EQ(machine.statics.size(), 3U);
  EXPECT_EQ(machine.statics[0].nominal, 0.0);
  EXPECT_FALSE(machine.statics[0].hidden);
  EXPECT_TRUE(machine.statics[1].hidden);
  EXPECT_TRUE(machine.statics[2].hidden);  // True and False imply Hide
  EXPECT_EQ(machine.axes.size(), 2U);
  EXPECT_EQ(machine.axes[0].max_correction, 0.125);
  EXPECT_EQ(machine.inputs.size(), 2U);  // a hidden axis acts as an input
  EXPECT_TRUE(machine.inputs[0].hidden_axis);
  EXPECT_EQ(machine.tables[0].interpolation, Interpolation::kCubic);
  EXPECT_TRUE(machine.tables[0].free[0] && machine.tables[0].free[5] && !machine.tables[0].free[1]);
  EXPECT_EQ(machine.base_shifts[1].run, "s2");
  EXPECT_EQ(machine.workpiece.size(), 1U);
  EXPECT_EQ(machine.tool[1].kind, TransformKind::kDh);
  EXPECT_EQ(machine.notes.size(), 1U);
}

TEST(MachineFile, ReadsScalesToolsAndVolume) {
  const auto text = [](const std::string& volume, const std::string& scale) {
    return with("<alpha value=\"0\" unit=\"rad\" scale=\"0.002\"/>\n",
                "<X min=\"0\" max=\"600\"/>\n<Y min=\"0\" max=\"400\"/>\n",
                "<tools><long Z=\"-150\"/><bent X=\"20\" Y=\"5\"/></tools>\n<volume>" + volume +
                    "</volume>\n<comptables><table axis=\"X\" fit=\"rZ X\" scale=\"" + scale +
                    "\"><station loc=\"0\"/></table></comptables>\n");
  };
  const Machine machine = parse_machine(text("<X min=\"100\" max=\"300\"/>", "0.001 0.2"), "m.xml");
  EXPECT_EQ(machine.statics[0].scale, 0.002);
  ASSERT_EQ(machine.tools.size(), 2U);
  EXPECT_EQ(machine.tools[1].name, "bent");
  EXPECT_EQ(machine.tools[1].point, (std::array<double, 3>{20, 5, 0}));
  EXPECT_EQ(work_range(machine, 0), (std::array<double, 2>{100, 300}));
  EXPECT_EQ(work_range(machine, 1), (std::array<double, 2>{0, 400}));  // not named: all it has
  EXPECT_EQ(machine.tables[0].scale[5], 0.001);
  EXPECT_EQ(machine.tables[0].scale[0], 0.2);
  EXPECT_EQ(parse_machine(text("", "0.1"), "m.xml").tables[0].scale[5], 0.1);
  EXPECT_EQ(with_tool(machine, {1, 2, -30}).tool.size(), 2U);
  EXPECT_NE(error_of(text("<Q min=\"0\" max=\"1\"/>", "0.1")).find("the machine has no axis of this name"),
            std::string::npos);
  EXPECT_NE(error_of(text("<X min=\"0\"/>", "0.1")).find("needs a max"), std::string::npos);
  EXPECT_NE(error_of(text("", "0.1 0.2 0.3")).find("one number for each column of fit"), std::string::npos);
  EXPECT_NE(error_of(text("", "-1")).find("greater than 0"), std::string::npos);
}

TEST(MachineFile, ReadsWhatIsCorrected) {
  const auto text = [](const std::string& correct) {
    return "<machine><variables><machineaxes correct=\"" + correct +
           "\"><X/></machineaxes></variables><transforms><sixdof X=\"X\"/></transforms></machine>";
  };
  EXPECT_FALSE(parse_machine(text("position"), "m.xml").correct_orientation);
  EXPECT_TRUE(parse_machine(text("position orientation"), "m.xml").correct_orientation);
  EXPECT_NE(error_of(text("orientation")).find("correct must be"), std::string::npos);
  EXPECT_NE(error_of(text("position tilt")).find("tilt"), std::string::npos);
}

TEST(MachineFile, ErrorsNameFileLineAndWord) {
  EXPECT_EQ(error_of(with("<k value=\"1\"/>\n", "<X/>\n", "", "X+alhpa")).substr(0, 44),
            "m.xml:11: \"alhpa\": unknown name, in X=\"X+alh");
  EXPECT_EQ(error_of(with("<k value=\"one\"/>\n", "<X/>\n", "")), "m.xml:4: \"one\": value must be a number");
  EXPECT_EQ(error_of(with("<k value=\"1\"/>\n<k value=\"2\"/>\n", "<X/>\n", "")),
            "m.xml:5: \"k\": this name occurs twice");
  EXPECT_EQ(error_of(with("<t value=\"1\"/>\n", "<X/>\n", "")), "m.xml:4: \"t\": this name is reserved");
  EXPECT_EQ(error_of(with("<vX value=\"1\"/>\n", "<X/>\n", "")),
            "m.xml:4: \"vX\": this name is already a quantity of the axes");
  EXPECT_EQ(error_of(with("<k value=\"1\" valu=\"2\"/>\n", "<X/>\n", "")),
            "m.xml:4: \"valu\": unknown attribute of <k>");
  const std::string table =
      "<comptables><table axis=\"X\">\n<station loc=\"1\"/>\n<station loc=\"1\"/></table></comptables>\n";
  EXPECT_EQ(error_of(with("", "<X/>\n", table)), "m.xml:10: \"1\": stations must increase");
}

TEST(MachineFile, OtherEncodingsThanUtf8AreRefused) {
  const auto said = [](const std::string& text) {
    try {
      parse_machine(text, "m.xml");
    } catch (const text::InputError& error) {
      return std::string(error.what());
    }
    return std::string("accepted");
  };
  const std::string body = "<transforms branch=\"tool\"><sixdof n=\"1\"/></transforms></machine>";
  EXPECT_EQ(
      said("<machine\nname=\"Dr\xFC\x63ker\">" + body),
      "m.xml:2: \"?cker\"><transforms\": this letter is not UTF-8: save the file as UTF-8, or convert it: "
      "iconv -f WINDOWS-1252 -t UTF-8");
  EXPECT_NE(said("<?xml version=\"1.0\" encoding=\"windows-1251\"?><machine name=\"\xD1\">" + body)
                .find("iconv -f windows-1251 -t"),
            std::string::npos);
  std::string wide = "\xFF\xFE";
  for (const char c : "<machine>" + body) wide += std::string{c, '\0'};
  EXPECT_EQ(said(wide), "m.xml:1: the file is UTF-16 or UTF-32, not UTF-8: save it as UTF-8");
  EXPECT_EQ(said(wide.substr(2)), "m.xml:1: the file is UTF-16 or UTF-32, not UTF-8: save it as UTF-8");
  EXPECT_EQ(said("<machine name=\"Dr\xC3\xBC\x63ker\">" + body), "accepted");
}

TEST(MachineFile, RefusesWhatItWouldOtherwiseHaveToGuess) {
  for (const std::string& text :
       {with("<k value=\"1e999\"/>", "<X/>", ""), with("<k value=\"0x10\"/>", "<X/>", ""),
        with("<k/>", "<X/>", ""), with("<k value=\"1\">2</k>", "<X/>", ""),
        with("<sin value=\"1\"/>", "<X/>", ""), with("", "<X min=\"3\" max=\"1\"/>", ""),
        with("", "<X rotary=\"maybe\"/>", ""), with("<BaseShift X=\"1\"/><BaseShift X=\"2\"/>", "<X/>", ""),
        with("", "<X/>", "<comptables><table axis=\"Q\"><station loc=\"1\"/></table></comptables>"),
        with("", "<X/>", "<comptables><table axis=\"X\"></table></comptables>"),
        with("", "<X/>",
             "<comptables><table axis=\"X\" fit=\"X Q\"><station loc=\"1\"/></table></comptables>"),
        with("", "<X/>", "<suprise/>"), with("", "<X/>", "", "run(s1)"), std::string("<machine/>"),
        std::string(), std::string("<!DOCTYPE machine><machine/>"),
        std::string("<machine><machine/></machine>"), std::string("<robot/>"),
        with("", "<X/>", "") + "<machine/>"})
    EXPECT_NE(error_of(text), "accepted") << text;
  EXPECT_EQ(error_of(with("", "<X/>", "")), "accepted");
}

TEST(MachineFile, NominalMachineHasNoErrors) {
  Machine machine = parse_machine(
      with("<k value=\"3\" nominal=\"1\"/><h value=\"7\" Hide=\"true\"/>", "<X scalefactor=\"0.1\"/>",
           "<comptables><table axis=\"X\"><station loc=\"0\" X=\"5\"/></table></comptables>"),
      "m.xml");
  const Machine nominal = nominal_machine(machine);
  EXPECT_EQ(nominal.statics[0].value, 1);
  EXPECT_EQ(nominal.statics[1].value, 7);
  EXPECT_EQ(nominal.axes[0].scale_factor, 0);
  EXPECT_EQ(nominal.tables[0].stations[0].value[0], 0);
}

TEST(MachineFile, WritesValuesBackAndKeepsEverythingElse) {
  const std::string text =
      with("<!-- my note --><k  value='1' unit=\"mm\"/>\n<h value=\"7\" Hide=\"true\"/><BaseShift X=\"0\"/>",
           "<X/>", "<comptables><table axis=\"X\" fit=\"X\"><station loc=\"0\"/></table></comptables>");
  Machine machine = parse_machine(text, "m.xml");
  machine.statics[0].value = 0.1;
  machine.base_shifts[0].value[5] = -2.5;
  machine.tables[0].stations[0].value[0] = 4;
  const std::string written = update_machine_text(text, machine, true);
  const Machine again = parse_machine(written, "m.xml");
  EXPECT_EQ(again.statics[0].value, 0.1);
  EXPECT_EQ(again.statics[0].nominal, 1.0);  // the start value
  EXPECT_FALSE(again.statics[1].nominal);    // hidden: untouched
  EXPECT_EQ(again.base_shifts[0].value[5], -2.5);
  EXPECT_EQ(again.tables[0].stations[0].value[0], 4);
  EXPECT_NE(written.find("<!-- my note --><k  value='0.1'"), std::string::npos);
}

// Whoever edits a machine's text walks down its elements: half a million of them, one in the other, ended the
// program that wrote a fit back.
TEST(Machine, ElementsWithoutEndInsideOneAnotherAreRefusedWithTheirLine) {
  std::string nested;
  for (int i = 0; i < 500'000; ++i) nested += "<a>";
  for (int i = 0; i < 500'000; ++i) nested += "</a>";
  const std::string head =
      "<machine name=\"m\"><variables><machineaxes><X/></machineaxes></variables>"
      "<transforms><sixdof n=\"1\" X=\"X\"/></transforms>\n<fitted rms=\"0\" worst=\"1\"><measured>\n"
      "<X min=\"0\" max=\"1\"";
  const std::string tail = "</measured></fitted></machine>";
  EXPECT_NO_THROW(parse_machine(head + "/>" + tail, "m.xml"));
  for (const std::string& inside : {nested, std::string("<a/>")}) {
    try {
      parse_machine(head + ">" + inside + "</X>" + tail, "m.xml");
      ADD_FAILURE() << "accepted";
    } catch (const InputError& error) {
      EXPECT_EQ(std::string(error.what()).find("m.xml:3: \"a\": "), 0u) << error.what();
    }
  }
}

}  // namespace
}  // namespace vernier::machine_test
