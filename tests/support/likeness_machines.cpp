// SPDX-License-Identifier: GPL-3.0-or-later
#include "tests/support/likeness_machines.h"

#include <fmt/format.h>

#include <cstdlib>

namespace vernier::support {
namespace {

std::string machine(const std::string& name, const std::string& statics, const std::string& axes,
                    const std::string& rows, bool shift_held = false) {
  return fmt::format(R"XML(<machine name="{}">
  <variables>
    <static>
{}      <BaseShift X="0" Y="0" Z="0" rX="0" rY="0" rZ="0"{}/>
    </static>
    <machineaxes>
{}    </machineaxes>
  </variables>
  <transforms branch="tool">
{}  </transforms>
</machine>
)XML",
                     name, statics, shift_held ? " Hide=\"true\"" : "", axes, rows);
}

std::string free_static(const std::string& name, const char* unit) {
  return fmt::format("      <{} value=\"0\" nominal=\"0\" unit=\"{}\"/>\n", name, unit);
}

std::string turning(const std::string& name, double low, double high) {
  return fmt::format("      <{} rotary=\"true\" min=\"{:g}\" max=\"{:g}\"/>\n", name, low, high);
}

/// Lengths of a robot with a spherical wrist: foot, shoulder ahead, upper arm, elbow up, forearm, wrist, mm.
struct Arm {
  double foot, ahead, upper, up, fore, wrist;
};

/// Joints about z, y, y, x, y, x: ABB IRB 120, KUKA KR 6 R900 and Fanuc LR Mate 200iD by their data sheets.
std::string six_joint(Draw& draw) {
  static const std::vector<Arm> makes = {
      {290, 0, 270, 70, 302, 72}, {400, 25, 455, 35, 420, 80}, {330, 50, 330, 35, 335, 80}};
  const Arm& a = draw.pick(makes);
  std::string statics, axes;
  for (int j = 2; j <= 5; ++j) statics += free_static(fmt::format("th{}", j), "deg");
  for (const char* name : {"da2", "dz4", "dx5"}) statics += free_static(name, "mm");
  const double low[] = {-150, -70, -100, -150, -110, -170}, high[] = {150, 90, 60, 150, 110, 170};
  for (std::size_t j = 0; j < 6; ++j) axes += turning(fmt::format("J{}", j + 1), low[j], high[j]);
  const std::string rows = fmt::format(
      "    <sixdof n=\"1\" Z=\"{:g}\" rZ=\"J1\"/>\n"
      "    <sixdof n=\"2\" X=\"{:g}\" rY=\"J2+th2\"/>\n"
      "    <sixdof n=\"3\" Z=\"{:g}+da2\" rY=\"J3+th3\"/>\n"
      "    <sixdof n=\"4\" Z=\"{:g}+dz4\" rX=\"J4+th4\"/>\n"
      "    <sixdof n=\"5\" X=\"{:g}+dx5\" rY=\"J5+th5\"/>\n"
      "    <sixdof n=\"6\" X=\"{:g}\" rX=\"J6\"/>\n"
      "    <sixdof n=\"7\" X=\"{:g}\" Y=\"{:g}\" Z=\"{:g}\"/>\n",
      a.foot, a.ahead, a.upper, a.up, a.fore, a.wrist, draw.uniform(60, 180), draw.uniform(-40, 40),
      draw.uniform(20, 60));
  return machine("six-joint", statics, axes, rows);
}

/// Line of sight: z of the last frame.
std::string alt_az(Draw& draw) {
  const std::string statics = free_static("AN", "deg") + free_static("AW", "deg") + free_static("IE", "deg") +
                              free_static("NPAE", "deg") + free_static("CA", "deg");
  return machine("alt-az", statics, turning("A", 0, 350) + turning("E", draw.uniform(10, 20), 85),
                 "    <sixdof n=\"1\" rX=\"AW\" rY=\"AN\"/>\n"
                 "    <sixdof n=\"2\" rZ=\"-A\"/>\n"
                 "    <sixdof n=\"3\" rX=\"NPAE\" rY=\"90-E-IE\"/>\n"
                 "    <sixdof n=\"4\" rX=\"CA\"/>\n"
                 "    <sixdof n=\"5\" Z=\"1000\"/>\n");
}

/// Polar axis z of row 1, tilted to the pole by 90 deg less the latitude.
std::string equatorial(Draw& draw) {
  const std::string statics = free_static("ME", "deg") + free_static("MA", "deg") + free_static("ID", "deg") +
                              free_static("NP", "deg") + free_static("CH", "deg");
  return machine("equatorial", statics, turning("H", -80, 80) + turning("D", -25, 80),
                 fmt::format("    <sixdof n=\"1\" rX=\"MA\" rY=\"{:.4g}+ME\"/>\n"
                             "    <sixdof n=\"2\" rZ=\"-H\"/>\n"
                             "    <sixdof n=\"3\" rX=\"NP\" rY=\"D-90+ID\"/>\n"
                             "    <sixdof n=\"4\" rX=\"CH\"/>\n"
                             "    <sixdof n=\"5\" Z=\"1000\"/>\n",
                             draw.uniform(30, 65)));
}

std::string bed(Draw& draw) {
  const double size = draw.uniform(180, 350);
  const std::string axes = fmt::format(
      "      <X rotary=\"false\" min=\"0\" max=\"{0:.0f}\"/>\n      <Y rotary=\"false\" min=\"0\" "
      "max=\"{0:.0f}\"/>\n",
      size);
  return machine("bed", "", axes,
                 "    <sixdof n=\"1\" Z=\"0\"/>\n"
                 "    <sixdof n=\"2\" Y=\"Y\"/>\n"
                 "    <sixdof n=\"3\" X=\"X\"/>\n"
                 "    <sixdof n=\"4\" Z=\"-20\"/>\n");
}

std::string turntable(Draw&) {
  return machine("turntable", free_static("c0", "deg"), turning("C", 0, 360),
                 "    <sixdof n=\"1\" rZ=\"C+c0\"/>\n", true);
}

/// Arm that hangs from a torso leaning forwards: shoulder about y, x, z, elbow y, wrist z, y.
std::string torso_arm(Draw& draw) {
  const double upper = draw.uniform(240, 330), fore = draw.uniform(220, 300);
  std::string statics, axes;
  for (const char* name : {"s2", "s3", "e0", "w1"}) statics += free_static(name, "deg");
  for (const char* name : {"du", "df"}) statics += free_static(name, "mm");
  axes = turning("S1", -100, 60) + turning("S2", -20, 100) + turning("S3", -80, 80) + turning("E", -120, 0) +
         turning("W1", -90, 90) + turning("W2", -60, 60);
  return machine("torso-arm", statics, axes,
                 fmt::format("    <sixdof n=\"1\" Z=\"1100\" rY=\"{:.0f}\"/>\n"
                             "    <sixdof n=\"2\" Y=\"180\" rY=\"S1\"/>\n"
                             "    <sixdof n=\"3\" rX=\"S2+s2\"/>\n"
                             "    <sixdof n=\"4\" rZ=\"S3+s3\"/>\n"
                             "    <sixdof n=\"5\" Z=\"-{:.0f}+du\" rY=\"E+e0\"/>\n"
                             "    <sixdof n=\"6\" Z=\"-{:.0f}+df\" rZ=\"W1+w1\"/>\n"
                             "    <sixdof n=\"7\" rY=\"W2\"/>\n"
                             "    <sixdof n=\"8\" X=\"30\" Y=\"{:.0f}\" Z=\"-{:.0f}\"/>\n",
                             draw.uniform(10, 40), upper, fore, draw.uniform(10, 40), draw.uniform(80, 140)));
}

/// What stands in the file as a number before an attribute's first sign: rY="31.4+ME" is 31.4.
double number_in(const std::string& file, const std::string& row, const std::string& dof) {
  const std::size_t at = file.find("\"" + row + "\"");
  const std::size_t from = file.find(" " + dof + "=\"", at) + dof.size() + 3;
  return std::strtod(file.c_str() + from, nullptr);
}

}  // namespace

