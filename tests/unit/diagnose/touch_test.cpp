// SPDX-License-Identifier: GPL-3.0-or-later
// Causes of errors that touches show: the bed of a printer, the sockets of a robot. No instrument measured.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <random>

#include "tools/diagnose/diagnosis.h"
#include "tools/model/chain/touching_axes.h"
#include "tools/model/machine_reader.h"
#include "tools/text/files.h"

namespace vernier::touch_diagnose_test {

using namespace vernier::diagnose;
using namespace vernier::model;
namespace {

constexpr std::uint64_t kSeed = 31;

const char* const kPrinter = R"(<machine name="printer"><variables>
  <machineaxes><X min="0" max="220"/><Y min="0" max="220"/><Z min="0" max="250"/></machineaxes>
  <artefact name="bed" type="plane"/></variables><transforms branch="tool">
  <sixdof n="1" Y="Y" Z="Z"/><sixdof n="2" X="X"/></transforms></machine>)";

/// Touches of a sloping bed at 25 points, four times; u: standard uncertainty, mm. error: added to the height
/// at which the nozzle touches.
std::string bed(double u_mm, const std::function<double(double x, double y)>& error_mm) {
  std::mt19937_64 random(kSeed);
  std::normal_distribution<double> noise(0, u_mm);
  std::string text = "X[mm],Y[mm],Z[mm],on,run,role,u[mm]\n";
  for (int run = 0; run < 4; ++run)
    for (int y = 10; y <= 210; y += 50)
      for (int x = 10; x <= 210; x += 50)
        text += fmt::format("{},{},{:.5f},bed,r{},{},{}\n", x, y,
                            0.3 - 0.0015 * x + 0.0008 * y + error_mm(x, y) + noise(random), run,
                            run == 3 ? "check" : "fit", u_mm);
  return text;
}

Diagnosis diagnosed(const std::string& machine, const std::string& rows) {
  static const DiagnoseOptions options;  // answers point into its effects
  const Machine given = parse_machine(machine, "m.xml");
  return diagnose::diagnose(machine, given, parse_measurement(rows, "m.csv", given), options);
}

TEST(TouchDiagnosis, ABedThatSlopesIsNoErrorOfThePrinter) {
  for (const double u_mm : {0.01, 0.001}) {
    const Diagnosis answer = diagnosed(kPrinter, bed(u_mm, [](double, double) { return 0; }));
    EXPECT_EQ(answer.verdict, Verdict::kConsistent) << answer.explanation;
  }
}

TEST(TouchDiagnosis, TheSagOfABeamIsNamed) {
  for (const double u_mm : {0.01, 0.001}) {
    const Diagnosis answer = diagnosed(
        kPrinter, bed(u_mm, [](double x, double) { return 0.1 * (1 - std::pow((x - 110) / 110, 2)); }));
    EXPECT_EQ(answer.verdict, Verdict::kMissingEffect) << answer.explanation;
    ASSERT_GE(answer.ladder.size(), 2U);
    EXPECT_EQ(answer.ladder[1].said, "X carriage: straightness along Z");
    ASSERT_TRUE(answer.ladder.back().check_rms_um);
    EXPECT_LT(*answer.ladder.back().check_rms_um, 1200 * u_mm);
  }
}

TEST(TouchDiagnosis, SocketsOfARobotWithoutAHiddenEffectAreConsistent) {
  const std::string folder = VERNIER_SOURCE_DIR;
  const Diagnosis answer = diagnosed(text::read_file(folder + "/tables/machines/ur10e.xml"),
                                     text::read_file(folder + "/tests/data/touch/sockets.csv"));
  EXPECT_EQ(answer.verdict, Verdict::kConsistent) << answer.explanation;
}

TEST(TouchingAxes, AreThoseThatMovedUntilTheToolTouched) {
  const Machine printer = parse_machine(kPrinter, "m.xml");
  const auto axes_of = [&](const std::string& text, double error_mm) {
    const Measurement m = parse_measurement(text, "m.csv", printer);
    std::vector<std::size_t> rows(m.rows());
    for (std::size_t row = 0; row < rows.size(); ++row) rows[row] = row;
    return touching_axes(printer, m, rows, error_mm);
  };
  const std::set<std::size_t> z = {2};
  EXPECT_EQ(axes_of(bed(0.01, [](double, double) { return 0; }), 0.01), z);
  EXPECT_EQ(axes_of(bed(0.0001, [](double, double) { return 0; }), 0.0001),
            z);  // travel 4000 times the error
  EXPECT_TRUE(axes_of("X[mm],Y[mm],Z[mm],x[mm]\n0,0,0,0\n1,2,3,1\n", 1).empty()) << "no touches";
}

}  // namespace
}  // namespace vernier::touch_diagnose_test
