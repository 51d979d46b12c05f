// SPDX-License-Identifier: GPL-3.0-or-later
// Rows that say only which image ran: its own equation gives what it added.
#include "tools/simulate/corrected.h"

#include <fmt/format.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <cmath>
#include <filesystem>
#include <random>

#include "tools/compile/compile.h"
#include "tools/model/chain/prediction.h"
#include "tools/model/machine_reader.h"
#include "tools/simulate/loop.h"
#include "tools/text/error.h"
#include "tools/text/files.h"

namespace vernier::corrected_test {

using namespace vernier::compile;
using namespace vernier::model;
using namespace vernier::simulate;
using namespace vernier::text;
namespace {

namespace fs = std::filesystem;
constexpr std::uint64_t kSeed = 3;

/// Squareness, backlash, thermal scale, a table on X, and where asked for a lagging temperature; X is limited
/// to `most` mm.
std::string machine_text(const std::string& lagging = "", double most = 0.5) {
  return fmt::format(R"xml(<machine name="bridge"><variables>
  <static><sq value="0.01" nominal="0" unit="deg"/><bl value="0.003" nominal="0" unit="mm"/>
    <cte value="1.1e-5" nominal="0"/><tk value="0.002" nominal="0"/></static>
  <machineaxes><X rotary="false" min="0" max="600" maxcorrection="{}"/><Y rotary="false" min="0" max="400"/>
    <Z rotary="false" min="-300" max="0"/></machineaxes>
  <inputs><T unit="degC" reference="20" min="10" max="30"/></inputs>
  <comptables><table axis="X">
    <station loc="0" X="0" Y="0" Z="0" rX="0" rY="0" rZ="0"/>
    <station loc="300" X="0.01" Y="0.005" Z="-0.004" rX="0.001" rY="-0.002" rZ="0.001"/>
    <station loc="600" X="-0.01" Y="0" Z="0.004" rX="0" rY="0.001" rZ="-0.001"/></table></comptables></variables>
  <transforms branch="tool">
    <sixdof n="1" X="0" Y="Y+cte*Y*(T-20)" Z="0" rX="0" rY="0" rZ="0"/>
    <sixdof n="2" X="X+lXx+bl*dirX+sin(sq)*Y{}" Y="lXy" Z="lXz" rX="rXx" rY="rXy" rZ="rXz"/>
    <sixdof n="3" X="0" Y="0" Z="Z" rX="0" rY="0" rZ="0"/></transforms></machine>)xml",
                     most, lagging);
}

/// The machine as somebody fits it: it knows no T, so that T is a column of its own.
Machine fitted() {
  return parse_machine(R"xml(<machine><variables><static><s value="0" nominal="0"/></static>
  <machineaxes><Z/><Y/><X/></machineaxes></variables>
  <transforms><sixdof X="X+s*X" Y="Y" Z="Z"/></transforms></machine>)xml",
                       "fitted.xml");
}

class CorrectedRows : public testing::Test {
 protected:
  ~CorrectedRows() override { fs::remove_all(directory_); }

  /// Compiles into a folder below the one that is searched. Returns the fingerprint.
  std::string compile(const std::string& text, const std::string& name) {
    const CompiledMachine compiled = compile_machine(parse_machine(text, name), text, {});
    const std::string folder = directory_ + "/of_june/" + name;
    fs::create_directories(folder);
    write_file(folder + "/machine.xml", text);
    write_file(folder + "/machine.vimg", {compiled.image.begin(), compiled.image.end()});
    return fmt::format("{:016x}", compiled.fingerprint);
  }
  Measurement read(const std::string& csv) {
    return parse_measurement(csv, "on.csv", fitted(), corrections_of_images(directory_));
  }
  std::string error_of(const std::string& csv) {
    try {
      read(csv);
    } catch (const InputError& error) {
      return error.what();
    }
    return "accepted";
  }

  std::string directory_ = testing::TempDir() + "corrected_" + std::to_string(getpid());
};

/// What the firmware loop writes while the machine stands at a row: the other way to the same numbers.
std::vector<double> loop_correction(const LoadedImage& image, const States& states, std::size_t row) {
  const LoopResult result = run_loop(image.view, image.machine, select_states(states, {row}), {});
  std::vector<double> all;
  for (const Column& axis : result.correction) all.push_back(axis[0]);
  return all;
}

TEST_F(CorrectedRows, AreThoseOfTheFirmwareLoop) {
  SCOPED_TRACE(kSeed);
  const std::string fingerprint = compile(machine_text(), "plain");
  const auto image = load_image_dir(directory_ + "/of_june/plain");
  std::mt19937_64 random(kSeed);
  std::uniform_real_distribution<double> share(0, 1);
  std::string csv = "X[mm],Y[mm],Z[mm],dirX,T[degC],x[mm],corrected\n";
  for (int i = 0; i < 40; ++i)
    csv += fmt::format("{:.4f},{:.4f},{:.4f},{},{:.3f},0,{}\n", 600 * share(random), 400 * share(random),
                       -300 * share(random), i % 2 == 0 ? 1 : -1, 15 + 10 * share(random),
                       i % 4 == 3 ? "" : fingerprint);
  const Measurement m = read(csv);
  const Measurement at_image = parse_measurement(csv, "on.csv", image->machine, [](auto&&...) {});
  double largest = 0;
  for (std::size_t row = 0; row < m.rows(); ++row) {
    const std::vector<double> expected = loop_correction(*image, at_image.states, row);
    for (std::size_t i = 0; i < 3; ++i) {
      const auto axis = *fitted().find_axis(image->machine.axes[i].name);
      const double found = m.correction[axis][static_cast<Eigen::Index>(row)];
      // One count of the image is 1e-6 mm; a row without the image has none.
      EXPECT_NEAR(found, row % 4 == 3 ? 0 : expected[i], 1.01e-6) << row << " " << i;
      largest = std::max(largest, std::abs(found));
    }
  }
  EXPECT_GT(largest, 0.01);
}

