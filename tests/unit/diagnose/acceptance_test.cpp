// SPDX-License-Identifier: GPL-3.0-or-later
// Leaving runs out in one go, against really fitting again without them; the tail of chi^2.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <map>
#include <optional>
#include <random>
#include <set>

#include "tools/diagnose/acceptance.h"
#include "tools/diagnose/propose/evidence.h"
#include "tools/effects/add.h"
#include "tools/effects/add_string.h"
#include "tools/maths/chance.h"
#include "tools/model/machine_reader.h"

namespace vernier::acceptance_test {

using namespace vernier::diagnose;
using namespace vernier::effects;
using namespace vernier::fit;
using namespace vernier::maths;
using namespace vernier::model;
namespace {

constexpr std::uint64_t kSeed = 11;

/// Percentage points of chi^2, NIST/SEMATECH e-Handbook 1.3.6.7.4, and closed forms for even freedom.
TEST(ChiSquareTail, AgreesWithTheTables) {
  for (const auto& [value, freedom, tail] : {std::tuple{3.841, 1.0, 0.05},
                                             {6.635, 1.0, 0.01},
                                             {10.828, 1.0, 0.001},
                                             {11.070, 5.0, 0.05},
                                             {18.307, 10.0, 0.05},
                                             {29.588, 10.0, 0.001},
                                             {124.342, 100.0, 0.05},
                                             {149.449, 100.0, 0.001},
                                             {77.929, 100.0, 0.95}})
    EXPECT_NEAR(chi_square_tail(value, freedom), tail, 2e-3 * tail) << value << " " << freedom;
  for (const double value : {0.1, 1.0, 5.0, 40.0, 600.0}) {
    EXPECT_NEAR(chi_square_tail(value, 2), std::exp(-value / 2), 1e-12 * std::exp(-value / 2) + 1e-300);
    EXPECT_NEAR(chi_square_tail(value, 4), (1 + value / 2) * std::exp(-value / 2),
                1e-11 * std::exp(-value / 2) * value + 1e-300);
    EXPECT_NEAR(chi_square_tail(value, 1), std::erfc(std::sqrt(value / 2)), 1e-12);
  }
  EXPECT_EQ(chi_square_tail(0, 3), 1);
  EXPECT_EQ(chi_square_tail(-2, 3), 1);
  EXPECT_GE(chi_square_tail(1e5, 3), 0);
  EXPECT_LT(chi_square_tail(1e5, 3), 1e-300);
}

TEST(ChiSquareTail, FallsSteadilyAcrossTheChangeOfMethod) {
  for (const double freedom : {1.0, 2.0, 7.0, 50.0, 1000.0}) {
    double before = 1;
    for (double value = 0.5 * freedom; value < 2 * freedom + 4; value += 0.01 * freedom) {
      const double now = chi_square_tail(value, freedom);
      EXPECT_LE(now, before + 1e-12) << freedom << " " << value;
      before = now;
    }
  }
}

/// One axis with a free offset and scale, four runs of different length, reversal error hidden. None holds a
/// third of the rows: such a one would be left out in parts.
std::string rows_of(bool shifted_runs) {
  std::mt19937_64 random(kSeed);
  std::normal_distribution<double> noise(0, 0.002);
  std::string text = "X[mm],dirX,x[mm],u[um],run,role\n";
  for (int run = 0; run < 4; ++run)
    for (int i = 0; i < 12 + 2 * run; ++i) {
      const double x = 40.0 * i + 7 * run, dir = i % 3 == 0 ? 1 : -1;
      const double shift = shifted_runs ? 0.1 * run : 0;
      const double reading = x + 0.01 + 2e-5 * x + 0.003 * dir + shift + noise(random);
      text += std::to_string(x) + "," + std::to_string(dir) + "," + std::to_string(reading) + "," +
              std::to_string(1 + i % 2) + ",r" + std::to_string(run) + ",fit\n";
    }
  return text + "5,1,9,1,r0,check\n";  // enters nothing
}

constexpr const char* kLine =
    "<machine><variables><static><a value=\"0\" nominal=\"0\"/><s value=\"0\" nominal=\"0\"/>%</static>"
    "<machineaxes><X min=\"0\" max=\"1000\"/></machineaxes></variables>"
    "<transforms><sixdof X=\"X+a+s*X\"/></transforms></machine>";

std::string line_text(const std::string& statics) {
  std::string text = kLine;
  return text.replace(text.find('%'), 1, statics);
}

struct Setting {
  std::string text;
  Machine machine;
  Measurement rows;
  Evidence evidence;
  Candidate backlash;
  Eigen::MatrixXd columns;  // projected

  Setting(const std::string& machine_text, const std::string& csv)
      : text(machine_text),
        machine(parse_machine(text, "line.xml")),
        rows(parse_measurement(csv, "rows.csv", machine)),
        evidence(fit::fit(machine, rows).machine, rows),
        backlash(make_candidate(machine, parse_add_string("backlash:axis=X", machine, built_in_effects()))),
        columns(evidence.columns(backlash, {})) {
    columns -= evidence.absorbed() * (evidence.absorbed().transpose() * columns);
  }