const std::vector<LikenessMachine>& likeness_machines() {
  static const std::vector<LikenessMachine> all = {
      {"six-joint",
       six_joint,
       0.02,
       30000,
       {"joint-compliance", "backlash", "cyclic-error", "thermal-offset", "base-drift"}},
      {"alt-az",
       alt_az,
       0.005,
       30000,
       {"squareness", "gravity-sag", "cyclic-error", "backlash", "thermal-bend"}},
      {"equatorial",
       equatorial,
       0.005,
       30000,
       {"squareness", "gravity-sag", "cyclic-error", "backlash", "thermal-bend"}},
      {"bed",
       bed,
       0.003,
       6000,
       {"straightness", "thermal-offset", "thermal-bend", "base-drift", "lateral-play"}},
      {"turntable", turntable, 0.002, 6000, {"cyclic-error", "backlash", "base-drift"}},
      {"gear-train", turntable, 0.01, 6000, {"cyclic-error", "backlash"}},
      {"torso-arm",
       torso_arm,
       0.1,
       30000,
       {"joint-compliance", "backlash", "cyclic-error", "thermal-offset", "base-drift"}}};
  return all;
}

std::vector<LikenessTerm> gravity_terms(const std::string& name, const std::string& effect,
                                        const std::string& file) {
  const bool compliance = effect == "joint-compliance", sag = effect == "gravity-sag";
  if (name == "six-joint" && compliance)
    // Gravity before joint 5 is (sin s, -sin J4 cos s, -cos J4 cos s), s = J2+J3; the tool points along x.
    return {{"J2", {{2, "rY", "k1*sin(J2)"}}},
            {"J2", {{2, "rY", "k1*(0.6*sin(J2)+0.4*cos(J2+J3))"}}},
            {"J3", {{3, "rY", "k1*cos(J2+J3)"}}},
            {"J4", {{4, "rX", "k1*sin(J5)*sin(J4)*cos(J2+J3)"}}},
            {"J5", {{5, "rY", "k1*(cos(J5)*cos(J4)*cos(J2+J3)-sin(J5)*sin(J2+J3))"}}}};
  if (name == "alt-az" && sag)
    // A tube bends downwards by the cosine of its elevation.
    return {{"E", {{3, "rY", "k1*cos(E)"}}}};
  if (name == "equatorial" && sag) {
    // TPOINT's TF: the line of sight falls towards the horizon by the sine of the zenith distance.
    const double c = number_in(file, "1", "rY");
    const std::string s = fmt::format("sin({:g})", c), k = fmt::format("cos({:g})", c);
    return {{"",
             {{5, "rX", fmt::format("-k1*{}*sin(H)", s)},
              {5, "rY", fmt::format("k1*(cos(H)*{}*sin(D)-{}*cos(D))", s, k)}}}};
  }
  if (name == "torso-arm" && compliance) {
    const std::string s = fmt::format("(S1+{:g})", number_in(file, "1", "rY"));
    return {
        {"S1", {{2, "rY", "k1*sin" + s}}},
        {"S2", {{3, "rX", "k1*sin(S2)*cos" + s}}},
        {"E",
         {{5, "rY",
           fmt::format("k1*(cos(E)*(cos(S3)*sin{0}-sin(S3)*sin(S2)*cos{0})+sin(E)*cos(S2)*cos{0})", s)}}}};
  }
  return {};
}

}  // namespace vernier::support
