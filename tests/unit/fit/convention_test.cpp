// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/fit/convention.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <numeric>
#include <random>

#include "tests/support/machines.h"
#include "tools/fit/coverage/point_readings.h"
#include "tools/fit/coverage/reach.h"
#include "tools/fit/fit.h"
#include "tools/fit/sanity.h"
#include "tools/maths/alignment.h"
#include "tools/maths/factors.h"
#include "tools/model/chain/chain.h"
#include "tools/model/chain/prediction.h"
#include "tools/model/fit_record.h"
#include "tools/model/machine_reader.h"
#include "tools/model/machine_writer.h"
#include "tools/text/error.h"

namespace vernier::convention_test {

using namespace vernier::fit;
using namespace vernier::model;
namespace {

constexpr std::uint64_t kSeed = 7;
constexpr double kU_mm = 1e-3;

/// A bridge whose tables, squareness and set-ups are free, its true errors, and 300 points measured with one
/// tool.
struct Bridge {
  Machine model = parse_machine(support::bridge_text(7), "bridge.xml"), truth = model;
  Measurement rows;

  /// bad_ram: all is well but the last axis, whose angles are forty times those of the others.
  /// two_stations: the ram's table has no more, and squareness takes its slopes.
  explicit Bridge(std::uint64_t seed = kSeed, bool bad_ram = false, bool two_stations = false) {
    if (two_stations)
      for (Machine* machine : {&model, &truth}) {
        std::vector<Station>& stations = machine->tables.back().stations;
        stations = {stations.front(), stations.back()};
      }
    std::mt19937_64 random(seed);
    std::normal_distribution<double> normal;
    for (Machine* machine : {&model, &truth})
      for (Static& item : machine->statics) item.nominal = item.value;
    for (Table& table : truth.tables)
      for (std::size_t c = 0; c < 6; ++c) {
        double value = 0;
        for (Station& station : table.stations)
          if (table.free[c])
            station.value[c] = value += (c < 3 ? 5e-3 : 5e-4) * normal(random) *
                                        (!bad_ram                         ? 1
                                         : &table != &truth.tables.back() ? 0.1
                                         : c < 3                          ? 1
                                                                          : 4);
      }
    for (Static& item : truth.statics)
      if (!item.hidden) item.value += 1e-5 * normal(random);
    for (BaseShift& shift : truth.base_shifts)
      for (std::size_t c = 0; c < 6; ++c) shift.value[c] = (c < 3 ? 5.0 : 0.05) * normal(random);
    std::string csv = "X[mm],Y[mm],Z[mm],x[mm],y[mm],z[mm],u[mm],run\n";
    std::uniform_real_distribution<double> place(0, 1);
    for (int row = 0; row < 300; ++row) {
      std::string line;
      for (const Axis& axis : model.axes)
        line += std::to_string(*axis.min + (*axis.max - *axis.min) * place(random)) + ",";
      const auto& shift = model.base_shifts[static_cast<std::size_t>(row) % model.base_shifts.size()];
      csv += line + "0,0,0," + std::to_string(kU_mm) + "," + shift.run.value_or("") + "\n";
    }
    rows = parse_measurement(csv, "bridge.csv", model);
    const Eigen::VectorXd exact = predict(truth, rows);
    for (std::size_t i = 0; i < rows.observations.size(); ++i)
      rows.observations[i].value = exact[static_cast<Eigen::Index>(i)] + kU_mm * normal(random);
  }
};

/// Largest difference of two fits, in units of the parameters' scales.
double difference(const FitResult& a, const FitResult& b) {
  double largest = 0;
  for (std::size_t i = 0; i < a.estimates.size(); ++i)
    largest = std::max(largest, std::abs(a.estimates[i].value - b.estimates[i].value) / a.estimates[i].scale);
  return largest;
}

TEST(Convention, TheAnswerDoesNotDependOnTheStart) {
  const Bridge bridge;
  const FitResult reference = fit::fit(bridge.model, bridge.rows);
  ASSERT_TRUE(reference.converged);
  std::mt19937_64 random(kSeed);
  std::normal_distribution<double> normal;
  for (int start = 0; start < 20; ++start) {
    Machine from = bridge.model;
    for (Table& table : from.tables)
      for (Station& station : table.stations)
        for (std::size_t c = 0; c < 6; ++c) station.value[c] = (c < 3 ? 0.05 : 0.05) * normal(random);
    for (Static& item : from.statics)
      if (!item.hidden) item.value += 1e-3 * normal(random);
    EXPECT_LT(difference(reference, fit::fit(from, bridge.rows)), 1e-6)
        << "start " << start << ", seed " << kSeed;
  }
  EXPECT_LT(difference(reference, fit::fit(reference.machine, bridge.rows)), 1e-6);  // refits to itself
}

TEST(Convention, TheAnswerDoesNotDependOnTheOrderOfRowsOrStages) {
  const Bridge bridge;
  const FitResult reference = fit::fit(bridge.model, bridge.rows);
  std::mt19937_64 random(kSeed);
  std::vector<std::size_t> order(bridge.rows.rows());
  std::iota(order.begin(), order.end(), std::size_t{0});
  for (int turn = 0; turn < 20; ++turn) {
    std::shuffle(order.begin(), order.end(), random);
    Measurement shuffled = bridge.rows;
    shuffled.states = select_states(bridge.rows.states, order);
    shuffled.observations.clear();
    for (std::size_t to = 0; to < order.size(); ++to)
      for (Observation o : bridge.rows.observations)
        if (o.row == order[to]) {
          o.row = to;
          shuffled.observations.push_back(o);
        }
    EXPECT_LT(difference(reference, fit::fit(bridge.model, shuffled)), 1e-6) << "order " << turn;
  }
  FitOptions staged;
  staged.stages = {{"BaseShift*"}, {"table.*.rX"}, {"table.*"}};
  const FitResult result = fit::fit(bridge.model, bridge.rows, staged);
  EXPECT_LT(difference(reference, result), 1e-6);
  ASSERT_EQ(result.stages.size(), 4U);  // a line of figures each, and one for all together
  EXPECT_GT(*result.stages[0].fit.rms_um, *result.stages[3].fit.rms_um);
}

/// Scales a hundred times wider: what the data determine stays where it was.
TEST(Convention, LeavesWhatTheDataDetermine) {
  Bridge bridge;
  for (Machine* machine : {&bridge.model, &bridge.truth}) {
    for (Static& item : machine->statics) item.hidden = true;
    machine->base_shifts = bridge.truth.base_shifts;
    machine->base_shifts[0].hidden = true;
    for (std::size_t t = 0; t < 3; ++t) {
      machine->tables[t].free.fill(false);
      machine->tables[t].free[t] = machine->tables[t].free[(t + 1) % 3] = t < 2;
      if (t == 2) machine->tables[t] = bridge.truth.tables[t];
    }
    machine->tables[2].free.fill(false);
  }
  std::mt19937_64 random(kSeed);
  std::normal_distribution<double> normal;
  Machine truth = bridge.model;
  for (std::size_t t = 0; t < 2; ++t)
    for (Station& station : truth.tables[t].stations)
      for (std::size_t c = 0; c < 3; ++c)
        if (truth.tables[t].free[c]) station.value[c] = 5e-3 * normal(random);
  const Eigen::VectorXd exact = predict(truth, bridge.rows);
  for (std::size_t i = 0; i < bridge.rows.observations.size(); ++i)
    bridge.rows.observations[i].value = exact[static_cast<Eigen::Index>(i)] + kU_mm * normal(random);

  const FitResult weak = fit::fit(bridge.model, bridge.rows);
  Machine wide = bridge.model;
  for (Table& table : wide.tables) table.scale.fill(5);
  const FitResult none = fit::fit(wide, bridge.rows);

  std::size_t determined = 0;
  for (std::size_t i = 0; i < weak.estimates.size(); ++i) {
    const ParameterEstimate& estimate = weak.estimates[i];
    if (estimate.from != Origin::kData) continue;
    ++determined;
    EXPECT_LT(std::abs(estimate.value - none.estimates[i].value), 0.01 * none.estimates[i].std)
        << estimate.name;
  }
  EXPECT_GE(determined, 14U);  // the others share the level of Y between the two tables
}

TEST(Convention, PutsRigidMotionIntoTheSetUpAndNothingBeyondItsScale) {
  const Bridge bridge;
  const FitResult result = fit::fit(bridge.model, bridge.rows);
  for (const ParameterEstimate& estimate : result.estimates) {
    EXPECT_TRUE(std::isfinite(estimate.std)) << estimate.name;
    EXPECT_LE(estimate.std, 1.01 * estimate.scale) << estimate.name;
    if (estimate.name.rfind("table", 0) == 0) {
      EXPECT_LT(std::abs(estimate.value), 4 * estimate.scale) << estimate.name;
    }
  }
  double largest = 0, largest_true = 0;
  for (std::size_t t = 0; t < result.machine.tables.size(); ++t)
    for (std::size_t s = 0; s < result.machine.tables[t].stations.size(); ++s)
      for (std::size_t c = 3; c < 6; ++c) {
        largest = std::max(largest, std::abs(result.machine.tables[t].stations[s].value[c]));
        largest_true = std::max(largest_true, std::abs(bridge.truth.tables[t].stations[s].value[c]));
      }
  EXPECT_LT(largest, 2 * largest_true);
}

TEST(Convention, SaysWhatItDecided) {
  const Machine machine = parse_machine(
      "<machine><variables><static><a value=\"0\" unit=\"mm\"/><b value=\"0\" unit=\"mm\"/>"
      "<c value=\"0\" unit=\"mm\" scale=\"0.02\"/><d value=\"0\" unit=\"mm\"/></static>"
      "<machineaxes><X/></machineaxes></variables>"
      "<transforms><sixdof X=\"X+a+b\" Y=\"d\" Z=\"c*0\"/></transforms></machine>",
      "m.xml");
  std::string csv = "X[mm],x[mm],y[mm],u[mm]\n";
  for (int i = 0; i < 20; ++i) csv += fmt::format("{},{},{},0.001\n", 10 * i, 10 * i + 0.2, 0.1);
  const FitResult result = fit::fit(machine, parse_measurement(csv, "m.csv", machine));
  EXPECT_EQ(result.estimates[0].from, Origin::kConvention);  // a and b share what is seen of their sum
  EXPECT_NEAR(result.estimates[0].value, 0.1, 1e-4);
  EXPECT_NEAR(result.estimates[1].value, 0.1, 1e-4);
  EXPECT_EQ(result.estimates[2].from, Origin::kPrior);
  EXPECT_DOUBLE_EQ(result.estimates[2].scale, 0.02);
  EXPECT_NEAR(result.estimates[2].std, 0.02, 1e-6);
  EXPECT_EQ(result.estimates[3].from, Origin::kData);
}

/// 40 machines, a tool that was not measured: the 95 % interval holds the truth 95 times in 100.
/// Of the tool point's coordinates with a tool that was not measured, those that lie within their 95 %
/// interval.
double covered_share(std::uint64_t first, std::uint64_t count, bool bad_ram, bool two_stations = false) {
  std::size_t covered = 0, asked = 0;
  for (std::uint64_t seed = first; seed < first + count; ++seed) {
    const Bridge bridge(seed, bad_ram, two_stations);
    const FitResult result = fit::fit(bridge.model, bridge.rows);
    const Machine said = with_tool(result.machine, {50, -50, -80}),
                  is = with_tool(bridge.truth, {50, -50, -80});
    const Reach reach(said);
    EXPECT_TRUE(reach.known());
    std::vector<std::size_t> some(100);
    std::iota(some.begin(), some.end(), std::size_t{0});
    const States poses = select_states(bridge.rows.states, some);
    const auto covariance = reach.covariance(poses);
    const Eigen::Matrix3Xd from = forward(said, poses).position, to = forward(is, poses).position;
    const Eigen::Matrix3Xd off = maths::aligned_error(maths::align(from, to), from, to);
    for (Eigen::Index i = 0; i < off.cols(); ++i)
      for (Eigen::Index c = 0; c < 3; ++c) {
        covered +=
            std::abs(off(c, i)) < 1.96 * std::sqrt(covariance[static_cast<std::size_t>(i)](c, c)) ? 1 : 0;
        ++asked;
      }
  }
  return static_cast<double>(covered) / static_cast<double>(asked);
}

TEST(Reach, CoversTheTruthWithAToolThatWasNotMeasured) {
  // The poses of one machine go together: some 40 x 5 independent answers, +- 1.5 % each side of 95 %.
  const double share = covered_share(100, 40, false);
  EXPECT_GT(share, 0.90);
  EXPECT_LT(share, 0.99);
}

// What is seen of the good axes says nothing of the angles of a bad one, which one tool cannot see.
TEST(Reach, CoversOneBadAxisAmongGoodOnes) { EXPECT_GT(covered_share(200, 20, true), 0.90); }

// With two stations the ram's angles hide in its squareness. 0.82; 0.58 where squareness said nothing of
// them.
TEST(Reach, CoversMostOfOneBadAxisWhoseSquarenessHidesItsAngles) {
  EXPECT_GT(covered_share(300, 20, true, true), 0.75);
}

// The errors bend the line that was measured by micrometres, which determine no rotation about it.
TEST(Reach, HasTheScaleOfTheParametersBesideALineOfAngles) {
  // GIVEN a fit of angles along one axis
  const Bridge bridge;
  std::string csv = "X[mm],Y[mm],Z[mm],rx[deg],ry[deg],rz[deg],u[deg]\n";
  std::mt19937_64 random(kSeed);
  std::normal_distribution<double> normal;
  for (int i = 0; i <= 60; ++i)
    csv += fmt::format("{},200,-100,{:.7f},{:.7f},{:.7f},0.0001\n", 10 * i,
                       5e-4 * std::sin(0.1 * i) + 1e-4 * normal(random), 1e-4 * normal(random),
                       1e-4 * normal(random));
  const FitResult result = fit::fit(bridge.model, parse_measurement(csv, "a.csv", bridge.model));
  // WHEN the uncertainty is asked for beside the line
  const Reach reach(result.machine);
  const States poses = bridge.rows.states;
  const Eigen::VectorXd std_um = reach.std_um(poses);
  // THEN it has the size of the scales, and comes from parameters that no reading determined
  double scale_um = 0;
  for (const ParameterEstimate& estimate : result.estimates)
    if (estimate.name.starts_with("table.") && estimate.unit == "mm")
      scale_um = std::max(scale_um, 1000 * estimate.scale);
  EXPECT_LT(std_um.maxCoeff(), 20 * scale_um);
  EXPECT_GT(std_um.minCoeff(), 0.1 * scale_um);
  const Eigen::Matrix3Xd open_um = reach.std_unmeasured_um(poses);
  for (Eigen::Index i = 0; i < std_um.size(); ++i) EXPECT_GT(open_um.col(i).norm(), 0.7 * std_um[i]);
}

TEST(FitRecord, TravelsInTheMachineFile) {
  const Bridge bridge;
  const FitResult result = fit::fit(bridge.model, bridge.rows);
  const std::string text = update_machine_text(support::bridge_text(7), result.machine, true);
  const Machine read = parse_machine(text, "fitted.xml");
  ASSERT_TRUE(read.fitted);
  EXPECT_EQ(read.fitted->parameters.size(), result.estimates.size());
  const Reach before(result.machine), after(read);
  EXPECT_TRUE(after.stale().empty());
  const States states = bridge.rows.states;
  EXPECT_LT((before.std_um(states) - after.std_um(states)).cwiseAbs().maxCoeff(), 1e-6);
  // Written again it replaces itself, and a value set by hand is told.
  EXPECT_TRUE(update_machine_text(text, read, false) == text);
  Machine changed = read;
  changed.tables[0].stations[2].value[0] += 1e-3;
  EXPECT_EQ(Reach(changed).stale().size(), 1U);
  EXPECT_FALSE(Reach(bridge.model).known());
}

TEST(FitRecord, KeepsWhatNoReadingBoreOn) {
  const Bridge bridge;
  const FitResult result = fit::fit(bridge.model, bridge.rows);
  const std::string file = update_machine_text(support::bridge_text(7), result.machine, true);
  const Reach reach(parse_machine(file, "fitted.xml"));
  ASSERT_TRUE(reach.open_known());
  // A part of the covariance: no more of any parameter than all of it. Seven digits are kept, and what is
  // below 1e-3 of it is left out.
  const Eigen::VectorXd all = reach.factor().rowwise().squaredNorm(),
                        open = reach.open().rowwise().squaredNorm();
  EXPECT_TRUE((open.array() <= 1.000001 * all.array()).all());
  ASSERT_EQ(static_cast<std::size_t>(all.size()), reach.parameters().size());
  std::size_t nothing = 0, everything = 0;
  for (std::size_t i = 0; i < reach.parameters().size(); ++i) {
    const double share = open[static_cast<Eigen::Index>(i)] / all[static_cast<Eigen::Index>(i)];
    for (const ParameterEstimate& one : result.estimates) {
      if (one.name != reach.parameters()[i].name) continue;
      if (one.from == Origin::kPrior) {
        EXPECT_GT(share, 0.7) << one.name;
        ++everything;
      } else if (one.from == Origin::kData) {
        EXPECT_LT(share, 0.01) << one.name;
        ++nothing;
      }
    }
  }
  EXPECT_GT(nothing + everything, 0u);
  // Numbers of another length are named by their line.
  std::string broken = file;
  const auto at = broken.find("<open numbers=\"") + 15;
  broken.insert(at, "AAAA");
  EXPECT_THROW(parse_machine(broken, "broken.xml"), text::InputError);
  // A file of before says that it does not know.
  std::string older = file;
  const auto from = older.find("<open "), to = older.find("/>", from) + 2;
  older.erase(from, to - from);
  const Reach old(parse_machine(older, "older.xml"));
  EXPECT_TRUE(old.known());
  EXPECT_FALSE(old.open_known());
}

/// A tracker has a frame of its own. A machine file without a set-up cannot follow it, and the message says
/// what to write; with the set-up the same readings are fitted.
TEST(Sanity, NamesAMissingSetUp) {
  const auto fitted = [](const std::string& set_up) {
    const Machine machine =
        parse_machine("<machine name=\"m\"><variables><static><k value=\"0\"/>" + set_up +
                          "</static><machineaxes><X/><Y/><Z/></machineaxes></variables>"
                          "<transforms><sixdof n=\"1\" X=\"X+k*Y\" Y=\"Y\" Z=\"Z\"/></transforms></machine>",
                      "m.xml");
    std::string rows = "X[mm],Y[mm],Z[mm],x[mm],y[mm],z[mm],u[um]\n";
    for (const int x : {0, 300, 700})
      for (const int y : {0, 200, 500})
        for (const int z : {-100, 50, 200})  // turned by 90 deg about x, then shifted
          rows += fmt::format("{},{},{},{},{},{},1\n", x, y, z,
                              x + 1500 + 1e-3 * ((x / 100 + y / 100 + z / 50) % 3 - 1), -z - 400, y + 90);
    return fit::fit(machine, parse_measurement(rows, "tracker.csv", machine));
  };
  const fit::FitResult without = fitted("");
  EXPECT_NE(without.absurd.find("write <BaseShift/> into <static>"), std::string::npos) << without.absurd;
  EXPECT_EQ(fitted("<BaseShift/>").absurd, "");
}

TEST(Convention, AUncertaintyInAnotherUnitIsNamed) {
  const Machine machine = parse_machine(
      R"xml(<machine><variables><machineaxes><X min="0" max="100"/></machineaxes></variables><transforms>
      <sixdof X="X"/></transforms></machine>)xml",
      "m.xml");
  const auto said = [&](const char* u) {
    const Measurement rows = parse_measurement(
        fmt::format("X[mm],x[mm],u[um]\n0,0.01,{0}\n50,50.01,{0}\n100,99.99,{0}\n", u), "bed.csv", machine);
    return fit::unbelievable_u(rows, fit::residuals(machine, rows));
  };
  EXPECT_EQ(said("5"), "");
  EXPECT_EQ(said("0.1"), "") << "a model that misses an effect leaves 100 times u";
  EXPECT_NE(
      said("0.005").find("the residual of bed.csv is 2e+03 times the standard uncertainty u of its readings "
                         "(0.005 um): probably this u is in another unit"),
      std::string::npos)
      << said("0.005");
}

/// A fixed camera sees a board on the tool. Some programs give the pose of the camera in the frame of the
/// board.
TEST(Sanity, NamesInvertedPoses) {
  const Machine machine = parse_machine(
      R"XML(<machine name="m"><variables><static><k value="0"/><BaseShift/><ToolShift/></static><machineaxes>
  <X/><Y/><Z/><B rotary="true"/><C rotary="true"/></machineaxes></variables><transforms>
  <sixdof n="1" X="X+k*Y" Y="Y" Z="Z"/><sixdof n="2" rZ="C"/><sixdof n="3" rY="B"/></transforms></machine>)XML",
      "m.xml");
  const Eigen::Isometry3d camera =
      Eigen::Translation3d(900, 200, 1500) * Eigen::AngleAxisd(2.5, Eigen::Vector3d(1, 2, 0.5).normalized());
  const Eigen::Isometry3d board =
      Eigen::Translation3d(30, -50, -120) * Eigen::AngleAxisd(1.2, Eigen::Vector3d(-1, 1, 3).normalized());
  std::mt19937_64 random(kSeed);
  std::uniform_real_distribution<double> place(0, 400), turn(-60, 60);
  std::normal_distribution<double> noise(0, 0.05);
  std::string right = "X[mm],Y[mm],Z[mm],B[deg],C[deg],x[mm],y[mm],z[mm],rx[deg],ry[deg],rz[deg],u[mm]\n",
              inverted = right;
  for (int i = 0; i < 30; ++i) {
    const double x = place(random), y = place(random), z = place(random), b = turn(random), c = turn(random);
    const Eigen::Isometry3d tool = Eigen::Translation3d(x, y, z) *
                                   Eigen::AngleAxisd(c * maths::kRadPerDeg, Eigen::Vector3d::UnitZ()) *
                                   Eigen::AngleAxisd(b * maths::kRadPerDeg, Eigen::Vector3d::UnitY());
    Eigen::Isometry3d seen = camera.inverse() * tool * board;
    seen.translation() += Eigen::Vector3d(noise(random), noise(random), noise(random));
    const auto row = [&](const Eigen::Isometry3d& pose) {
      const Eigen::AngleAxisd angle(pose.rotation());
      const Eigen::Vector3d t = pose.translation(), r = angle.axis() * angle.angle() / maths::kRadPerDeg;
      return fmt::format("{},{},{},{},{},{},{},{},{},{},{},0.05\n", x, y, z, b, c, t.x(), t.y(), t.z(), r.x(),
                         r.y(), r.z());
    };
    right += row(seen);
    inverted += row(seen.inverse());
  }
  const auto absurd = [&](const std::string& rows) {
    return fit::fit(machine, parse_measurement(rows, "poses.csv", machine)).absurd;
  };
  EXPECT_EQ(absurd(right), "");
  EXPECT_NE(absurd(inverted).find("the poses are probably inverted"), std::string::npos) << absurd(inverted);
}

