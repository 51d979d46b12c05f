// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/probe/path.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <cmath>
#include <cstdlib>
#include <iterator>
#include <optional>

#include "tools/maths/factors.h"
#include "tools/text/error.h"

namespace vernier::probe {
namespace {

/// A touch: start of the approach and its planned end, program units, machine X Y Z (turning: X is
/// Z).
struct Approach {
  double from[3], to[3], feed;
};

double in_program(const ProbePath& path, double mm) { return path.inch ? mm / maths::kMmPerInch : mm; }

int steps_of(const ProbePath& path) {
  if (!(path.step_deg > 0) || path.to_deg < path.from_deg)
    throw text::InputError("the angles --from, --to and --step give no point");
  const double steps = (path.to_deg - path.from_deg) / path.step_deg;
  if (steps > 100000) throw text::InputError("angles: more than 100000 points");
  return static_cast<int>(std::floor(steps + 1e-9)) + 1;
}

void check(const ProbePath& path) {
  if (!(path.radius > 0)) throw text::InputError("the size of the artefact must be above 0");
  if (!(path.clearance > 0)) throw text::InputError("the clearance must be above 0");
  if (path.feeds.empty()) throw text::InputError("the feed is missing");
  for (const double feed : path.feeds)
    if (!(feed > 0)) throw text::InputError(fmt::format("feed {}: not above 0", feed));
}

void check_touches(const ProbePath& path, Dialect dialect) {
  std::optional<double> overtravel;
  // The turning dialect uses the artefact's own surface as the target. The stylus ball reaches
  // beyond it.
  if (dialect != Dialect::kTurning) overtravel = path.overtravel;
  std::vector<std::string> broken;
  for (const double feed : path.feeds)
    for (std::string& reason : broken_conditions(path.conditions, path.inch ? feed * maths::kMmPerInch : feed,
                                                 path.clearance, overtravel))
      broken.push_back(std::move(reason));
  if (broken.empty()) return;
  throw text::LimitNotMet(fmt::format("no valid touches: {}", fmt::join(broken, "; ")));
}

// ---- the turning dialect

// A coordinate in the precision of the published points: six decimals, then single precision.
float point_value(double value) { return std::strtof(fmt::format("{:.6f}", value).c_str(), nullptr); }

void turning_head(const ProbePath& path, std::string& text) {
  auto out = std::back_inserter(text);
  int block = 10;
  fmt::format_to(out, "N{:04d} (ID,PROG,{},{})\n", block, path.name, path.title);
  for (const std::string& comment : path.comments)
    fmt::format_to(out, "N{:04d} ! {}\n", block += 10, comment);
  block = std::max(block + 10, 130);
  const char* const lines[] = {
      path.inch ? "G70 ! INCH MODE" : "G71 ! METRIC MODE",
      "T0500 ! INDEX TURRET TO PROBE",
      path.inch ? "G94 T00 ! INCHES/MIN, CLEAR TOOL" : "G94 T00 ! MM/MIN, CLEAR TOOL",
      "G00 Z(P43) ! RAPID TO PROBING START",
      "G92 X30.4 Z13.0 ! PRESET REF COORDS",
      "M14 ! TURN ON PROBE",
      "M15 !"};
  for (const char* line : lines) {
    fmt::format_to(out, "N{:04d} {}\n", block, line);
    block += 10;
  }
  fmt::format_to(out, "N{:04d} G01 X0.4 Z2.0 F{:g} T0505 ! CLEAR TEST SPHERE\n", block, path.feeds.front());
}

void turning_tail(std::string& text, int block) {
  auto out = std::back_inserter(text);
  const char* const lines[] = {"G00 X30.4 Z13.0 T00 ! BACK TO REF COORDS, CLEAR TOOL",
                               "G92 X0 Z(P43) ! BACK TO PROBING START",
                               "G00 Z10 ! BACK TO INITIAL MACHINE POSITION", "M30 ! REWIND Program"};
  for (const char* line : lines) {
    fmt::format_to(out, "N{:04d} {}\n", block, line);
    block += 5;
  }
  text += "N9999 (END, PROG)\n";
}

std::string turning_program(const ProbePath& path) {
  if (!path.sphere) throw text::InputError("--dialect turning (lathes) writes programs for a sphere only");
  if (path.feeds.size() != 1)
    throw text::InputError("--dialect turning (lathes) accepts one feed: write one program for each feed");
  std::string text;
  turning_head(path, text);
  auto out = std::back_inserter(text);
  const double r = in_program(path, path.radius), far = r + in_program(path, path.clearance);
  const auto offset = static_cast<float>(path.centre_offset);
  int block = 210;
  const int points = steps_of(path);
  for (int i = 0; i < points; ++i, block += 50) {
    const double angle = (path.from_deg + i * path.step_deg) * maths::kRadPerDeg;
    const float x0 = point_value(r * std::cos(angle) - r), y0 = point_value(r * std::sin(angle));
    const float xr = point_value(far * std::cos(angle) - r), yr = point_value(far * std::sin(angle));
    const auto away = static_cast<double>(2 * (yr + offset)), at = static_cast<double>(2 * (y0 + offset));
    fmt::format_to(out, "N{:04d} G01 X{:.5f} Z{:.5f}\n", block, away, static_cast<double>(xr));
    fmt::format_to(out, "N{:04d} G01 X{:.5f} Z{:.5f}\n", block + 5, at, static_cast<double>(x0));
    fmt::format_to(out, "N{:04d} G01 X{:.5f} Z{:.5f}\n", block + 15, away, static_cast<double>(xr));
    fmt::format_to(out, "N{:04d} G04 X{:.1f}\n", block + 30, path.dwell);
  }
  turning_tail(text, block + 5);
  return text;
}

// ---- three axes

std::vector<Approach> sphere_touches(const ProbePath& path) {
  std::vector<Approach> touches;
  const double r = path.radius + path.ball_radius, far = r + path.clearance, deep = r - path.overtravel;
  const int points = steps_of(path);
  for (const double feed : path.feeds)
    for (const double elevation : path.elevations_deg) {
      if (elevation < 0 || elevation > 90)
        throw text::InputError(fmt::format("elevation {}: not in 0..90", elevation));
      const bool pole = elevation == 90;
      for (int i = 0; i < (pole ? 1 : points); ++i) {
        const double phi = (path.from_deg + i * path.step_deg) * maths::kRadPerDeg,
                     e = elevation * maths::kRadPerDeg;
        const double n[3] = {pole ? 0 : std::cos(phi) * std::cos(e), pole ? 0 : std::sin(phi) * std::cos(e),
                             std::sin(e)};
        Approach touch{{}, {}, feed};
        for (int k = 0; k < 3; ++k)
          touch.from[k] = in_program(path, far * n[k]), touch.to[k] = in_program(path, deep * n[k]);
        touches.push_back(touch);
      }
    }
  return touches;
}

// Both faces alternately, so that drift cancels in their difference.
std::vector<Approach> block_touches(const ProbePath& path) {
  std::vector<Approach> touches;
  const double r = path.radius + path.ball_radius;
  for (const double feed : path.feeds)
    for (int i = 0; i < 2 * path.repeats; ++i) {
      const double side = i % 2 == 0 ? 1 : -1;
      touches.push_back({{in_program(path, side * (r + path.clearance)), 0, 0},
                         {in_program(path, side * (r - path.overtravel)), 0, 0},
                         feed});
    }
  return touches;
}

/// Words of a dialect; {x} {y} {z} are coordinates, {f} the feed.
struct Words {
  std::vector<std::string> head, tail;
  const char* comment;   // {} is the text
  const char* rapid;     // to a point
  const char* approach;  // to a point at a feed, stops at a touch
  const char* result;    // reports the position of the touch; empty: the controller does that
};

Words words_of(const ProbePath& path, Dialect dialect) {
  if (dialect == Dialect::kLinuxcnc)
    return {{path.inch ? "G20" : "G21", "G90 G94 G54", "(PROBEOPEN touches.txt)"},
            {"(PROBECLOSE)", "M2"},
            "({})",
            "G0 X{:.5f} Y{:.5f} Z{:.5f}",
            "G38.2 X{:.5f} Y{:.5f} Z{:.5f} F{:g}",
            ""};
  if (dialect == Dialect::kFanuc)
    return {{"%", "O9100", path.inch ? "G20" : "G21", "G90 G94 G54", "POPEN"},
            {"PCLOS", "M30", "%"},
            "({})",
            "G00 X{:.5f} Y{:.5f} Z{:.5f}",
            "G31 X{:.5f} Y{:.5f} Z{:.5f} F{:g}",
            "DPRNT[X#5061[44]*Y#5062[44]*Z#5063[44]]"};
  return {{path.inch ? "PRIMARY UNITS/SECONDS" : "PRIMARY", "ABSOLUTE", "G17",
           "PROBE MODE PROBE_SW_MODE 0 $Position[0]", "PROBE INPUT PROBE_INPUT_DRIVE_DIGITAL X 4"},
          {"PROBE OFF", "END PROGRAM"},
          "' {}",
          "RAPID X{:.5f} Y{:.5f} Z{:.5f}",
          "PROBE ON X Y Z\nLINEAR X{:.5f} Y{:.5f} Z{:.5f} F{:g}\nDWELL 0.1",
          "MSGDISPLAY 1, \"#V1 #V2 #V3\" $Position[0] $Position[1] $Position[2]"};
}

// From one approach to the next around the artefact: up along Z, across, down.
void travel(const ProbePath& path, const Words& words, const Approach& to, std::string& text) {
  auto out = std::back_inserter(text);
  const double safe = in_program(path, path.radius + path.ball_radius + 3 * path.clearance);
  fmt::format_to(out, fmt::runtime(words.rapid), to.from[0], to.from[1], safe);
  text += '\n';
  fmt::format_to(out, fmt::runtime(words.rapid), to.from[0], to.from[1], to.from[2]);
  text += '\n';
}

std::string three_axis_program(const ProbePath& path, Dialect dialect) {
  const Words words = words_of(path, dialect);
  const auto touches = path.sphere ? sphere_touches(path) : block_touches(path);
  std::string text;
  auto out = std::back_inserter(text);
  const auto lines = [&](const std::vector<std::string>& all) {
    for (const std::string& line : all) text += line + "\n";
  };
  std::vector<std::string> head = words.head;
  // A program that begins with % must have nothing before it.
  const std::size_t first = head.front() == "%" ? 2 : 0;
  lines({head.begin(), head.begin() + static_cast<std::ptrdiff_t>(first)});
  fmt::format_to(out, fmt::runtime(words.comment), path.title);
  text += '\n';
  for (const std::string& comment : path.comments) {
    fmt::format_to(out, fmt::runtime(words.comment), comment);
    text += '\n';
  }
  fmt::format_to(out, fmt::runtime(words.comment),
                 path.sphere ? "zero: centre of the sphere"
                             : "zero: middle between the faces; X is perpendicular to the faces");
  text += '\n';
  lines({head.begin() + static_cast<std::ptrdiff_t>(first), head.end()});
  for (const Approach& touch : touches) {
    travel(path, words, touch, text);
    fmt::format_to(out, fmt::runtime(words.approach), touch.to[0], touch.to[1], touch.to[2], touch.feed);
    text += '\n';
    if (*words.result != 0) text += std::string(words.result) + "\n";
    fmt::format_to(out, fmt::runtime(words.rapid), touch.from[0], touch.from[1], touch.from[2]);
    text += '\n';
    const double safe = in_program(path, path.radius + path.ball_radius + 3 * path.clearance);
    fmt::format_to(out, fmt::runtime(words.rapid), touch.from[0], touch.from[1], safe);
    text += '\n';
  }
  lines(words.tail);
  return text;
}

}  // namespace

std::string probe_program(const ProbePath& path, Dialect dialect) {
  check(path);
  if (!path.unchecked) check_touches(path, dialect);
  return dialect == Dialect::kTurning ? turning_program(path) : three_axis_program(path, dialect);
}

}  // namespace vernier::probe