  /// Sum of squares of one run predicted by a fit to the others; `local_mean`: its own shift is fitted to it.
  double refitted(const Machine& model, std::size_t run, bool local_mean) const {
    Measurement others = rows;
    for (std::size_t row = 0; row < rows.rows(); ++row)
      if (rows.states.run[row] == run) others.check[row] = 1;
    const FitResult result = fit::fit(model, others);
    double weights = 0, mean = 0, sum = 0;
    for (int pass = 0; pass < 2; ++pass) {
      sum = 0;
      for (std::size_t i = 0; i < rows.observations.size(); ++i) {
        const std::size_t row = rows.observations[i].row;
        if (rows.states.run[row] != run || rows.check[row] != 0) continue;
        const double weight = std::pow(rows.uncertainty[static_cast<Eigen::Index>(row)], -2);
        const double error = result.residual[static_cast<Eigen::Index>(i)];
        if (pass == 0) {
          weights += weight;
          mean += weight * error;
        }
        const double left = error - (local_mean ? mean / weights : 0);
        sum += weight * left * left;
      }
      if (pass == 0 && !local_mean) break;
    }
    return sum;
  }
};

TEST(LeaveRunsOut, IsTheRefitWithoutEachRun) {
  const Setting s(line_text(""), rows_of(false));
  const Machine with = parse_machine(add_to_machine_text(s.text, s.machine, s.backlash), "with.xml");
  double refitted_with = 0, refitted_without = 0;
  for (std::size_t run = 0; run < 4; ++run) {
    refitted_with += s.refitted(with, run, false);
    refitted_without += s.refitted(s.machine, run, false);
  }
  const HeldOut held_with = leave_blocks_out(s.evidence, s.columns, 0, 1, s.evidence.blocks());
  const HeldOut held_without =
      leave_blocks_out(s.evidence, Eigen::MatrixXd(s.columns.rows(), 0), 0, 0, s.evidence.blocks());
  EXPECT_NEAR(held_with.chi_square, refitted_with, 1e-6 * refitted_with);
  EXPECT_NEAR(held_without.chi_square, refitted_without, 1e-6 * refitted_without);
  EXPECT_LT(held_with.chi_square, 0.6 * held_without.chi_square) << "the effect is there";
  ASSERT_EQ(held_with.agreement.size(), 4U);
  for (const double cosine : held_with.agreement) EXPECT_NEAR(cosine, 1, 1e-9);  // one column, one sign
}

/// The shift of a run is known from no other: it is fitted to the run that is left out, nothing else is.
TEST(LeaveRunsOut, FitsToARunWhatOnlyItDetermines) {
  const Setting s(line_text("<BaseShift Hide=\"true\"/><BaseShift run=\"r1\" X=\"0\" Y=\"0\" Z=\"0\"/>"
                            "<BaseShift run=\"r2\" X=\"0\"/><BaseShift run=\"r3\" X=\"0\"/>"),
                  rows_of(true));
  const Machine with = parse_machine(add_to_machine_text(s.text, s.machine, s.backlash), "with.xml");
  double refitted = 0;
  for (std::size_t run = 1; run < 4; ++run) refitted += s.refitted(with, run, true);
  // r0 has the hidden shift; without it the offset a and the shifts of the others cannot be told apart, and
  // its own mean is free as well.
  refitted += s.refitted(with, 0, true);
  const HeldOut held = leave_blocks_out(s.evidence, s.columns, 0, 1, s.evidence.blocks());
  EXPECT_NEAR(held.chi_square, refitted, 1e-5 * refitted);
}

TEST(PlaceBlocks, HoldOutStretchesTargetsAndCornersOfAnAxis) {
  const Setting s(line_text(""), rows_of(false));
  const std::vector<std::vector<int>> blocks = place_blocks(s.evidence, 0);
  ASSERT_EQ(blocks.size(), 3U) << "three inner stretches, every fifth target, two halves";
  const Column& x = s.evidence.measurement().states.axis[0];
  std::map<double, std::size_t> at;  // any reading of a position
  for (std::size_t i = 0; i < s.evidence.rows().size(); ++i)
    at.emplace(x[static_cast<Eigen::Index>(s.evidence.rows()[i])], i);
  std::vector<int> stretches, halves;
  for (const auto& [position, reading] : at) {
    stretches.push_back(blocks[0][reading]);
    halves.push_back(blocks[2][reading]);
  }
  // The two ends are never held out: a curve would have to extrapolate.
  EXPECT_EQ(std::set<int>(stretches.begin(), stretches.end()), (std::set<int>{-1, 0, 1, 2}));
  EXPECT_EQ(stretches.front(), -1);
  EXPECT_EQ(stretches.back(), -1);
  const auto inner = [](int stretch) { return stretch >= 0; };
  std::vector<int> held;
  std::copy_if(stretches.begin(), stretches.end(), std::back_inserter(held), inner);
  EXPECT_TRUE(std::is_sorted(held.begin(), held.end()));
  EXPECT_TRUE(std::is_sorted(halves.begin(), halves.end()));
  EXPECT_EQ(halves.back(), 1);
  EXPECT_EQ(std::set<int>(blocks[1].begin(), blocks[1].end()), (std::set<int>{0, 1, 2, 3, 4}));
  // All readings at one target are held out together, or another reading would tell its error.
  for (std::size_t i = 0; i < s.evidence.rows().size(); ++i) {
    const std::size_t same = at.at(x[static_cast<Eigen::Index>(s.evidence.rows()[i])]);
    for (const std::vector<int>& division : blocks) EXPECT_EQ(division[i], division[same]);
  }
  EXPECT_EQ(place_blocks(s.evidence, std::nullopt).size(), 1U) << "without an axis: the corners alone";
}

/// A bump of 40 um on a tenth of the axis: runs repeat it, so a polynomial of degree 7 predicts held-out runs
/// better than no term. Between the bump and the ends of the axis the polynomial is wrong, which only
/// held-out stretches show.
TEST(PlaceBlocks, ContradictATermThatEveryRunRepeats) {
  std::mt19937_64 random(kSeed);
  std::normal_distribution<double> noise(0, 0.001);
  std::string text = "X[mm],x[mm],u[um],run\n";
  for (int run = 0; run < 4; ++run)
    for (int i = 0; i <= 50; ++i) {
      const double x = 20.0 * i, bump = x > 410 && x < 510 ? 0.04 : 0;
      text += std::to_string(x) + "," + std::to_string(x + bump + noise(random)) + ",1,r" +
              std::to_string(run) + "\n";
    }
  const Setting s(line_text(""), text);
  constexpr Eigen::Index kDegrees = 6;  // 2 to 7: offset and scale are free
  Eigen::MatrixXd powers(s.evidence.residual().size(), kDegrees);
  const Column& x = s.evidence.measurement().states.axis[0];
  for (Eigen::Index i = 0; i < powers.rows(); ++i)
    for (Eigen::Index k = 0; k < kDegrees; ++k)
      powers(i, k) =
          std::pow(x[static_cast<Eigen::Index>(s.evidence.rows()[static_cast<std::size_t>(i)])] / 500 - 1,
                   static_cast<double>(k + 2));
  powers -= s.evidence.absorbed() * (s.evidence.absorbed().transpose() * powers);
  const Eigen::MatrixXd nothing(powers.rows(), 0);
  EXPECT_LT(leave_blocks_out(s.evidence, powers, 0, 0, s.evidence.blocks()).chi_square,
            0.8 * leave_blocks_out(s.evidence, nothing, 0, 0, s.evidence.blocks()).chi_square);
  const std::vector<int> stretches = place_blocks(s.evidence, 0).front();
  EXPECT_GT(leave_blocks_out(s.evidence, powers, 0, 0, stretches).chi_square,
            leave_blocks_out(s.evidence, nothing, 0, 0, stretches).chi_square);
}

/// Three readings at each of 60 places of one run, which share an error of `shared` um beside 1 um of their
/// own.
std::string poses(double shared_um) {
  std::mt19937_64 random(kSeed);
  std::normal_distribution<double> normal;
  std::string text = "X[mm],x[mm]\n";
  for (int pose = 0; pose < 60; ++pose) {
    const double x = 16.0 * pose, common = 1e-3 * shared_um * normal(random);
    for (int i = 0; i < 3; ++i)
      text += std::to_string(x) + "," + std::to_string(x + common + 1e-3 * normal(random)) + "\n";
  }
  return text;
}

TEST(SharedPoseError, IsTheRatioOfVariancesAndNothingForWhiteNoise) {
  for (const double shared : {0.0, 2.0}) {
    Setting s(line_text(""), poses(shared));
    const Eigen::MatrixXd nothing(s.evidence.residual().size(), 0);
    const double found = s.evidence.shared_pose_error(s.evidence.residual(), nothing);
    // The spread of a ratio of variances on 58 and 120 degrees of freedom is 23 %; three of them.
    if (shared > 0)
      EXPECT_NEAR(found, 4, 0.7 * 4) << "seed " << kSeed;
    else
      EXPECT_EQ(found, 0) << "seed " << kSeed;
  }
}

/// Weighed by the shared error the residual is white again, and a column that is the same within each pose
/// keeps 1 / (1 + 3 share) of its square.
TEST(SharedPoseError, WeighingLeavesWhiteNoise) {
  Setting s(line_text(""), poses(2));
  const Eigen::MatrixXd nothing(s.evidence.residual().size(), 0);
  const double share = s.evidence.shared_pose_error(s.evidence.residual(), nothing);
  s.evidence.weigh_poses(share);
  EXPECT_EQ(s.evidence.shared_pose_error(s.evidence.residual(), nothing), 0);
  Eigen::MatrixXd ones = Eigen::MatrixXd::Ones(nothing.rows(), 1);
  s.evidence.whiten(ones);
  EXPECT_NEAR(ones.squaredNorm(), 180 / (1 + 3 * share), 1e-9 * 180);
  EXPECT_LT((s.evidence.absorbed().transpose() * s.evidence.residual()).norm(),
            1e-9 * s.evidence.residual().norm());
}

}  // namespace
}  // namespace vernier::acceptance_test