TEST(Sanity, NamesTheMistakeInTheReadings) {
  const Bridge bridge;
  const auto absurd = [&](Measurement rows) { return fit::fit(bridge.model, rows).absurd; };
  EXPECT_EQ(absurd(bridge.rows), "");
  Measurement swapped = bridge.rows;
  std::swap(swapped.states.axis[0], swapped.states.axis[1]);
  const std::string said = absurd(swapped);
  EXPECT_NE(said.find("columns X and Y look swapped"), std::string::npos) << said;
  Measurement readings = bridge.rows;
  for (Observation& o : readings.observations)
    if (o.kind != ObservationKind::kX)
      o.kind = o.kind == ObservationKind::kY ? ObservationKind::kZ : ObservationKind::kY;
  EXPECT_NE(absurd(readings).find("columns y and z look swapped"), std::string::npos) << absurd(readings);
  Measurement inches = bridge.rows;
  for (Observation& o : inches.observations) o.value /= 25.4;
  EXPECT_NE(absurd(inches).find("inches"), std::string::npos) << absurd(inches);
  Measurement centimetres = bridge.rows;
  for (Observation& o : centimetres.observations) o.value /= 10;
  EXPECT_NE(absurd(centimetres).find("the readings look as if they were in centimetres"), std::string::npos)
      << absurd(centimetres);
  Measurement one_column = bridge.rows;
  for (Observation& o : one_column.observations)
    if (o.kind == ObservationKind::kY) o.value /= 25.4;
  EXPECT_NE(absurd(one_column).find("the column y looks as if it were in inches"), std::string::npos)
      << absurd(one_column);
  Measurement position = bridge.rows;
  position.states.axis[2] /= 25.4;
  EXPECT_NE(absurd(position).find("the column Z looks as if it were in inches"), std::string::npos)
      << absurd(position);
  Measurement typed = bridge.rows;
  typed.observations[40].value = 999876;
  EXPECT_NE(absurd(typed).find("bridge.csv:"), std::string::npos) << absurd(typed);
  EXPECT_NE(absurd(typed).find("is an outlier"), std::string::npos) << absurd(typed);
}

