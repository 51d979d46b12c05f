// SPDX-License-Identifier: GPL-3.0-or-later
// Corrected programs as an independent interpreter understands them, beside a correction at every
// millisecond.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "tests/unit/offline/canonical.h"
#include "tests/unit/offline/machine.h"
#include "tools/kinematics/correction.h"
#include "tools/offline/part_program.h"

namespace vernier::offline_test {

using namespace vernier::model;
using namespace vernier::offline;
namespace {

using Eigen::Index, Eigen::Vector3d;

/// Arcs in every plane and both senses, whole, more and less than half, helices; by I J K as a step and as a
/// place, by R, in steps. No arc goes back on the one before: a nearest place is sought along the path.
constexpr const char* kProgram = R"(%
G21 G90 G94 G17
G0 X300 Y150 Z-50
G3 X300 Y150 I0 J50 F3000
G2 X300 Y50 I0 J-50 Z-54
G2 X250 Y100 R50 F1200
G2 X300 Y50 R-50
G18 G2 X350 Z-104 I50 K0
G3 X350 Z-104 I0 K-50 Y45
G19 G2 Y95 Z-154 J50 K0 F4000
G3 Y95 Z-154 J0 K-50
G91 G17 G3 X-50 Y50 I0 J50
G90 G90.1 G2 X250 Y95 I250 J145
G91.1 G3 X250 Y95 I0 J-50 Z-150
G1 X260 Y100 Z-100 F3000
M2
%
)";

/// The places of a path at equal times, and how each axis moves there.
struct Samples {
  std::vector<Vector3d> at, way;
  std::vector<double> feed;  // mm/min
};

Samples sampled(const CanonicalMove& move, double step_s) {
  Samples samples;
  const double time_s = move.length() / (move.feed / 60);
  const auto count = static_cast<int>(std::ceil(time_s / step_s));
  for (int k = 0; k <= count; ++k) {
    const double share = static_cast<double>(k) / count, near = 1e-6;
    const double low = std::max(share - near, 0.0), high = std::min(share + near, 1.0);
    samples.at.push_back(move.at(share));
    samples.way.push_back((move.at(high) - move.at(low)).normalized());
    samples.feed.push_back(move.feed);
  }
  return samples;
}

/// What a correction at every moment makes of the samples; an axis that stands keeps the sense it came with.
std::vector<Vector3d> corrected_at_once(const Machine& machine, const Samples& samples, Vector3d& sense) {
  States states = make_states(samples.at.size(), 3, {});
  for (std::size_t k = 0; k < samples.at.size(); ++k)
    for (std::size_t i = 0; i < 3; ++i) {
      const auto row = static_cast<Index>(k), axis = static_cast<Index>(i);
      const double way = samples.way[k][axis];
      if (std::abs(way) > 1e-5) sense[axis] = way > 0 ? 1 : -1;
      states.axis[i][row] = samples.at[k][axis];
      states.velocity[i][row] = samples.feed[k] / 60 * way;
      states.direction[i][row] = sense[axis];
    }
  const kinematics::CorrectionResult correction = kinematics::correct(machine, states, {});
  std::vector<Vector3d> places = samples.at;
  for (std::size_t k = 0; k < places.size(); ++k)
    for (std::size_t i = 0; i < 3; ++i)
      places[k][static_cast<Index>(i)] += correction.offset[i][static_cast<Index>(k)];
  return places;
}

/// A path as places close to each other with the way to each.
struct Trace {
  std::vector<Vector3d> at;
  std::vector<double> way;
  std::size_t near = 0;  // found last

  void add(const CanonicalMove& move) {
    constexpr double kStep_mm = 0.02;  // at 50 mm its chords are 1 nm off
    const auto count = std::max(1, static_cast<int>(std::ceil(move.length() / kStep_mm)));
    if (at.empty()) at.push_back(move.from), way.push_back(0);
    for (int k = 1; k <= count; ++k) {
      at.push_back(move.at(static_cast<double>(k) / count));
      way.push_back(way.back() + (at.back() - at[at.size() - 2]).norm());
    }
  }

