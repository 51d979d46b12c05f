// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/probe/circle_path.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "tools/maths/factors.h"
#include "tools/text/error.h"

namespace vernier::probe {
namespace {

/// Axes of a plane, their indices in X Y Z, and the words of the plane and of its arcs' centres.
struct Plane {
  const char* name;
  std::size_t a, b;
  const char* word;
};
constexpr Plane kPlanes[] = {{"XY", 0, 1, "G17"}, {"YZ", 1, 2, "G19"}, {"ZX", 2, 0, "G18"}};

const Plane& plane_of(const CirclePath& path) {
  for (const Plane& plane : kPlanes)
    if (path.plane == plane.name) return plane;
  throw text::InputError({}, path.plane, "the plane must be XY, YZ or ZX");
}

void check(const CirclePath& path) {
  const auto need = [](bool good, const char* word, const char* what) {
    if (!good) throw text::InputError({}, word, what);
  };
  const double arc = path.to_deg - path.from_deg;
  need(path.radius_mm > 0, "radius", "must be above zero");
  need(path.feed_mm_min > 0, "feed", "must be above zero");
  need(arc > 0 && arc <= 360, "arc", "the end of the arc must be above its start, by at most 360 deg");
  need(path.overshoot_deg >= 0 && path.overshoot_deg <= 360, "overshoot",
       "the overshoot must be 0 to 360 deg");
  need(path.feed_in_mm > 0 && path.feed_in_mm < path.radius_mm, "feed-in",
       "the value must be above zero and below the radius");
  need(path.pause_s >= 0, "pause", "must not be negative");
  need(path.acceleration_mm_s2 > 0, "acceleration", "must be above zero");
}

/// Point at an angle and distance from the centre; "-0.000" is written "0.000".
std::array<double, 3> point(const CirclePath& path, double angle_deg, double radius_mm) {
  const Plane& plane = plane_of(path);
  std::array<double, 3> at = path.centre_mm;
  at[plane.a] += radius_mm * std::cos(angle_deg * maths::kRadPerDeg);
  at[plane.b] += radius_mm * std::sin(angle_deg * maths::kRadPerDeg);
  return at;
}

std::string coordinate(char axis, double mm) {
  const double rounded = std::round(mm * 1e3) / 1e3;
  return fmt::format(" {}{:.3f}", axis, rounded == 0 ? 0.0 : rounded);
}

std::string in_plane(const CirclePath& path, const std::array<double, 3>& at) {
  const Plane& plane = plane_of(path);
  std::string words;
  for (std::size_t k = 0; k < 3; ++k)
    if (k == plane.a || k == plane.b) words += coordinate("XYZ"[k], at[k]);
  return words;
}

/// Returns the angles at which the pieces of one direction end, from its start on: pieces of at
/// most one turn.
std::vector<double> pieces(const CirclePath& path, bool ccw) {
  const double from = path.from_deg - path.overshoot_deg, to = path.to_deg + path.overshoot_deg;
  const auto count = static_cast<std::size_t>(std::ceil((to - from) / 360 - 1e-9));
  std::vector<double> ends;
  for (std::size_t i = 0; i <= count; ++i) {
    const double way = (to - from) * static_cast<double>(i) / static_cast<double>(count);
    ends.push_back(ccw ? from + way : to - way);
  }
  return ends;
}

class Blocks {
 public:
  explicit Blocks(bool numbered) : numbered_(numbered) {}
  void add(const std::string& words, const char* remark) {
    if (numbered_) text_ += fmt::format("N{:04d} ", number_ += 10);
    text_ += fmt::format("{} ({})\n", words, remark);
  }
  std::string text() const { return text_; }

