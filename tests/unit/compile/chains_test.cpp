// SPDX-License-Identifier: GPL-3.0-or-later
// Chains that ask for more than three slides with fixed directions.
#include <gtest/gtest.h>

#include "tests/unit/compile/agreement.h"
#include "tools/model/machine_reader.h"

namespace vernier::chains_test {

using namespace vernier::compile;
using namespace vernier::model;
using namespace vernier::text;
namespace {

constexpr unsigned kSeed = 77;

std::string machine_text(const std::string& statics, const std::string& axes, const std::string& tables,
                         const std::string& transforms) {
  return "<machine name=\"chain\"><variables><static>" + statics + "</static><machineaxes>" + axes +
         "</machineaxes><comptables>" + tables + "</comptables></variables>" + transforms + "</machine>";
}

Agreement seen_of(const std::string& text, std::size_t poses = 4000) {
  const TestMachine test(parse_machine(text, "m.xml"), text);
  const Agreement seen = compare(test, 1, poses, kSeed);
  std::printf("%zu operations, deviation up to %.2f um, %.6f um seen, %.6f um proved, share %.3f\n",
              test.compiled.program.instructions.size(), seen.largest_um, seen.worst_um,
              largest_bound_um(test.compiled), seen.worst_share);
  for (const std::string& note : test.compiled.notes) std::printf("  note: %s\n", note.c_str());
  EXPECT_LE(seen.worst_share, 1.0);
  EXPECT_GT(seen.largest_um, 5.0);
  EXPECT_GT(seen.poses, poses / 2);
  return seen;
}

constexpr const char* kXyz =
    "<X rotary=\"false\" min=\"-200\" max=\"200\"/><Y rotary=\"false\" min=\"-100\" max=\"300\"/>"
    "<Z rotary=\"false\" min=\"0\" max=\"400\"/>";
constexpr const char* kErrors =
    "<sq value=\"0.004\" nominal=\"0\" unit=\"deg\"/><tilt value=\"-0.006\" nominal=\"0\" unit=\"deg\"/>"
    "<off value=\"0.03\" nominal=\"0\" unit=\"mm\"/>";

TEST(Chain, TableTurnsBelowALinearAxis) {
  // C carries the slide Y: Y's direction against X and Z turns with C, and J(q) is a turn that never gets
  // flat.
  seen_of(machine_text(kErrors, std::string(kXyz) + "<C rotary=\"true\" min=\"-60\" max=\"60\"/>", "",
                       "<transforms branch=\"workpiece\"><sixdof n=\"1\" rX=\"tilt\" rZ=\"C\"/>"
                       "<sixdof n=\"2\" Y=\"-Y\" rX=\"sq\"/></transforms>"
                       "<transforms branch=\"tool\"><sixdof n=\"1\" X=\"X+off\" rZ=\"sq\"/>"
                       "<sixdof n=\"2\" Z=\"Z\" rY=\"tilt\"/></transforms>"));
}

TEST(Chain, HeadTurnsBeforeAQuill) {
  // X and Y stay, the quill W follows the head B; all turns of B keep J(q) regular.
  seen_of(
      machine_text(kErrors,
                   "<X rotary=\"false\" min=\"-200\" max=\"200\"/><Y rotary=\"false\" min=\"-100\" "
                   "max=\"300\"/><W rotary=\"false\" min=\"50\" max=\"250\"/><B rotary=\"true\" min=\"-45\" "
                   "max=\"45\"/>",
                   "",
                   "<transforms branch=\"tool\"><sixdof n=\"1\" X=\"X\" rZ=\"sq\"/>"
                   "<sixdof n=\"2\" Y=\"Y\" rX=\"tilt\"/><sixdof n=\"3\" X=\"off\" rY=\"B+0.3*tilt*sin(B)\"/>"
                   "<sixdof n=\"4\" Z=\"-W\" rX=\"sq\"/></transforms>"));
}

TEST(Chain, RotaryAxesReachWhatTheLinearOnesDoNot) {
  // A lathe: X and Z, and the spindle C that moves the tool point across them.
  seen_of(
      machine_text(kErrors,
                   "<X rotary=\"false\" min=\"40\" max=\"200\"/><Z rotary=\"false\" min=\"0\" max=\"300\"/>"
                   "<C rotary=\"true\" min=\"-180\" max=\"180\"/>",
                   "",
                   "<transforms branch=\"workpiece\"><sixdof n=\"1\" rX=\"tilt\" rZ=\"C\"/></transforms>"
                   "<transforms branch=\"tool\"><sixdof n=\"1\" Z=\"Z\" rZ=\"sq\"/>"
                   "<sixdof n=\"2\" X=\"X\" Y=\"off\"/></transforms>"));
}

TEST(Chain, PlanarArmIsCorrectedInItsPlane) {
  const std::string text = machine_text(
      "<z1 value=\"0.01\" nominal=\"0\" unit=\"deg\"/><z2 value=\"-0.02\" nominal=\"0\" unit=\"deg\"/>"
      "<a1 value=\"300.2\" nominal=\"300\" unit=\"mm\"/><a2 value=\"249.9\" nominal=\"250\" unit=\"mm\"/>",
      "<J1 rotary=\"true\" min=\"-150\" max=\"150\"/><J2 rotary=\"true\" min=\"20\" max=\"150\"/>", "",
      "<transforms branch=\"tool\"><DH n=\"1\" theta=\"J1+z1\" d=\"0\" a=\"a1\" alpha=\"0\"/>"
      "<DH n=\"2\" theta=\"J2+z2\" d=\"0\" a=\"a2\" alpha=\"0\"/></transforms>");
  seen_of(text);
}

TEST(Chain, LargeConstantAnglesAndScaleFactors) {
  seen_of(machine_text(
      kErrors,
      "<X rotary=\"false\" min=\"-200\" max=\"200\" scalefactor=\"2e-5\"/><Y rotary=\"false\" "
      "min=\"-100\" max=\"300\" scalefactor=\"-1e-5\"/><Z rotary=\"false\" min=\"0\" max=\"400\"/>",
      "",
      "<transforms branch=\"workpiece\"><sixdof n=\"1\" rX=\"90\" rY=\"35\" rZ=\"-120+tilt\"/>"
      "<DH n=\"2\" theta=\"17\" d=\"-Y+off\" a=\"80\" alpha=\"-90+sq\"/></transforms>"
      "<transforms branch=\"tool\"><sixdof n=\"1\" X=\"X\" rY=\"tilt\" rZ=\"41\"/>"
      "<sixdof n=\"2\" Z=\"Z\" rX=\"180+sq\"/><sixdof n=\"3\" X=\"12\" Z=\"-75\"/></transforms>"));
}

TEST(Chain, RolloverTableIsAPeriodicSpline) {
  seen_of(machine_text(
      kErrors, std::string(kXyz) + "<C rotary=\"true\" rollover=\"true\" min=\"-720\" max=\"720\"/>",
      "<table axis=\"C\" interpolation=\"cubic\">"
      "<station loc=\"-30\" X=\"0.01\" Y=\"0\" Z=\"0.004\" rX=\"0.002\" rY=\"0\" rZ=\"0.001\"/>"
      "<station loc=\"60\" X=\"-0.01\" Y=\"0.006\" Z=\"0\" rX=\"0\" rY=\"-0.003\" rZ=\"0.004\"/>"
      "<station loc=\"200\" X=\"0\" Y=\"-0.02\" Z=\"-0.01\" rX=\"-0.001\" rY=\"0.002\" rZ=\"-0.002\"/>"
      "<station loc=\"330\" X=\"0.01\" Y=\"0\" Z=\"0.004\" rX=\"0.002\" rY=\"0\" rZ=\"0.001\"/></table>",
      "<transforms branch=\"workpiece\"><sixdof n=\"1\" X=\"lCx\" Y=\"lCy\" Z=\"lCz\" rX=\"rCx\" rY=\"rCy\" "
      "rZ=\"C+rCz\"/></transforms><transforms branch=\"tool\"><sixdof n=\"1\" X=\"X+off\" rZ=\"sq\"/>"
      "<sixdof n=\"2\" Y=\"Y\" Z=\"Z\" rY=\"tilt\"/></transforms>"));
}

TEST(Chain, ToolNumberSelectsTheTool) {
  const std::string text = machine_text(
      "<L1 value=\"80\" Hide=\"true\"/><L2 value=\"233.5\" Hide=\"true\"/><L3 value=\"-41\" Hide=\"true\"/>" +
          std::string(kErrors),
      std::string(kXyz) + "<TP rotary=\"false\" Hide=\"true\"/>", "",
      "<transforms branch=\"tool\"><sixdof n=\"1\" X=\"X+off\" rY=\"tilt\" rZ=\"sq\"/>"
      "<sixdof n=\"2\" Y=\"Y\" Z=\"Z\" rX=\"tilt*(TP&gt;0)\"/>"
      "<sixdof n=\"3\" X=\"L3*(TP=2)\" Z=\"-L1*(TP=1)-L2*(TP=2)-L3*(TP=-3)\"/></transforms>");
  seen_of(text, 20000);
  // Each tool gives another correction at one pose: the comparison with the number is exact.
  const TestMachine test(parse_machine(text, "m.xml"), text);
  Compensator compensator(test.loaded->view.program());
  std::set<std::int32_t> seen;
  for (const std::int64_t tool : {0, 1, 2, -3}) {
    CycleInput input;
    input.input[0] = InputMicro(tool * 1000000);
    seen.insert(compensator.step(input).correction[0].counts);
    compensator.reset();
  }
  EXPECT_EQ(seen.size(), 4u);
}

TEST(Chain, LagWithATimeConstantFromStatics) {
  const std::string transforms =
      "<transforms branch=\"tool\"><sixdof n=\"1\" X=\"X+k*lag(vX,@)\"/><sixdof n=\"2\" Y=\"Y\" Z=\"Z\"/>"
      "</transforms>";
  const auto with = [&](const std::string& tau) {
    std::string t = transforms;
    t.replace(t.find('@'), 1, tau);
    return machine_text(
        "<k value=\"1e-5\" nominal=\"0\" unit=\"s\"/><t1 value=\"20\" nominal=\"20\" unit=\"s\"/>", kXyz, "",
        t);
  };
  const std::string constant = with("2*t1+sqrt(t1)"), varying = with("t1+abs(Y)");
  EXPECT_NO_THROW(compile_machine(parse_machine(constant, "m.xml"), constant, {}));
  try {
    compile_machine(parse_machine(varying, "m.xml"), varying, {});
    FAIL() << "a time constant that varies";
  } catch (const InputError& error) {
    EXPECT_NE(std::string(error.what()).find("lag(vX,t1+abs(Y))"), std::string::npos) << error.what();
    EXPECT_NE(std::string(error.what()).find("time constant of a lag must be constant"), std::string::npos);
  }
}

}  // namespace
}  // namespace vernier::chains_test