  struct Foot {
    double distance = 0, way = 0;
  };
  /// Nearest place at or after the one that was found last, at most half a millimetre on.
  Foot foot(const Vector3d& point) {
    constexpr double kAhead_mm = 0.5;
    Foot best{HUGE_VAL, 0};
    std::size_t found = near;
    for (std::size_t k = near; k + 1 < at.size() && way[k] <= way[near] + kAhead_mm; ++k) {
      const Vector3d step = at[k + 1] - at[k], off = point - at[k];
      const double share =
          step.squaredNorm() > 0 ? std::clamp(off.dot(step) / step.squaredNorm(), 0.0, 1.0) : 0;
      const double distance = (off - share * step).norm();
      if (distance < best.distance) best = {distance, way[k] + share * (way[k + 1] - way[k])}, found = k;
    }
    near = found;
    return best;
  }
};

struct Judged {
  double worst_mm = 0, feed = 0;  // the largest distance; the largest relative error of the feed over 0.1 s
  std::size_t blocks = 0;
};

/// The written path beside the program's own, corrected at every millisecond.
Judged judge(const Machine& machine, const std::vector<CanonicalMove>& own,
             const std::vector<CanonicalMove>& written) {
  Judged judged{0, 0, written.size()};
  Trace trace;
  for (const CanonicalMove& move : written)
    if (!move.traverse) trace.add(move);
  constexpr double kTick_s = 0.001;
  constexpr std::size_t kFeedOver = 100;
  Vector3d sense = Vector3d::Zero();
  for (const CanonicalMove& move : own) {
    if (move.traverse) continue;
    const std::vector<Vector3d> places = corrected_at_once(machine, sampled(move, kTick_s), sense);
    std::vector<double> way;
    for (const Vector3d& place : places) {
      const Trace::Foot foot = trace.foot(place);
      judged.worst_mm = std::max(judged.worst_mm, foot.distance);
      way.push_back(foot.way);
    }
    // Where feet stand as far apart as places do the feed is the program's, as the F words are.
    const double step = move.length() / static_cast<double>(places.size() - 1);
    for (std::size_t k = kFeedOver; k < way.size(); ++k)
      judged.feed = std::max(judged.feed, std::abs((way[k] - way[k - kFeedOver]) / (kFeedOver * step) - 1));
  }
  return judged;
}

PartProgram corrected(const Machine& machine, bool arcs) {
  Corrector corrector(machine);
  PartProgramOptions options;
  options.zero = {0, 0, 0};
  options.arcs = arcs;
  return corrected_program(kProgram, "part.ngc", at_rest(machine), {0, 0, 0}, options, corrector);
}

TEST(CorrectedArcs, FollowACorrectionEveryMillisecondByAnIndependentInterpreter) {
  if (!has_interpreter()) GTEST_SKIP() << "no rs274 (package linuxcnc-uspace) on this machine";
  const Machine machine = bridge();
  const std::vector<CanonicalMove> own = interpreted(kProgram);
  const PartProgram with_arcs = corrected(machine, true), with_chords = corrected(machine, false);
  const Judged arcs = judge(machine, own, interpreted(with_arcs.text));
  const Judged chords = judge(machine, own, interpreted(with_chords.text));
  std::size_t feeds = 0;
  for (const CanonicalMove& move : interpreted(with_arcs.text)) feeds += move.centre ? 1 : 0;
  fmt::print(
      "blocks {} -> {} ({} arcs), chords {}; farthest {:.3f} um, chords {:.3f}; feed {:.2g}, chords {:.2g}\n",
      own.size(), arcs.blocks, feeds, chords.blocks, 1000 * arcs.worst_mm, 1000 * chords.worst_mm, arcs.feed,
      chords.feed);
  // 0.5 um, of which the interpreter's print takes 0.09.
  EXPECT_LT(arcs.worst_mm, 0.0005);
  EXPECT_LT(chords.worst_mm, 0.0005);
  EXPECT_LT(arcs.feed, 0.01);
  EXPECT_LT(10 * arcs.blocks, chords.blocks);
  EXPECT_EQ(feeds, with_arcs.arcs);
  // The judge sees a correction that is missing.
  EXPECT_GT(judge(machine, own, own).worst_mm, 0.01);
}

TEST(CorrectedArcs, MeanTheSameWhereThereIsNothingToCorrect) {
  if (!has_interpreter()) GTEST_SKIP() << "no rs274 (package linuxcnc-uspace) on this machine";
  const Machine machine = nominal_machine(bridge());
  const std::vector<CanonicalMove> own = interpreted(kProgram),
                                   written = interpreted(corrected(machine, true).text);
  ASSERT_EQ(own.size(), written.size());
  for (std::size_t i = 0; i < own.size(); ++i) {
    EXPECT_EQ(own[i].centre.has_value(), written[i].centre.has_value()) << i;
    for (const double share : {0.25, 0.5, 1.0})
      EXPECT_LT((own[i].at(share) - written[i].at(share)).norm(), 2e-4) << i;  // two prints to 0.0001
    EXPECT_NEAR(own[i].feed, written[i].feed, 1e-3) << i;
  }
}

}  // namespace
}  // namespace vernier::offline_test
