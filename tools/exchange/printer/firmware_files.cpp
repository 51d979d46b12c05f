// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/exchange/printer/firmware_files.h"

#include <fmt/format.h>

#include <array>
#include <cmath>
#include <utility>

#include "tools/maths/rounding.h"

namespace vernier::exchange {
namespace {

using Eigen::Index;

/// Without -0.
double rounded(double value, double digit) { return maths::rounded_to(value, digit) + 0.0; }

/// Rounds as the file has it.
void round_to(PrinterCorrection& correction, double tangent_digit, double height_digit) {
  for (double* tangent : {&correction.xy, &correction.xz, &correction.yz})
    *tangent = rounded(*tangent, tangent_digit);
  correction.mesh.z = correction.mesh.z.unaryExpr([&](double z) { return rounded(z, height_digit); });
  constexpr double kDigitOfLostMotion_mm = 1e-4;
  for (double& lost : correction.lost_motion) lost = rounded(lost, kDigitOfLostMotion_mm);
}

/// The three numbers of Klipper and Marlin, which compute x - y*XY - z*(XZ - XY*YZ) and y - z*YZ.
struct Skew {
  double xy, xz, yz;
};

/// Also rounds the correction as the file has it.
Skew skew_of(PrinterCorrection& correction, double digit) {
  Skew skew{0 - correction.xy, 0, 0 - correction.yz};
  skew.xz = rounded(-correction.xz + skew.xy * skew.yz, digit);
  correction.xz = -(skew.xz - skew.xy * skew.yz);
  return skew;
}

/// Lines "Y: 80.123" of the new steps per mm, or why there are none.
template <class Line>
std::string steps_lines(const PresentSetting& present, PrinterCorrection& correction,
                        const std::string& comment, bool per_turn, const Line& line) {
  std::string text;
  constexpr double kDigit = 1e-6;
  if (!present.steps) return text;
  for (std::size_t i = 0; i < 3; ++i) {
    if (!correction.measured(kLetters[i])) continue;
    const double now = (*present.steps)[i];
    const double factor = correction.steps[i];
    const double next = rounded(per_turn ? now / factor : now * factor, kDigit);
    correction.steps[i] = per_turn ? now / next : next / now;
    text += line(i, next);
  }
  return text.empty() ? "" : comment + text;
}

/// "xz_skew and yz_skew": the skews that the last fit did not measure; `word` makes the name.
template <class Word>
std::string unmeasured_skews(const PrinterCorrection& correction, const Word& word) {
  std::string text;
  for (const char* const one : {"XY", "XZ", "YZ"})
    if (!correction.measured(one)) text += (text.empty() ? "" : " and ") + word(one);
  return text;
}

/// Comment at the head of the file of Klipper: what it contains, and how to load it.
std::string klipper_head(const std::string& name, const std::string& profile,
                         const PrinterCorrection& correction) {
  const bool skew = !correction.no_skew, mesh = correction.has_mesh();
  if (!skew && !mesh) return fmt::format("# {}: neither squareness nor bed heights were measured.\n", name);
  if (skew && mesh)
    return fmt::format(
        "# {0}: squareness and bed heights. Write [include {1}.cfg] into printer.cfg, beside the "
        "sections\n"
        "# [skew_correction] and [bed_mesh], which must be present. Load both at the end of the "
        "start code:\n"
        "# SKEW_PROFILE LOAD={1} and BED_MESH_PROFILE LOAD={1}.\n",
        name, profile);
  if (mesh)
    return fmt::format(
        "# {0}: bed heights. Write [include {1}.cfg] into printer.cfg, beside the section "
        "[bed_mesh],\n"
        "# which must be present. Load the heights at the end of the start code:\n"
        "# BED_MESH_PROFILE LOAD={1}. The squareness was not measured: a skew profile of the printer "
        "stays.\n",
        name, profile);
  return fmt::format(
      "# {0}: squareness. Write [include {1}.cfg] into printer.cfg, beside the section "
      "[skew_correction],\n"
      "# which must be present. Load the squareness at the end of the start code:\n"
      "# SKEW_PROFILE LOAD={1}. The heights of the bed were not measured: a bed mesh of the printer "
      "stays.\n",
      name, profile);
}

std::string klipper_mesh(const HeightMesh& mesh, const std::string& profile) {
  std::string text = fmt::format("\n[bed_mesh {}]\nversion = 1\npoints =\n", profile);
  for (Index row = 0; row < mesh.z.rows(); ++row) {
    text += "\t";
    for (Index column = 0; column < mesh.z.cols(); ++column)
      text += fmt::format("{}{:.6f}", column == 0 ? "" : ", ", mesh.z(row, column));
    text += "\n";
  }
  return text +
         fmt::format(
             "tension = 0.2\nmin_x = {:.3f}\nalgo = direct\ny_count = {}\nmesh_y_pps = 0\nmin_y = {:.3f}\n"
             "x_count = {}\nmax_y = {:.3f}\nmesh_x_pps = 0\nmax_x = {:.3f}\n",
             mesh.x_low, mesh.z.rows(), mesh.y_low, mesh.z.cols(), mesh.y_high, mesh.x_high);
}

std::vector<ConfigurationFile> klipper(const PresentSetting& present, const std::string& name,
                                       PrinterCorrection& correction) {
  round_to(correction, 1e-9, 1e-6);
  const Skew skew = skew_of(correction, 1e-9);
  const std::string& profile = present.profile;
  std::string text = klipper_head(name, profile, correction);
  if (!correction.no_skew) {
    const std::string open = unmeasured_skews(correction, [](std::string one) {
      for (char& c : one) c = static_cast<char>(c - 'A' + 'a');
      return one + "_skew";
    });
    if (!open.empty())
      text += fmt::format(
          "# Not measured: {}. Klipper needs three numbers: replace each 0 by the present value of the "
          "printer.\n",
          open);
    text += fmt::format("[skew_correction {}]\nxy_skew = {:.9f}\nxz_skew = {:.9f}\nyz_skew = {:.9f}\n",
                        profile, skew.xy, skew.xz, skew.yz);
  }
  if (correction.has_mesh()) text += klipper_mesh(correction.mesh, profile);
  std::string steps = steps_lines(
      present, correction,
      "# rotation_distance of the steppers, in mm per turn. Include this file below the sections of these\n"
      "# steppers in printer.cfg, because a later value replaces an earlier one, or write the values "
      "there.\n",
      true, [](std::size_t i, double next) {
        return fmt::format("[stepper_{}]\nrotation_distance: {:.6f}\n",
                           static_cast<char>('x' + static_cast<int>(i)), next);
      });
  std::vector<ConfigurationFile> files;
  if (correction.has_mesh() || !correction.no_skew) files.push_back({profile + ".cfg", text});
  if (!steps.empty()) files.push_back({profile + "_steppers.cfg", steps});
  return files;
}

std::string reprap_map(const HeightMesh& mesh) {
  const double count = static_cast<double>(mesh.z.size());
  const double mean = mesh.z.sum() / count;
  const double spread = std::sqrt((mesh.z.array() - mean).square().sum() / count);
  std::string map = fmt::format(
      "RepRapFirmware height map file v2 written by vernier, min error {:.3f}, max error {:.3f}, "
      "mean {:.3f}, deviation {:.3f}\n"
      "axis0,axis1,min0,max0,min1,max1,radius,spacing0,spacing1,num0,num1\n"
      "X,Y,{:.2f},{:.2f},{:.2f},{:.2f},-1.00,{:.2f},{:.2f},{},{}\n",
      mesh.z.minCoeff(), mesh.z.maxCoeff(), mean, spread, mesh.x_low, mesh.x_high, mesh.y_low, mesh.y_high,
      (mesh.x_high - mesh.x_low) / static_cast<double>(mesh.z.cols() - 1),
      (mesh.y_high - mesh.y_low) / static_cast<double>(mesh.z.rows() - 1), mesh.z.cols(), mesh.z.rows());
  for (Index row = 0; row < mesh.z.rows(); ++row)
    for (Index column = 0; column < mesh.z.cols(); ++column)
      map += fmt::format("{:7.3f}{}", mesh.z(row, column), column + 1 < mesh.z.cols() ? "," : "\n");
  return map;
}

/// The letters of a command that sets the three skews, without those that were not measured: the firmware
/// keeps its present value of a letter that is absent.
std::string skew_words(const PrinterCorrection& correction,
                       const std::array<std::pair<const char*, std::string>, 3>& words) {
  std::string text;
  for (const auto& [name, word] : words)
    if (correction.measured(name)) text += " " + word;
  return text;
}

/// The line of the lost motion; empty without any. An axis without lost motion keeps the value of the
/// printer.
std::string lost_motion_line(const PrinterCorrection& correction, const char* command, const char* needs) {
  std::string words;
  for (std::size_t i = 0; i < correction.lost_motion.size(); ++i)
    if (correction.lost_motion[i] > 0)
      words += fmt::format(" {}{:.4f}", kLetters[i], correction.lost_motion[i]);
  return words.empty()
             ? ""
             : fmt::format("{}{} ; lost motion at a reversal, mm; needs {}\n", command, words, needs);
}

std::vector<ConfigurationFile> reprap(const PresentSetting& present, const std::string& name,
                                      PrinterCorrection& correction) {
  round_to(correction, 1e-8, 1e-3);
  std::string code = fmt::format(
      "; {}: run in config.g{}\n", name,
      correction.has_mesh() ? "; the heights after homing (G29 S1 P\"vernier_heightmap.csv\")" : "");
  if (!correction.no_skew)
    code += fmt::format("M556 S1000{} ; squareness: mm in 1000 mm of XY (X), YZ (Y), XZ (Z)\n",
                        skew_words(correction, {{{"XY", fmt::format("X{:.5f}", 1000 * correction.xy)},
                                                 {"YZ", fmt::format("Y{:.5f}", 1000 * correction.yz)},
                                                 {"XZ", fmt::format("Z{:.5f}", 1000 * correction.xz)}}}));
  code += steps_lines(present, correction, "", false, [](std::size_t i, double next) {
    return fmt::format("M92 {}{:.6f}\n", kLetters[i], next);
  });
  code += lost_motion_line(correction, "M425", "RepRapFirmware 3.5");
  std::vector<ConfigurationFile> files = {{"vernier.g", code}};
  if (correction.has_mesh()) files.push_back({"vernier_heightmap.csv", reprap_map(correction.mesh)});
  return files;
}

std::string marlin_head(const std::string& name, const PrinterCorrection& correction) {
  const char* const skew = correction.no_skew ? "" : "SKEW_CORRECTION_GCODE, SKEW_CORRECTION_FOR_Z";
  const HeightMesh& mesh = correction.mesh;
  if (!correction.has_mesh())
    return fmt::format("; {}: send once, then M500 stores it.{}{}\n", name,
                       correction.no_skew ? "" : " Marlin needs ", skew);
  return fmt::format(
      "; {}: send once, then M500 stores it. Marlin needs {}{}\n"
      "; a mesh of {} x {} points from ({:.3f}, {:.3f}) to ({:.3f}, {:.3f}) mm\n"
      "; (GRID_MAX_POINTS_X, MESH_MIN_X, MESH_MAX_X ... in its configuration).\n",
      name, skew, correction.no_skew ? "" : " and", mesh.z.cols(), mesh.z.rows(), mesh.x_low, mesh.y_low,
      mesh.x_high, mesh.y_high);
}

std::vector<ConfigurationFile> marlin(const PresentSetting& present, const std::string& name,
                                      PrinterCorrection& correction) {
  round_to(correction, 1e-8, 1e-4);
  const HeightMesh& mesh = correction.mesh;
  const Skew skew = skew_of(correction, 1e-8);
  std::string code = marlin_head(name, correction);
  if (!correction.no_skew)
    code += fmt::format("M852{} ; squareness XY (I), XZ (J), YZ (K)\n",
                        skew_words(correction, {{{"XY", fmt::format("I{:.8f}", skew.xy)},
                                                 {"XZ", fmt::format("J{:.8f}", skew.xz)},
                                                 {"YZ", fmt::format("K{:.8f}", skew.yz)}}}));
  for (Index row = 0; row < mesh.z.rows(); ++row)
    for (Index column = 0; column < mesh.z.cols(); ++column)
      code += fmt::format("M421 I{} J{} Z{:.4f}\n", column, row, mesh.z(row, column));
  if (correction.has_mesh()) code += "M420 S1 Z0 ; heights on, at every height of Z\n";
  code += steps_lines(present, correction, "", false, [](std::size_t i, double next) {
    return fmt::format("M92 {}{:.6f}\n", kLetters[i], next);
  });
  code += lost_motion_line(correction, "M425 F1", "BACKLASH_COMPENSATION and BACKLASH_GCODE");
  return {{"vernier.gcode", code + "M500\n"}};
}

std::vector<ConfigurationFile> grbl(const PresentSetting& present, const std::string& name,
                                    PrinterCorrection& correction) {
  std::string text = fmt::format("({}: steps per mm; grbl supports no other correction)\n", name);
  text += steps_lines(present, correction, "", false,
                      [](std::size_t i, double next) { return fmt::format("${}={:.6f}\n", 100 + i, next); });
  return {{"vernier.nc", text}};
}

}  // namespace

PrinterFeatures features_of(Firmware firmware, const PresentSetting& present) {
  PrinterFeatures features;
  features.steps = present.steps.has_value();
  switch (firmware) {
    case Firmware::kKlipper:
      features.points = {5, 9, 17, 33};
      break;
    case Firmware::kRepRap:
      features.points = {5, 9, 17, 21};  // 441 points at most
      features.lost_motion = true;
      break;
    case Firmware::kMarlin:
      features.points = {5, 9, 15};  // GRID_MAX_POINTS: 15
      features.lost_motion = true;
      break;
    case Firmware::kGrbl:
      features.skew = features.mesh = false;
      break;
  }
  return features;
}

std::vector<ConfigurationFile> firmware_files(Firmware firmware, const PresentSetting& present,
                                              const std::string& machine_name,
                                              PrinterCorrection& correction) {
  switch (firmware) {
    case Firmware::kKlipper:
      return klipper(present, machine_name, correction);
    case Firmware::kRepRap:
      return reprap(present, machine_name, correction);
    case Firmware::kMarlin:
      return marlin(present, machine_name, correction);
    case Firmware::kGrbl:
      break;
  }
  return grbl(present, machine_name, correction);
}

}  // namespace vernier::exchange
