// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <cstddef>
#include <optional>
#include <string>
#include <vector>

namespace vernier::importer {

/// One printed result of a ball-bar file: AF_CIRCULARITY and the like, with its unit type as written
/// (UT_LENGTH_UM …).
struct BallbarFeature {
  std::string name, unit;
  double value = 0;
};

struct BallbarAnalysis {
  std::string name, version;  // "ISO230_4", "1996"; version empty if the file gives no version
  std::vector<BallbarFeature> features;
};

/// A series of the file's own model, on the grid of the clockwise run.
struct BallbarSimulation {
  std::string label;               // "CCW", "CW"
  std::vector<double> reading_mm;  // in time order
};

/// Time and angle of each sample of a run, for a file whose speed between START and END is not constant
/// (repair_time_base).
struct RunClock {
  std::vector<double> turned_deg;  // per sample: from angle 0 in the direction of motion, not wrapped
  std::vector<double> sample;      // its number if no sample had been lost
  std::vector<char> on_circle;     // 0: feed in or out, no part of the repeating motion
  double turn_samples = 0;         // of a whole turn
};

/// One pass over the circle in one direction, overshoot arcs included.
struct BallbarRun {
  std::string label;      // "CCW", "CW"
  int direction = 0;      // +1 counter-clockwise (from +A towards +B), -1 clockwise
  std::size_t start = 0;  // 0-based index of the first sample of the analysed arc
  std::size_t end = 0;    // and of its last one (inclusive)
  double sample_rate_hz = 0;
  double first_deg = 0,
         last_deg = 360;           // the arc from start to end, first_deg < last_deg for both directions
  std::vector<double> reading_mm;  // length - nominal length
  std::vector<BallbarFeature> features;
  std::optional<RunClock> clock;  // nullopt: constant speed, one turn (or arc) from start to end
};

/// A circular test with a telescoping bar, as the software of the instrument stores the test.
struct BallbarFile {
  std::string path, instrument, machine;
  std::string axis_a, axis_b;    // the axes of the plane: "X", "Y"
  double nominal_length_mm = 0;  // of the bar
  double radius_mm = 0;          // of the programmed circle
  double programmed_feed_mm_min = 0;
  std::vector<BallbarRun> runs;  // at least one
  std::vector<BallbarAnalysis> analyses;
  std::vector<BallbarSimulation> simulations;
  std::vector<std::string> notes;  // assumptions, one sentence each
};

}  // namespace vernier::importer
