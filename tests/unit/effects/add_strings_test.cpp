// SPDX-License-Identifier: GPL-3.0-or-later
// The argument of `vernier add`: short ones that people write, bad ones, and what becomes of the file.
#include <gtest/gtest.h>

#include "tests/unit/effects/candidates.h"
#include "tools/effects/add.h"
#include "tools/effects/add_string.h"
#include "tools/model/machine_reader.h"
#include "tools/text/error.h"

namespace vernier::add_strings_test {

using namespace vernier::effects;
using namespace vernier::model;
using namespace vernier::text;
namespace {

constexpr const char* kText = R"xml(<?xml version="1.0"?>
<!-- the shop's own words: "keep me" -->
<Machine name="small" gravity="0 0 -1">
  <variables>
    <static>
      <!-- first -->
      <alpha value="0.001" nominal="0" unit="rad"/>
      <staticX value="0.5"></staticX> <!-- </static> in a remark -->
    </static>
    <machineaxes>
      <X rotary="false" min="0" max="600"/> <Y min="0" max="400"/> <Z min="-300" max="0"/> <L/>
    </machineaxes>
    <inputs><T_room unit="degC" reference="21"/></inputs>
  </variables>
  <transforms branch="workpiece"><sixdof Y="-Y"/></transforms>
  <transforms>
    <sixdof rX="alpha"/>
    <sixdof x='X' Y="0" Z="X&gt;100" rX="0.0"/>
    <DH n="5" d="Z" a="L"/>
  </transforms>
</Machine>
)xml";

Machine small() { return parse_machine(kText, "small.xml"); }

Candidate candidate(const std::string& add) {
  const Machine machine = small();
  return make_candidate(machine, parse_add_string(add, machine, built_in_effects()));
}
/// The first term and where it stands.
std::string term(const std::string& add) {
  const Machine machine = small();
  const Candidate one = candidate(add);
  return fmt::format("{} {} {}: {}", one.terms[0].place.workpiece ? "workpiece" : "tool",
                     transform_at(machine, one.terms[0].place).n, dof_name(machine, one.terms[0].place),
                     one.terms[0].text);
}
std::string added(const std::string& add) { return add_to_machine_text(kText, small(), candidate(add)); }

TEST(AddString, IsFilledWithTheAxisOwnPlaceAndTheFirstForm) {
  EXPECT_EQ(term("backlash:axis=X"), "tool 2 X: backlash_X*dirX");
  EXPECT_EQ(term("backlash:axis=Y"), "workpiece 1 Y: backlash_Y*dirY");
  EXPECT_EQ(term("scale-error:axis=Z"), "tool 5 d: scale_error_Z*Z");
  EXPECT_EQ(term("thermal-scale:axis=X,input=T_x,unit=degC"), "tool 2 X: thermal_scale_X_T_x*X*(T_x-20)");
  EXPECT_EQ(term("thermal-scale:axis=X,input=T_room"), "tool 2 X: thermal_scale_X_T_room*X*(T_room-21)");
  EXPECT_EQ(term("thermal-scale:axis=X,input=T_x,unit=K"), "tool 2 X: thermal_scale_X_T_x*X*(T_x-293.15)");
  EXPECT_EQ(term("squareness:axis=X,dof=Y"), "tool 2 Y: squareness_X_Y2*X");
  EXPECT_EQ(term("offset:branch=tool,transform=5,dof=a"), "tool 5 a: offset_a5");
  EXPECT_EQ(term("gravity-sag:axis=Z,transform=1,dof=rX,branch=tool"), "tool 1 rX: gravity_sag_Z_rX1*Z");
  EXPECT_EQ(term("custom:branch=tool,transform=2,dof=X,term=k*X*dirX"), "tool 2 X: custom_X2*X*dirX");
  EXPECT_EQ(term("backlash:transform=2,branch=tool,dof=X"), "tool 2 X: backlash_X*dirX");
}

/// On an axis whose slide runs against its reading (Y="-Y" of a table) a shared coefficient turns its sign:
/// the lag of the clock is the same on all axes.
TEST(AddString, TermsOfSeveralAxesFollowTheSenseOfEach) {
  const Candidate sync = candidate("time-sync");
  ASSERT_EQ(sync.terms.size(), 4u);
  EXPECT_EQ(sync.terms[0].text, "time_sync*vX");
  EXPECT_EQ(sync.terms[1].text, "-time_sync*vY");
  EXPECT_TRUE(sync.terms[1].place.workpiece);
  const Candidate pair = candidate("servo-mismatch:axis=X,axis2=Y");
  EXPECT_EQ(pair.terms[0].text, "servo_mismatch_X*vX");
  EXPECT_EQ(pair.terms[1].text, "-(-servo_mismatch_X*vY)");
}

/// Directly after a reversal the error is still that of the other direction: the limit for a short travel is
/// the term of a backlash.
TEST(AddString, AReversalErrorThatBuildsUpBeginsAtThatOfTheOtherDirection) {
  EXPECT_EQ(candidate("hysteresis:axis=X,start.L=40").terms.at(0).text,
            "hysteresis_X_k*dirX*(1-2*exp(-sinceX/hysteresis_X_L))");
  EXPECT_EQ(candidate("hysteresis:axis=X,form=ramp,start.W=40").terms.at(0).text,
            "hysteresis_X_k*dirX*min(1,2*sinceX/hysteresis_X_W-1)");
  EXPECT_EQ(candidate("hysteresis:axis=X,start.L=40").choice.place->transform,
            candidate("backlash:axis=X").choice.place->transform);
}

TEST(AddString, AnAxisNamedLikeAnUnknownStaysAnAxis) {
  const Candidate spike = candidate("reversal-spike:axis=L,start.L=3");
  EXPECT_EQ(spike.terms[0].text, "reversal_spike_L_k*dirL*exp(-sinceL/reversal_spike_L_L)");
  EXPECT_EQ(term("straightness:axis=L,dof=d,form=square"), "tool 5 d: straightness_L_d5*L^2");
  EXPECT_EQ(term("load-deflection:input=k,unit=N,transform=2,branch=tool,dof=Y"),
            "tool 2 Y: load_deflection_k_Y2*k");
}

TEST(AddString, ComplianceIsForJointsThatGravityTurns) {
  // GIVEN a slide, a turntable on a vertical axis and a level joint
  const Machine machine = parse_machine(
      "<machine gravity=\"0 0 -1\"><variables><machineaxes><X min=\"0\" max=\"600\"/><C rotary=\"true\" "
      "min=\"0\" max=\"360\"/><A rotary=\"true\" min=\"-90\" max=\"90\"/></machineaxes></variables>"
      "<transforms><sixdof X=\"X\"/><sixdof rZ=\"C\"/><sixdof rX=\"A\" Z=\"300\"/></transforms></machine>",
      "m.xml");
  const auto why_not = [&](const std::string& add) -> std::string {
    try {
      make_candidate(machine, parse_add_string(add, machine, built_in_effects()));
    } catch (const InputError& error) {
      return error.what();
    }
    return "";
  };
  EXPECT_NE(why_not("joint-compliance:axis=X").find("rotary joint"), std::string::npos);
  EXPECT_NE(why_not("joint-compliance:axis=C").find("gravity has no moment about the joint"),
            std::string::npos);
  EXPECT_EQ(why_not("joint-compliance:axis=A"), "");
}

TEST(AddString, ACustomTermMayUseALoggedColumn) {
  EXPECT_EQ(term("custom:input=T_q,unit=degC,branch=tool,transform=2,dof=X,term=k*(T_q-20)*X"),
            "tool 2 X: custom_T_q_X2*(T_q-20)*X");
}

TEST(AddString, AResponseMayHaveFiveThermometers) {
  const std::string add =
      "thermal-response:axis=X,input=T1,input2=T2,input3=T3,input4=T4,input5=T5,branch=tool,transform=2,"
      "reference=20,"
      "unit=degC,unit2=degC,unit3=degC,unit4=degC,unit5=degC,term=X:k1*(T1-20)+k2*(lag(T2,60)-20)+k3*(T3-20)|"
      "Y:k4*(T4-20)+k5*X*(T5-20)";
  const Candidate one = candidate(add);
  EXPECT_EQ(one.unknowns.size(), 5u);
  EXPECT_EQ(one.choice.inputs.size(), 5u);
  EXPECT_EQ(add_string(small(), one.choice), add);
}

TEST(AddString, APointHasItsThreeLengths) {
  const std::string add = "offset:branch=tool,transform=2,form=point";
  const Candidate one = candidate(add);
  ASSERT_EQ(one.terms.size(), 3u);
  EXPECT_EQ(one.terms[0].text, "offset_X2");
  EXPECT_EQ(one.terms[1].text, "offset_Y2");
  EXPECT_EQ(one.terms[2].text, "offset_Z2");
  EXPECT_EQ(add_string(small(), one.choice), add);
}

TEST(AddString, StartsAreTakenFromItAlone) {
  const Candidate cyclic = candidate("cyclic-error:axis=X,form=plain,start.p=10");
  std::size_t periods = 0;
  for (const CandidateUnknown& unknown : cyclic.unknowns) {
    EXPECT_EQ(unknown.start, unknown.rule == "p" ? 10 : 0);
    periods += unknown.kind == UnknownKind::kPeriod ? 1 : 0;
  }
  EXPECT_EQ(periods, 1u);
  EXPECT_THROW(candidate("cyclic-error:axis=X,form=plain"), InputError) << "a period of 0 has no meaning";
}

struct Bad {
  const char* add;
  const char* word;
};

TEST(AddString, BadOnesNameTheWord) {
  for (const Bad& bad : {Bad{"backlahs:axis=X", "\"backlahs\""},
                         Bad{"", "\"\""},
                         Bad{"backlash:axis=W", "\"W\""},
                         Bad{"backlash:axis", "\"axis\""},
                         Bad{"backlash:=X", "\"=X\""},
                         Bad{"backlash:axis=X,axis=Y", "\"axis\""},
                         Bad{"backlash:axis=X,colour=red", "\"colour\""},
                         Bad{"backlash:axis=X,form=oval", "\"oval\""},
                         Bad{"backlash:axis=X,axis2=Y", "\"backlash\""},
                         Bad{"backlash:axis=X,transform=9,branch=tool", "\"9\""},
                         Bad{"backlash:axis=X,branch=spindle", "\"spindle\""},
                         Bad{"backlash:axis=X,dof=rX", "\"backlash\""},
                         Bad{"backlash:axis=X,dof=theta", "\"theta\""},
                         Bad{"offset:branch=tool,transform=5,dof=rX", "\"rX\""},
                         Bad{"offset", "\"offset\""},
                         Bad{"offset:branch=tool,transform=2,dof=X,form=point", "\"X\""},
                         Bad{"offset:branch=tool,transform=5,form=point", "sixdof"},
                         Bad{"squareness:axis=X", "\"squareness\""},
                         Bad{"thermal-scale:axis=X", "\"thermal-scale\""},
                         Bad{"thermal-scale:axis=X,input=2nd", "\"2nd\""},
                         Bad{"thermal-scale:axis=X,input=feed", "\"feed\""},
                         Bad{"thermal-scale:axis=X,input=sin", "\"sin\""},
                         Bad{"thermal-scale:axis=X,input=alpha", "\"alpha\""},
                         Bad{"thermal-scale:axis=X,input=T_x,reference=warm", "warm"},
                         Bad{"cyclic-error:axis=X,form=plain,start.q=1", "\"q\""},
                         Bad{"cyclic-error:axis=X,form=plain,start.p=long", "long"},
                         Bad{"backlash:axis=L,form=table", "from and to"},
                         Bad{"time-sync:dof=X", "\"time-sync\""},
                         Bad{"offset:branch=tool,dof=X,axis=Y", "\"tool\""},
                         Bad{"custom:branch=tool,transform=2,dof=X", "\"custom\""},
                         Bad{"custom:branch=tool,transform=2,dof=X,term=k*(X", "\"k*(X\""},
                         Bad{"custom:branch=tool,transform=2,dof=X,term=k*T_q", "\"T_q\""},
                         Bad{"custom:branch=tool,transform=2,dof=X,term=X*dirX", "unknown"},
                         Bad{"base-drift:branch=tool,transform=1,dof=X,form=step", "runs"}}) {
    try {
      candidate(bad.add);
      ADD_FAILURE() << bad.add << " was taken";
    } catch (const InputError& error) {
      EXPECT_NE(std::string(error.what()).find(bad.word), std::string::npos)
          << bad.add << " -> " << error.what();
    }
  }
}

TEST(AddToText, LeavesEverythingElseAsItStands) {
  const std::string text = added("backlash:axis=X");
  // What is new is three insertions; taking them out gives the file back.
  std::string back = text;
  for (const std::string part :
       {R"(      <backlash_X value="0" nominal="0" unit="mm" note="backlash of X in X of transform 2"/>)"
        "\n",
        "+backlash_X*dirX"}) {
    const auto at = back.find(part);
    ASSERT_NE(at, std::string::npos) << part << "\n" << text;
    back.erase(at, part.size());
  }
  EXPECT_EQ(back, kText);
  EXPECT_LT(text.find("<backlash_X"), text.find("</static>", text.find("in a remark")));
  EXPECT_NO_THROW(parse_machine(text, "added.xml"));
}

TEST(AddToText, ReplacesANothingAndClosesAComparison) {
  EXPECT_NE(added("squareness:axis=X,dof=Y").find("Y=\"squareness_X_Y2*X\""), std::string::npos);
  EXPECT_NE(added("offset:branch=tool,transform=2,dof=Z").find("Z=\"(X&gt;100)+offset_Z2\""),
            std::string::npos);
  EXPECT_NE(added("axis-tilt:branch=tool,transform=2,dof=rX").find("rX=\"axis_tilt_rX2\""),
            std::string::npos);
  EXPECT_NE(added("axis-tilt:branch=tool,transform=1,dof=rX").find("rX=\"alpha+axis_tilt_rX1\""),
            std::string::npos);
  EXPECT_NE(added("axis-tilt:branch=tool,transform=5,dof=alpha").find(" a=\"L\" alpha=\"axis_tilt_alpha5\""),
            std::string::npos);
  EXPECT_NE(added("custom:branch=tool,transform=1,dof=X,term=k*X<3").find("X=\"(custom_X1*X&lt;3)\""),
            std::string::npos);
}

TEST(AddToText, DeclaresInputsWithUnitAndReference) {
  const std::string one = added("thermal-scale:axis=X,input=T_x,unit=degC,reference=22.5");
  EXPECT_NE(one.find("<T_x unit=\"degC\" reference=\"22.5\"/>"), std::string::npos) << one;
  EXPECT_NE(one.find("X*(T_x-22.5)"), std::string::npos);
  const std::string declared = added("thermal-scale:axis=X,input=T_room");
  EXPECT_EQ(declared.find("<T_room", declared.find("<T_room") + 1), std::string::npos) << "declared twice";
  const std::string pair =
      added("thermal-bend:input=T_a,input2=T_b,unit=degC,unit2=degC,branch=tool,transform=1,dof=rY");
  EXPECT_NE(pair.find("<T_a unit=\"degC\" reference=\"20\"/>"), std::string::npos) << pair;
  EXPECT_NE(pair.find("<T_b unit=\"degC\" reference=\"20\"/>"), std::string::npos) << pair;
  // Without a unit too: where the column is missing, the input is at its reference and the term is 0.
  const std::string bare = added("thermal-scale:axis=X,input=T_x");
  EXPECT_NE(bare.find("<T_x unit=\"\" reference=\"20\"/>"), std::string::npos) << bare;
}

TEST(AddToText, MakesTheSectionsThatAreMissing) {
  for (const char* variables : {"<variables><machineaxes><X/></machineaxes></variables>",
                                "<variables><static/><machineaxes><X/></machineaxes><inputs/></variables>"}) {
    const std::string text =
        std::string("<machine>") + variables + "<transforms><sixdof X=\"X\"/></transforms></machine>";
    const Machine machine = parse_machine(text, "m.xml");
    const Candidate one = make_candidate(
        machine, parse_add_string("thermal-scale:axis=X,input=T", machine, built_in_effects()));
    const Machine now = parse_machine(add_to_machine_text(text, machine, one), "added.xml");
    EXPECT_EQ(now.statics.size(), 1u);
    EXPECT_EQ(now.inputs.size(), 1u);
  }
}

}  // namespace
}  // namespace vernier::add_strings_test
