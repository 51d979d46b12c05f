// SPDX-License-Identifier: GPL-3.0-or-later
#include "tests/support/machines.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include "tools/model/chain/prediction.h"
#include "tools/model/machine_reader.h"

namespace vernier::support {

using namespace vernier::model;

Machine full_machine() {
  return parse_machine(R"XML(<machine name="full"><variables>
  <static>
    <sq value="2e-4" nominal="0" unit="rad"/><TPZ value="-80" nominal="-80"/><k value="3e-4" nominal="0"/>
    <tau value="40" nominal="40"/><flex value="2e-3" nominal="0"/>
    <BaseShift X="10" Y="-20" Z="5" rX="3" rY="-2" rZ="30"/>
    <BaseShift run="b" X="1" Y="2" Z="3" rX="1" rY="0.5" rZ="-10"/>
  </static>
  <machineaxes>
    <X min="0" max="600" scalefactor="1e-5"/><Y min="0" max="400"/><Z min="-300" max="0"/>
    <B rotary="true" min="-90" max="90"/><C rotary="true" rollover="true" min="0" max="360"/>
  </machineaxes>
  <inputs><T unit="degC" reference="20"/></inputs>
  <comptables>
    <table axis="X" fit="X Y Z rX rY rZ">
      <station loc="0" X="0.01" Y="0.002" Z="-0.003" rX="0.001" rY="0.002" rZ="-0.001"/>
      <station loc="250" X="-0.02" Y="0.004" Z="0.001" rX="-0.002" rY="0.001" rZ="0.003"/>
      <station loc="600" X="0.03" Y="-0.001" Z="0.002" rX="0.003" rY="-0.002" rZ="0.001"/>
    </table>
    <table axis="Y" interpolation="cubic" fit="X rZ">
      <station loc="0" X="0.01" rZ="0.001"/><station loc="90" X="-0.02" rZ="0.002"/>
      <station loc="210" X="0.015" rZ="-0.003"/><station loc="400" X="0.002" rZ="0.001"/>
    </table>
    <table axis="C" interpolation="cubic" fit="X rY">
      <station loc="0" X="0.004" rY="0.001"/><station loc="100" X="-0.003" rY="0.002"/>
      <station loc="230" X="0.006" rY="-0.001"/><station loc="360" X="0.004" rY="0.001"/>
    </table>
  </comptables></variables>
  <transforms branch="workpiece">
    <sixdof n="1" Y="Y+lYy" X="lYx" rZ="rYz"/>
    <DH n="2" theta="C+rCz" d="lCz" a="30+lCx" alpha="90+rCy"/>
  </transforms>
  <transforms branch="tool">
    <sixdof n="1" X="X+lXx+k*lag(T,tau)" Y="sq*X+lXy" Z="lXz" rX="rXx+flex*sin(B)" rY="rXy" rZ="rXz+20"/>
    <sixdof n="2" Z="Z" rY="B"/>
    <DH n="3" d="TPZ" alpha="flex*50"/>
  </transforms></machine>)XML",
                       "full.xml");
}

Measurement full_measurement(const Machine& machine, std::size_t rows, std::mt19937_64& random) {
  std::uniform_real_distribution<double> unit(0, 1);
  std::string text =
      "X[mm],Y[mm],Z[mm],B[deg],C[deg],T[degC],t[s],x[mm],y[mm],z[mm],rx[deg],ry[deg],rz[deg],length[mm],"
      "cx[mm],cy[mm],cz[mm],d[mm],nx,ny,nz,px[mm],py[mm],pz[mm],u[um],run\n";
  for (std::size_t i = 0; i < rows; ++i)
    text += fmt::format("{},{},{},{},{},{},{},0,0,0,1,2,3,500,300,-150,40,0,0.6,0,0.8,1,2,3,1,{}\n",
                        600 * unit(random), 400 * unit(random), -300 * unit(random), 180 * unit(random) - 90,
                        720 * unit(random) - 360, 18 + 5 * unit(random), static_cast<double>(i) * 10,
                        i % 3 == 0 ? "b" : "a");
  return parse_measurement(text, "full.csv", machine);
}

std::string bridge_text(std::size_t stations) {
  std::string tables;
  for (const auto& [axis, low, high] : {std::tuple{"X", 0.0, 600.0}, {"Y", 0.0, 400.0}, {"Z", -300.0, 0.0}}) {
    tables += fmt::format("<table axis=\"{}\" fit=\"X Y Z rX rY rZ\">\n", axis);
    for (std::size_t i = 0; i < stations; ++i)
      tables += fmt::format("<station loc=\"{}\"/>\n",
                            low + (high - low) * static_cast<double>(i) / static_cast<double>(stations - 1));
    tables += "</table>\n";
  }
  return "<machine name=\"bridge\"><variables><static><alpha value=\"0\" unit=\"rad\"/><beta1 value=\"0\" "
         "unit=\"rad\"/>"
         "<beta2 value=\"0\" unit=\"rad\"/><BaseShift X=\"0\"/></static>"
         "<machineaxes><X min=\"0\" max=\"600\"/><Y min=\"0\" max=\"400\"/><Z min=\"-300\" "
         "max=\"0\"/></machineaxes><comptables>\n" +
         tables +
         "</comptables></variables><transforms>"
         "<sixdof n=\"1\" X=\"lYx\" Y=\"Y+lYy\" Z=\"lYz\" rX=\"rYx\" rY=\"rYy\" rZ=\"rYz\"/>"
         "<sixdof n=\"2\" X=\"X+lXx\" Y=\"lXy-alpha*X\" Z=\"lXz\" rX=\"rXx\" rY=\"rXy\" rZ=\"rXz\"/>"
         "<sixdof n=\"3\" X=\"lZx-beta1*Z\" Y=\"lZy-beta2*Z\" Z=\"Z+lZz\" rX=\"rZx\" rY=\"rZy\" rZ=\"rZz\"/>"
         "<sixdof n=\"4\" X=\"20\" Y=\"-30\" Z=\"-120\"/></transforms></machine>";
}

void expect_derivatives(const Machine& machine, const Measurement& m, const ParameterSet& parameters) {
  const Linearisation linear = linearise(machine, m, parameters);
  const Eigen::MatrixXd analytic = linear.jacobian;
  const Eigen::VectorXd point = parameters.get(machine);
  for (std::size_t p = 0; p < parameters.size(); ++p) {
    const auto at = static_cast<Eigen::Index>(p);
    constexpr double kStep = 1e-4;
    const auto moved = [&](double by) {
      Eigen::VectorXd next = point;
      next[at] += by;
      Machine other = machine;
      parameters.set(other, next);
      return predict(other, m);
    };
    const Eigen::VectorXd difference = (moved(kStep) - moved(-kStep)) / (2 * kStep);
    // Third derivatives over a step of 1e-4 and six digits lost to rounding of values near 1e3.
    EXPECT_LT((difference - analytic.col(at)).cwiseAbs().maxCoeff(),
              2e-6 * (1 + difference.cwiseAbs().maxCoeff()))
        << parameters[p].name;
  }
  EXPECT_LT((linear.predicted - predict(machine, m)).cwiseAbs().maxCoeff(), 1e-12);
}

}  // namespace vernier::support