/// A log of a robot in radians, with headings in degrees: no single joint explains it.
TEST(Sanity, NamesJointsInRadians) {
  const Machine arm = parse_machine(
      R"xml(<machine name="arm"><variables><static><a value="300" nominal="300" unit="mm"/><BaseShift/></static>
      <machineaxes><P rotary="true" min="-180" max="180"/><Q rotary="true" min="-180" max="180"/>
      <R rotary="true" min="-180" max="180"/></machineaxes></variables>
      <transforms branch="tool"><sixdof n="1" rZ="P"/><sixdof n="2" X="a" rY="Q"/><sixdof n="3" X="200" rY="R"/>
      <sixdof n="4" X="150"/></transforms></machine>)xml",
      "arm.xml");
  std::mt19937_64 random(kSeed);
  std::uniform_real_distribution<double> joint(-120, 120);
  States states = make_states(40, arm);
  for (Column& axis : states.axis)
    for (double& q : axis) q = joint(random);
  const Eigen::Matrix3Xd points = forward(arm, states).position;
  std::string csv = "P[deg],Q[deg],R[deg],x[mm],y[mm],z[mm],u[um]\n";
  for (Eigen::Index i = 0; i < points.cols(); ++i)
    csv += fmt::format("{:.6f},{:.6f},{:.6f},{:.4f},{:.4f},{:.4f},10\n",
                       states.axis[0][i] * maths::kRadPerDeg, states.axis[1][i] * maths::kRadPerDeg,
                       states.axis[2][i] * maths::kRadPerDeg, points(0, i) + 50, points(1, i), points(2, i));
  const std::string said = fit::fit(arm, parse_measurement(csv, "log.csv", arm)).absurd;
  EXPECT_NE(said.find("the positions of all rotary axes look as if they were in radians"), std::string::npos)
      << said;
  EXPECT_EQ(said.find("a thousand times"), std::string::npos) << said;
}

