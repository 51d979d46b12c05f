// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/create/machine_file.h"

#include <fmt/format.h>

#include <algorithm>

#include "tools/model/machine.h"
#include "tools/text/numbers.h"
#include "tools/text/xml_text.h"

namespace vernier::create {
namespace {

/// A number of the file: computed values (of a URDF) without the tail of binary digits, 1e-9 mm or deg.
std::string number(double value) { return text::fixed_text(value, 9); }

constexpr std::array<char, 3> kLengths = {'X', 'Y', 'Z'}, kTurns = {'A', 'B', 'C'};
/// Limits of a correction: a millimetre is a crash; a tenth of a degree at a distance of a metre is nearly
/// two.
constexpr const char* kLinearLimits = R"(maxcorrection="0.5" maxslew="5")";
constexpr const char* kRotaryLimits = R"(maxcorrection="0.1" maxslew="1")";
/// The zero error of a joint is larger, and near a singular pose a small tool motion needs a large joint
/// rotation.
constexpr const char* kJointLimits = R"(maxcorrection="5" maxslew="20")";

const MachineType* type_named(const std::string& name) {
  for (const MachineType& type : machine_types())
    if (name == type.name) return &type;
  return nullptr;
}

/// "carriage", "head", "table": the part that moves with the axis.
std::string what_moves(const MachinePlan& plan, std::size_t index, bool work) {
  const PlannedAxis& axis = plan.axes[index];
  if (axis.rotary()) return work ? "turning table" : "turning head";
  return type_named(plan.type)->slides[axis.along()];
}

std::string side_text(const MachinePlan& plan, const std::vector<std::size_t>& side, bool work) {
  std::string text = "bed";
  for (const std::size_t i : side)
    text += " > " + plan.axes[i].name + (plan.arm.empty() ? " (" + what_moves(plan, i, work) + ")" : "");
  return text + (work ? " > workpiece" : " > tool");
}

/// True if the distances of a printed square show this squareness: Y to X.
bool is_of_square(const MachinePlan& plan, const std::string& name) {
  return std::any_of(plan.axes.begin(), plan.axes.end(), [&](const PlannedAxis& axis) {
    return !axis.rotary() && axis.along() == 1 && name == "EC0" + axis.name;
  });
}

/// One static of an error: 0, free in a fit unless the survey cannot see it.
std::string error_static(const MachinePlan& plan, const std::string& name, const char* unit,
                         const std::string& note) {
  return fmt::format(
      "      <{0} value=\"0\" nominal=\"0\" unit=\"{1}\"{2} note=\"{3}\"/>\n", name, unit,
      plan.positioning_only || (plan.square_only && !is_of_square(plan, name)) ? " Hide=\"true\"" : "", note);
}

/// The scale of a slide that the distances of a printed square show; empty for other axes.
std::string scale_of_square(const MachinePlan& plan, const PlannedAxis& axis) {
  constexpr std::size_t kHorizontal = 2;  // X and Y
  return plan.square_only && !axis.rotary() && axis.along() < kHorizontal ? "scale" + axis.name : "";
}
/// `scale`: how large the value may plausibly be, mm; 0: not stated.
std::string length_static(const std::string& name, double value, const std::string& note, double scale = 0) {
  return fmt::format("      <{} value=\"{}\" unit=\"mm\"{} Hide=\"true\" note=\"{}\"/>\n", name,
                     number(value), scale > 0 ? fmt::format(" scale=\"{:g}\"", scale) : "", note);
}

/// An angle of a slide's travel about one axis of the machine: E + turn + 0 + the slide's name.
struct TravelAngle {
  std::string name, towards;
  std::size_t about = 0;
};

/// Directions in which a slide may be out of square. The first X is the datum of direction, the first Y is
/// with it in the plane of the set-up, all others have both angles.
std::vector<TravelAngle> travel_angles(const MachinePlan& plan, std::size_t index) {
  const PlannedAxis& axis = plan.axes[index];
  std::array<std::string, 3> first;
  for (const PlannedAxis& other : plan.axes)
    if (!other.rotary() && first[other.along()].empty()) first[other.along()] = other.name;
  const bool leads = first[axis.along()] == axis.name;
  std::vector<TravelAngle> angles;
  for (std::size_t about = 0; about < 3; ++about) {
    if (about == axis.along()) continue;
    // Turned about `about`, the travel leans towards the third direction.
    const std::size_t towards = 3 - about - axis.along();
    if (leads && (towards > axis.along() || first[towards].empty())) continue;
    const std::string to = leads ? first[towards] : std::string(1, kLengths[towards]);
    angles.push_back({fmt::format("E{}0{}", kTurns[about], axis.name), to, about});
  }
  return angles;
}

std::string with_sign(double sign, const std::string& term, bool first) {
  return (sign < 0 ? "-" : first ? "" : "+") + term;
}

/// A slide: travel, its errors from the table, the angles of its travel. Under the workpiece all of it the
/// other way, so that position and errors are the tool's, seen from the workpiece.
std::string slide_row(const MachinePlan& plan, std::size_t index, bool work, int n) {
  const PlannedAxis& axis = plan.axes[index];
  const double side = work ? -1 : 1;
  std::array<std::string, 6> dof;
  for (std::size_t k = 0; k < 3; ++k) {
    if (const std::string scale = scale_of_square(plan, axis); k == axis.along())
      dof[k] += with_sign(side, scale.empty() ? axis.name : axis.name + "*(1+" + scale + ")", true);
    dof[k] += with_sign(side, fmt::format("l{}{}", axis.name, "xyz"[k]), dof[k].empty());
    dof[3 + k] = with_sign(side, fmt::format("r{}{}", axis.name, "xyz"[k]), true);
  }
  for (const TravelAngle& angle : travel_angles(plan, index)) {
    const std::size_t towards = 3 - angle.about - axis.along();
    // The cross product of the unit vectors: +1 where about, along, towards are in cyclic order.
    const double turn = (angle.about + 1) % 3 == axis.along() ? 1 : -1;
    dof[towards] += with_sign(side * turn, angle.name + "*" + axis.name, false);
  }
  std::string row = fmt::format("    <sixdof n=\"{}\"", n);
  for (std::size_t k = 0; k < 6; ++k) row += fmt::format(" {}=\"{}\"", model::kSixDofNames[k], dof[k]);
  return row + "/>\n";
}

/// A rotary axis: location and tilt of its line with the errors of its motion, then the rotation. A table
/// rotates the workpiece in the opposite direction (ISO 841), and its positioning error too.
std::string turning_rows(const MachinePlan& plan, std::size_t index, bool work, int n) {
  const PlannedAxis& axis = plan.axes[index];
  std::array<std::string, 6> dof;
  for (std::size_t k = 0; k < 3; ++k) {
    const bool own = k == axis.along();
    const std::string length = fmt::format("l{}{}", axis.name, "xyz"[k]),
                      angle = fmt::format("r{}{}", axis.name, "xyz"[k]);
    const bool away = axis.centre[k] != 0;
    if (away) dof[k] = fmt::format("P{}{}+", kLengths[k], axis.name);
    if (!own) dof[k] += fmt::format("E{}0{}+", kLengths[k], axis.name);
    dof[k] += length;
    dof[3 + k] = own ? (work ? "-" : "") + angle : fmt::format("E{}0{}+{}", kTurns[k], axis.name, angle);
  }
  std::string rows = fmt::format("    <sixdof n=\"{}\"", n);
  for (std::size_t k = 0; k < 6; ++k) rows += fmt::format(" {}=\"{}\"", model::kSixDofNames[k], dof[k]);
  return rows + fmt::format("/>\n    <sixdof n=\"{}\" {}=\"{}{}\"/>\n", n + 1,
                            model::kSixDofNames[3 + axis.along()], work ? "-" : "", axis.name);
}

std::string branch(const MachinePlan& plan, bool work) {
  const auto& side = work ? plan.work_side : plan.tool_side;
  if (work && side.empty()) return "";
  std::string text = fmt::format("  <transforms branch=\"{}\">\n", work ? "workpiece" : "tool");
  int n = 1;
  for (const std::size_t i : side) {
    const bool rotary = plan.axes[i].rotary();
    text += rotary ? turning_rows(plan, i, work, n) : slide_row(plan, i, work, n);
    n += rotary ? 2 : 1;
  }
  if (!work) text += fmt::format("    <sixdof n=\"{}\" X=\"TPX\" Y=\"TPY\" Z=\"TPZ\"/>\n", n);
  return text + "  </transforms>\n";
}

/// How large the tool point of an arm may plausibly be. A fit that frees an unknown tool (--free) then
/// changes the tool point and not the length of the last link, which moves the tool in the same way.
constexpr double kTool_mm = 200;

std::string tool_statics(const MachinePlan& plan) {
  std::string text =
      "      <!-- Position of the tool point in the frame of the last axis that carries the tool. Hide: a "
      "fit does not change it. -->\n";
  for (std::size_t k = 0; k < 3; ++k)
    text += length_static(fmt::format("TP{}", kLengths[k]), plan.tool[k],
                          plan.arm.empty() ? "tool point" : "tool point on the flange",
                          plan.arm.empty() ? 0 : kTool_mm);
  return text;
}

std::string slide_statics(const MachinePlan& plan) {
  std::string text;
  for (std::size_t i = 0; i < plan.axes.size(); ++i) {
    if (plan.axes[i].rotary()) continue;
    for (const TravelAngle& angle : travel_angles(plan, i))
      text += error_static(plan, angle.name, "rad",
                           fmt::format("squareness of {} to {}", plan.axes[i].name, angle.towards));
  }
  for (const PlannedAxis& axis : plan.axes)
    if (const std::string scale = scale_of_square(plan, axis); !scale.empty())
      text += fmt::format("      <{} value=\"0\" nominal=\"0\" note=\"scale of {}: 0.001 is 1 mm per m\"/>\n",
                          scale, axis.name);
  if (text.empty()) return "";
  return "      <!-- Squareness: angle error between the travels of two axes. X is the datum: its travel is "
         "the reference\n"
         "           direction of the other axes. -->\n" +
         text;
}

std::string turning_statics(const MachinePlan& plan) {
  std::string text;
  for (const PlannedAxis& axis : plan.axes) {
    if (!axis.rotary()) continue;
    for (std::size_t k = 0; k < 3; ++k)
      if (k != axis.along())
        text +=
            error_static(plan, fmt::format("E{}0{}", kLengths[k], axis.name), "mm",
                         fmt::format("position error of the axis of {} along {}", axis.name, kLengths[k]));
    for (std::size_t k = 0; k < 3; ++k)
      if (k != axis.along())
        text += error_static(plan, fmt::format("E{}0{}", kTurns[k], axis.name), "deg",
                             fmt::format("tilt error of the axis of {} about {}", axis.name, kLengths[k]));
    for (std::size_t k = 0; k < 3; ++k)
      if (axis.centre[k] != 0)
        text += length_static(fmt::format("P{}{}", kLengths[k], axis.name), axis.centre[k],
                              fmt::format("nominal position of {} along {}", axis.name, kLengths[k]));
  }
  if (text.empty()) return "";
  return "      <!-- Location errors of the rotary axes (ISO 230-7): position and tilt of the axis of "
         "rotation. -->\n" +
         text;
}

std::string arm_statics(const MachinePlan& plan) {
  std::string text =
      "      <!-- Errors of the arm: zero error th of each joint, twist error al between two joints, lengths "
      "d and a. If the axes\n"
      "           of two joints are parallel, a rotation be about y replaces one length (Hayati). -->\n";
  for (std::size_t i = 0; i < plan.arm.size(); ++i) {
    const DhRow& row = plan.arm[i];
    const std::string j = std::to_string(i + 1);
    const bool last = i + 1 == plan.arm.size(), parallel = row.parallel() && !last;
    const auto length = [&](const std::string& name, double value) {
      text +=
          fmt::format("      <{0} value=\"{1}\" nominal=\"{1}\" unit=\"mm\"/>\n", name + j, number(value));
    };
    text += error_static(plan, "th" + j, "deg", (row.prismatic ? "turn of joint " : "zero of joint ") + j);
    if (!parallel) length("d", row.d);
    if (!last) length("a", row.a);
    if (!last)
      text += error_static(plan, "al" + j, "deg", fmt::format("twist from joint {} to {}", i + 1, i + 2));
    if (parallel)
      text += error_static(plan, "be" + j, "deg",
                           fmt::format("joint {} not parallel to joint {}, about y", i + 2, i + 1));
  }
  return text;
}

std::string plus(double value, const std::string& name) {
  return value == 0 ? name : number(value) + "+" + name;
}

std::string arm_rows(const MachinePlan& plan) {
  std::string text = "  <transforms branch=\"tool\"";
  if (!plan.link.empty()) {
    text += fmt::format(" link=\"{}\" frame=\"", text::escape_attribute(plan.link));
    for (std::size_t k = 0; k < plan.link_frame.size(); ++k)
      text += (k > 0 ? " " : "") + number(plan.link_frame[k]);
    text += '"';
  }
  text += ">\n";
  int n = 1;
  for (std::size_t i = 0; i < plan.arm.size(); ++i) {
    const DhRow& row = plan.arm[i];
    const std::string j = std::to_string(i + 1), axis = plan.axes[i].name;
    const bool last = i + 1 == plan.arm.size(), parallel = row.parallel() && !last;
    const std::string theta = plus(row.theta, (row.prismatic ? "" : axis + "+") + "th" + j);
    const std::string d = (row.prismatic ? axis + "+" : "") + (parallel ? number(row.d) : "d" + j);
    text += fmt::format("    <DH n=\"{}\" theta=\"{}\" d=\"{}\" a=\"{}\" alpha=\"{}\"/>\n", n++, theta, d,
                        last ? number(row.a) : "a" + j, last ? number(row.alpha) : plus(row.alpha, "al" + j));
    if (parallel) text += fmt::format("    <sixdof n=\"{}\" rY=\"{}\"/>\n", n++, plus(row.beta, "be" + j));
  }
  return text + fmt::format("    <sixdof n=\"{}\" X=\"TPX\" Y=\"TPY\" Z=\"TPZ\"/>\n  </transforms>\n", n);
}

std::string axes_text(const MachinePlan& plan) {
  std::string text =
      "    <!-- Travel of each axis in mm or deg. maxcorrection limits the correction that a board may add "
      "to an axis (mm or deg),\n"
      "         maxslew its change in one second. Set both limits to values that your machine allows. -->\n"
      "    <machineaxes>\n";
  for (const PlannedAxis& axis : plan.axes)
    text += fmt::format(
        "      <{} rotary=\"{}\"{}{} min=\"{}\" max=\"{}\" {}/>\n", axis.name, axis.rotary(),
        axis.joint.empty() ? "" : fmt::format(" joint=\"{}\"", text::escape_attribute(axis.joint)),
        axis.rollover ? " rollover=\"true\"" : "", number(axis.min), number(axis.max),
        !axis.rotary()     ? kLinearLimits
        : plan.arm.empty() ? kRotaryLimits
                           : kJointLimits);
  return text + "    </machineaxes>\n";
}

std::string tables_text(const MachinePlan& plan) {
  std::string text =
      "    <!-- Six errors of each axis at stations along it, linear between them: X Y Z in mm (positioning "
      "and straightness),\n"
      "         rX rY rZ in deg (roll, pitch, yaw). fit names the columns that a fit may change; " +
      std::string(
          plan.square_only
              ? "with the option errors = square\n"
                "         none: the distances of a square show the squareness and the scales only"
          : plan.positioning_only
              ? "with the option errors = positioning only the\n"
                "         positioning errors along each axis: add the other columns that you measured"
              : "remove columns that your\n"
                "         measurements do not determine, and add stations where you measured more points") +
      ". -->\n    <comptables>\n";
  for (const PlannedAxis& axis : plan.axes) {
    constexpr const char* kColumns[] = {"X", "Y", "Z", "rX", "rY", "rZ"};
    text += fmt::format("      <table axis=\"{}\" fit=\"{}\">\n", axis.name,
                        plan.square_only        ? ""
                        : plan.positioning_only ? kColumns[axis.along() + (axis.rotary() ? 3 : 0)]
                                                : "X Y Z rX rY rZ");
    for (const double loc : stations_of(axis))
      text += fmt::format(
          "        <station loc=\"{}\" X=\"0\" Y=\"0\" Z=\"0\" rX=\"0\" rY=\"0\" rZ=\"0\"/>\n", number(loc));
    text += "      </table>\n";
  }
  return text + "    </comptables>\n";
}

std::string signs_remark(const MachinePlan& plan) {
  if (plan.arm == default_arm())
    return "     No rows were given: the lengths are those of a UR10e, put yours in their place (or by the "
           "options dh, "
           "joint).\n"
           "     Each DH row is Tz(d) Rz(theta) Tx(a) Rx(alpha); positions of turning joints are in deg.\n";
  if (!plan.arm.empty())
    return "     Each DH row is Tz(d) Rz(theta) Tx(a) Rx(alpha); positions of turning joints are in deg.\n";
  std::string text =
      "     Positions are positions of the tool relative to the workpiece, as a control shows them.";
  if (!plan.work_side.empty())
    text +=
        " Therefore an axis that carries the workpiece\n"
        "     has a minus sign (ISO 841). If your control counts such an axis in the other direction, remove "
        "its minus signs.";
  return text + "\n";
}

std::string head(const MachinePlan& plan) {
  std::string text = "<?xml version=\"1.0\" encoding=\"utf-8\"?>\n<!-- ";
  text += std::string(type_named(plan.type)->title) + ".\n\n       ";
  text += side_text(plan, plan.tool_side, false) + "\n";
  if (!plan.work_side.empty()) text += "       " + side_text(plan, plan.work_side, true) + "\n";
  text += "\n" + signs_remark(plan);
  return text +
         "     All errors are 0 until `vernier fit` estimates them from measurements. value is the estimate "
         "for the machine,\n"
         "     nominal the value that its control uses. tools/docs/machine_file.md defines every element. "
         "-->\n";
}

std::string base_attributes(const MachinePlan& plan) {
  constexpr std::array kNames = {"X", "Y", "Z", "rX", "rY", "rZ"};
  std::string text;
  for (std::size_t k = 0; k < kNames.size(); ++k)
    text += fmt::format(" {}=\"{}\"", kNames[k], number(plan.base[k]));
  return text;
}

}  // namespace

std::string drawing(const MachinePlan& plan) {
  std::string text = side_text(plan, plan.tool_side, false);
  if (!plan.work_side.empty()) text += "\n" + side_text(plan, plan.work_side, true);
  return text;
}

std::string machine_file(const MachinePlan& plan) {
  const bool robot = !plan.arm.empty();
  std::string text = head(plan);
  text +=
      fmt::format("<machine name=\"{}\">\n  <variables>\n    <static>\n", text::escape_attribute(plan.name));
  text += robot ? arm_statics(plan) : slide_statics(plan) + turning_statics(plan);
  text += tool_statics(plan);
  text +=
      "      <!-- Set-up of the measuring instrument: base of the chain to measuring frame, estimated by the "
      "fit. This element is for\n"
      "           all rows; a further element with run=\"LABEL\" is for the rows of this run. -->\n"
      "      <BaseShift" +
      base_attributes(plan) + "/>\n" + (plan.reflector ? kReflectorLine : "") + "    </static>\n";
  text += axes_text(plan);
  if (!robot) text += tables_text(plan);
  for (const PlannedArtefact& one : plan.artefacts)
    text +=
        fmt::format("    <artefact name=\"{}\" type=\"{}\"/>\n", text::escape_attribute(one.name), one.type);
  text += "  </variables>\n";
  text += robot ? arm_rows(plan) : branch(plan, true) + branch(plan, false);
  return text + "</machine>\n";
}

}  // namespace vernier::create