 private:
  bool numbered_;
  int number_ = 0;
  std::string text_;
};

void one_sense(const CirclePath& path, bool ccw, Blocks& blocks) {
  const std::vector<double> ends = pieces(path, ccw);
  const Plane& plane = plane_of(path);
  blocks.add("G01" + in_plane(path, point(path, ends.front(), path.radius_mm)), "in feed");
  for (std::size_t i = 1; i < ends.size(); ++i) {
    const auto begin = point(path, ends[i - 1], path.radius_mm);
    std::string arc = (ccw ? "G03" : "G02") + in_plane(path, point(path, ends[i], path.radius_mm));
    for (std::size_t k = 0; k < 3; ++k)
      if (k == plane.a || k == plane.b) arc += coordinate("IJK"[k], path.centre_mm[k] - begin[k]);
    blocks.add(arc, ccw ? "CCW arc" : "CW arc");
  }
  blocks.add("G01" + in_plane(path, point(path, ends.back(), path.radius_mm + path.feed_in_mm)), "out feed");
}

std::string blocks_of(const CirclePath& path, bool linuxcnc) {
  Blocks blocks(!linuxcnc);
  const Plane& plane = plane_of(path);
  blocks.add(linuxcnc ? "G21" : "G71", "input in mm");
  blocks.add("G54", "set origin position");
  blocks.add("G90", "absolute dimensions");
  if (linuxcnc) blocks.add("G91.1", "centres of arcs from their start");
  blocks.add(plane.word, (path.plane + " plane").c_str());
  blocks.add("G64", "disable stopping between moves");
  blocks.add("M05", "extra header code");
  if (!linuxcnc) blocks.add("M19", "extra header code");
  blocks.add(fmt::format("G94 F{:g}", path.feed_mm_min), "feedrate in mm/min");
  std::string start = "G01";
  const auto at = point(path, pieces(path, true).front(), path.radius_mm + path.feed_in_mm);
  for (std::size_t k = 0; k < 3; ++k) start += coordinate("XYZ"[k], at[k]);
  blocks.add(start, "move to start point");
  blocks.add(linuxcnc ? "M0" : "M00", "stop to load ballbar");
  one_sense(path, true, blocks);
  blocks.add(fmt::format("G04 {}{:g}", linuxcnc ? "P" : "X", path.pause_s), "pause between runs");
  one_sense(path, false, blocks);
  blocks.add(linuxcnc ? "M2" : "M30", "end of program");
  return blocks.text();
}

// ---- robots

std::string robot_pose(const CirclePath& path, const std::array<double, 3>& at) {
  std::string text = "p[";
  // To a tenth of a micrometre, without a minus sign before zero.
  for (const double mm : at) text += fmt::format("{:.7f}, ", std::round(mm * 1e4) / 1e7 + 0.0);
  for (std::size_t k = 0; k < 3; ++k)
    text += fmt::format("{:.6f}{}", path.tool_deg[k] * maths::kRadPerDeg, k < 2 ? ", " : "]");
  return text;
}

void robot_sense(const CirclePath& path, bool ccw, std::string& text) {
  // A movec spans less than a turn and needs an intermediate point. With a quarter turn on either
  // side of it, the arc is well conditioned.
  constexpr double kLongestArcDeg = 180;
  const std::vector<double> ends = pieces(path, ccw);
  const double from = ends.front(), way = ends.back() - from;
  const auto count = static_cast<std::size_t>(std::ceil(std::abs(way) / kLongestArcDeg - 1e-9));
  text += fmt::format("  # {}\n", ccw ? "counter-clockwise" : "clockwise");
  text += fmt::format("  movel({}, a=acc, v=vel)\n", robot_pose(path, point(path, from, path.radius_mm)));
  for (std::size_t i = 0; i < count; ++i) {
    const double begin = from + way * static_cast<double>(i) / static_cast<double>(count),
                 end = from + way * static_cast<double>(i + 1) / static_cast<double>(count);
    text += fmt::format("  movec({}, {}, a=acc, v=vel, r={}, mode=1)\n",
                        robot_pose(path, point(path, (begin + end) / 2, path.radius_mm)),
                        robot_pose(path, point(path, end, path.radius_mm)), i + 1 < count ? "blend" : "0");
  }
  text += fmt::format("  movel({}, a=acc, v=vel)\n",
                      robot_pose(path, point(path, ends.back(), path.radius_mm + path.feed_in_mm)));
}

std::string urscript_of(const CirclePath& path) {
  std::string text = "def ballbar():\n";
  text += fmt::format("  vel = {:.6f} # m/s along the circle\n",
                      path.feed_mm_min / maths::kSecondsPerMinute / maths::kUmPerMm);
  text += fmt::format("  acc = {:.6f} # m/s^2\n", path.acceleration_mm_s2 / maths::kUmPerMm);
  text += "  blend = 0.001 # m: so that it does not stop between two arcs\n";
  text += fmt::format(
      "  movel({}, a=acc, v=vel)\n",
      robot_pose(path, point(path, pieces(path, true).front(), path.radius_mm + path.feed_in_mm)));
  text += "  popup(\"load the ball bar\", title=\"ball bar\", blocking=True)\n";
  robot_sense(path, true, text);
  text += fmt::format("  sleep({:g})\n", path.pause_s);
  robot_sense(path, false, text);
  return text + "end\n";
}

}  // namespace

std::string circle_program(const CirclePath& path, CircleDialect dialect) {
  check(path);
  plane_of(path);
  return dialect == CircleDialect::kUrscript ? urscript_of(path)
                                             : blocks_of(path, dialect == CircleDialect::kLinuxcnc);
}

}  // namespace vernier::probe
