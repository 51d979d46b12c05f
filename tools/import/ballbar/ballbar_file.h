// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <cstddef>
#include <optional>
#include <string>
#include <vector>

namespace vernier::importer {

/// One printed result of a ball-bar file, for example AF_CIRCULARITY, with the name of its unit as it is in
/// the file (UT_LENGTH_UM …).
struct BallbarFeature {
  std::string name, unit;
  double value = 0;
};

struct BallbarAnalysis {
  std::string name, version;  // for example "ISO230_4" and "1996"; version is empty if the file states no
                              // version
  std::vector<BallbarFeature> features;
};

/// A series of readings that the model in the file computes, on the sample grid of the clockwise run.
struct BallbarSimulation {
  std::string label;               // label of the run: "CCW", "CW"
  std::vector<double> reading_mm;  // computed readings in time order
};

/// Time and angle of each sample of a run. The time and angle of each sample are used if the speed between
/// START and END is not constant (repair_time_base).
struct RunClock {
  std::vector<double> turned_deg;  // angle of each sample from angle 0 in the direction of motion; it exceeds
                                   // 360 deg after a turn
  std::vector<double> sample;      // for each sample: the number that it would have if no sample had been
                                   // lost
  std::vector<char> on_circle;     // for each sample: 0 during feed-in or feed-out, which do not belong to
                                   // the repeated circular motion
  double turn_samples = 0;         // number of samples in a whole turn
};

/// One run: a pass over the circle in one direction, including the overshoot arcs.
struct BallbarRun {
  std::string label;      // "CCW", "CW"
  int direction = 0;      // +1 counter-clockwise (from +A towards +B), -1 clockwise
  std::size_t start = 0;  // index of the first sample of the analysed arc, from 0
  std::size_t end = 0;    // index of the last sample of the analysed arc, from 0
  double sample_rate_hz = 0;
  double first_deg = 0,
         last_deg = 360;           // angles of the analysed arc from start to end, first_deg < last_deg for
                                   // both directions
  std::vector<double> reading_mm;  // measured length minus nominal length
  std::vector<BallbarFeature> features;
  std::optional<RunClock> clock;  // nullopt: the speed is constant, with one turn (or arc) from start to end
};

/// A circular test with a telescoping ball bar, as the software of the instrument stores the test.
struct BallbarFile {
  std::string path, instrument, machine;
  std::string axis_a, axis_b;    // names of the axes of the plane, for example "X", "Y"
  double nominal_length_mm = 0;  // nominal length of the bar
  double radius_mm = 0;          // radius of the programmed circle
  double programmed_feed_mm_min = 0;
  std::vector<BallbarRun> runs;  // at least one
  std::vector<BallbarAnalysis> analyses;
  std::vector<BallbarSimulation> simulations;
  std::vector<std::string> notes;  // assumptions of the reader, one sentence each
};

}  // namespace vernier::importer