TEST_F(CorrectedRows, GiveWhatTheColumnsWouldHaveGiven) {
  const std::string fingerprint = compile(machine_text(), "plain");
  std::string by_image = "X[mm],Y[mm],Z[mm],dirX,T[degC],x[mm],y[mm],z[mm],corrected\n",
              by_column =
                  "X[mm],Y[mm],Z[mm],dirX,T[degC],x[mm],y[mm],z[mm],correctionX[um],correctionY[um],"
                  "correctionZ[um]\n";
  const auto image = load_image_dir(directory_ + "/of_june/plain");
  for (int i = 0; i < 20; ++i) {
    const std::string row = fmt::format("{},{},{},1,{},0,0,0", 30 * i, 20 * (19 - i), -10 * i, 20 + 0.1 * i);
    by_image += row + "," + fingerprint + "\n";
    const Measurement one = parse_measurement(
        "X[mm],Y[mm],Z[mm],dirX,T[degC],x[mm],y[mm],z[mm]\n" + row + "\n", "one.csv", image->machine);
    by_column += row;
    for (const double correction : loop_correction(*image, one.states, 0))
      by_column += fmt::format(",{:.6f}", 1e3 * correction);
    by_column += "\n";
  }
  const Measurement a = read(by_image), b = read(by_column);
  const Eigen::VectorXd difference = predict(fitted(), a) - predict(fitted(), b);
  EXPECT_LT(difference.cwiseAbs().maxCoeff(), 1.01e-6);  // a count of the image
  EXPECT_GT((a.states.axis[0] - commanded(a, 0)).abs().maxCoeff(), 1e-3);
}

TEST_F(CorrectedRows, HoldTheImagesMagnitudeLimit) {
  const std::string fingerprint = compile(machine_text("", 0.005), "limited");
  const Measurement m =
      read("X[mm],Y[mm],Z[mm],dirX,T[degC],x[mm],corrected\n10,400,0,1,20,0," + fingerprint + "\n");
  EXPECT_NEAR(m.correction[*fitted().find_axis("X")][0], -0.005, 1.01e-6);
}

TEST_F(CorrectedRows, LagsFollowTheRowsOfTheirRun) {
  // T rises from 20 by 1 K/s; x gets 2 um/K of it with a time constant of 3 s.
  const std::string fingerprint = compile(machine_text("+tk*lag(T-20,3)"), "lagging");
  std::string csv = "t[s],X[mm],Y[mm],Z[mm],T[degC],x[mm],run,corrected\n";
  for (const char* run : {"a", "b"})
    for (const double t : {100.0, 100.7, 103.0, 108.0})
      csv += fmt::format("{},0,0,0,{},0,{},{}\n", t, t - 80, run, fingerprint);
  const Measurement m = read(csv);
  const Column& correction = m.correction[*fitted().find_axis("X")];
  for (std::size_t row = 0; row < 8; ++row) {
    const double t = m.states.time[static_cast<Eigen::Index>(row)] - 100;
    // First-order lag of a ramp: u - tau (1 - exp(-t / tau)).
    const double lagging = t - 3 * (1 - std::exp(-t / 3));
    // A tick of a K/s is 1e-3 K; the lag's own steps are of the image's resolution.
    EXPECT_NEAR(correction[static_cast<Eigen::Index>(row)], -0.002 * lagging, 5e-6) << row;
  }
  EXPECT_NE(error_of("X[mm],Y[mm],Z[mm],T[degC],x[mm],corrected\n1,1,1,20,0," + fingerprint + "\n")
                .find("\"t\": the image that ran has terms with lag"),
            std::string::npos);
}

TEST_F(CorrectedRows, NameFileLineAndWordWhereTheyCannotBeUnderstood) {
  const std::string fingerprint = compile(machine_text(), "plain");
  const std::string head = "X[mm],Y[mm],Z[mm],T[degC],x[mm],corrected\n1,1,1,20,0,\n";
  EXPECT_EQ(error_of(head + "1,1,1,20,0,0123456789abcdef\n").substr(0, 28), "on.csv:3: \"0123456789abcdef\"");
  EXPECT_EQ(error_of(head + "1,1,1,,0," + fingerprint + "\n").substr(0, 28),
            "on.csv:3: \"" + fingerprint + "\"");
  EXPECT_THROW(corrections_of_images(directory_ + "/none"), InputError);
  EXPECT_EQ(error_of(head + "1,1,1,20,0," + fingerprint + "\n"), "accepted");
}

}  // namespace
}  // namespace vernier::corrected_test