/// Two meshes of a bed whose screws were turned: other words in `setup` would separate the beds.
TEST(Sanity, TwoMeshesOfOneBedAreNoSetUps) {
  const Machine machine = parse_machine(
      R"xml(<machine name="p"><variables><static><BaseShift/></static><machineaxes><X/><Y/><Z/></machineaxes>
      <artefact name="bed" type="plane"/></variables>
      <transforms><sixdof n="1" X="X" Y="Y" Z="Z"/></transforms></machine>)xml",
      "p.xml");
  const auto mesh = [&](double height, const std::string& file) {
    std::string csv = "X[mm],Y[mm],Z[mm],on\n";
    for (const int x : {0, 100, 200})
      for (const int y : {0, 100, 200})
        csv += fmt::format("{},{},{:.3f},bed\n", x, y, height + 1e-3 * (x % 3));
    return parse_measurement(csv, file, machine);
  };
  Measurement rows = mesh(0, "one.csv");
  append_measurement(rows, mesh(3, "two.csv"));
  const std::string said =
      missing_set_up(machine, rows, convention_of(machine, rows, ParameterSet()).misfit_mm);
  EXPECT_NE(said.find("the touched object has another height or tilt in two.csv than in one.csv"),
            std::string::npos)
      << said;
  EXPECT_EQ(said.find("setup"), std::string::npos) << said;
}

// A load at one place bends the machine by 10 % of the measured box and 0.6 % of its travel. On a gauge whose
// nominal reading is 0 every smaller unit "explains" it.
TEST(Sanity, ADeflectionInASmallBoxIsNoMistake) {
  const char* const text = R"xml(<machine name="m"><variables>
    <inputs><F unit="N"/></inputs>
    <machineaxes><X min="0" max="500"/><Z min="-400" max="0"/></machineaxes></variables>
    <transforms branch="tool"><sixdof n="1" X="X"/><sixdof n="2" Z="Z"/></transforms></machine>)xml";
  const Machine machine = parse_machine(text, "m.xml");
  for (const double zero : {-100.0, 0.0}) {
    std::string rows = "X[mm],Z[mm],F[N],z[mm],u[um]\n";
    for (int i = 0; i < 60; ++i)
      rows += fmt::format("{},{},{},{:.5f},2\n", 100 + 10 * (i % 4), zero, 25 * i,
                          zero - 1.5e-3 * 25 * i + 0.002 * std::sin(7 * i));
    EXPECT_EQ(fit::fit(machine, parse_measurement(rows, "load.csv", machine)).absurd, "") << zero;
  }
}

// point_readings() has no file: a fit of what a machine makes of them names rows all the same.
TEST(Sanity, NamesReadingsThatComeFromNoFile) {
  const Bridge bridge;
  Measurement rows = point_readings(bridge.rows.states);
  const Eigen::VectorXd exact = predict(bridge.model, rows);
  for (std::size_t i = 0; i < rows.observations.size(); ++i)
    rows.observations[i].value = exact[static_cast<Eigen::Index>(i)];
  rows.observations[3 * 6 + 2].value += 50;
  const FitResult result = fit::fit(bridge.model, rows);
  EXPECT_EQ(result.worst.reading, "point:7 z");
}

// A bend by heat that the set-ups take nearly whole: two runs, each at nearly one temperature. What the
// nominal machine leaves of it says nothing of its size; the readings do.
TEST(Convention, ErrorThatSetUpsHideIsAsLargeAsTheReadingsSay) {
  const char* const text = R"xml(<machine name="slides"><variables>
    <static>
      <kb value="0" nominal="0" unit="deg/degC" />
      <BaseShift run="cold" X="0" Y="0" Z="0" rX="0" rY="0" rZ="0" />
      <BaseShift run="warm" X="0" Y="0" Z="0" rX="0" rY="0" rZ="0" />
    </static>
    <inputs><T unit="degC" reference="20" /></inputs>
    <machineaxes><X min="0" max="3000" /><Y min="0" max="1000" /></machineaxes></variables>
    <transforms branch="tool">
      <sixdof n="1" rZ="kb*(T-20)" />
      <sixdof n="2" X="X" Y="Y" />
    </transforms></machine>)xml";
  const Machine model = parse_machine(text, "slides.xml");
  Machine truth = model;
  constexpr double kBend = 0.05;  // deg/degC: 9 mm, of which the set-ups leave 8 um beside 5 um of noise
  truth.statics[0].value = kBend;
  std::mt19937_64 random(kSeed);
  std::uniform_real_distribution<double> place(0, 1);
  std::string csv = "X[mm],Y[mm],T[degC],x[mm],y[mm],z[mm],u[mm],run\n";
  for (int row = 0; row < 300; ++row)
    csv += fmt::format("{},{},{},0,0,0,0.005,{}\n", 3000 * place(random), 1000 * place(random),
                       (row % 2 == 0 ? 21 : 24.5) + 0.02 * (place(random) - 0.5),
                       row % 2 == 0 ? "cold" : "warm");
  Measurement rows = parse_measurement(csv, "slides.csv", model);
  const Eigen::VectorXd exact = predict(truth, rows);
  std::normal_distribution<double> normal;
  for (std::size_t i = 0; i < rows.observations.size(); ++i)
    rows.observations[i].value = exact[static_cast<Eigen::Index>(i)] + 0.005 * normal(random);
  const FitResult result = fit::fit(model, rows);
  ASSERT_TRUE(result.converged);
  const ParameterEstimate& bend = result.estimates[0];
  ASSERT_EQ(bend.name, "kb");
  EXPECT_GT(kBend, 20 * bend.std);
  EXPECT_NEAR(bend.value, kBend, 3 * bend.std);
  EXPECT_LT(result.after.rms_um.value(), 5.5);
}

/// "not measured; stays at nominal" was printed of values that the readings had changed.
TEST(Convention, AValueThatTheReadingsChangedIsNotAtNominal) {
  ParameterEstimate one;
  one.from = Origin::kPrior;
  one.scale = 0.005;
  one.value = one.nominal = 0.1;
  EXPECT_FALSE(one.moved());
  one.value = 0.1 + 1e-9;  // rounding of the solver
  EXPECT_FALSE(one.moved());
  one.value = 0.098;
  EXPECT_TRUE(one.moved());
}

}  // namespace
}  // namespace vernier::convention_test
