// SPDX-License-Identifier: GPL-3.0-or-later
// Gain and zero of an output from measured points: the published chain of 8 bits to the digit, uncertainties
// that cover, refusals, and the stepping itself.
#include "firmware/daemon/settings/calibration.h"

#include <gtest/gtest.h>
#include <unistd.h>

#include <cmath>
#include <fstream>
#include <random>
#include <sstream>

#include "firmware/daemon/calibrate_output.h"
#include "firmware/daemon/settings/board_file.h"
#include "hal/sim/sim_clock.h"

namespace vernier::calibration_test {
namespace {

// 255 codes are 250 um about code 127: 0..10 V, 25 um/V.
constexpr std::int64_t kCodes = 255, kZero = 127;
constexpr double kUmPerCode = 250.0 / 255;

std::vector<CalibrationPoint> chain(int steps, double noise_um, unsigned seed) {
  std::mt19937_64 random(seed);
  std::normal_distribution<double> noise(0, 1);
  std::vector<CalibrationPoint> points;
  for (int i = 0; i < steps; ++i) {
    const std::int64_t code = 254 * i / (steps - 1);
    points.push_back({code, static_cast<double>(code - kZero) * kUmPerCode + noise_um * noise(random)});
  }
  return points;
}

TEST(Calibration, GivesThePublishedChainBack) {
  const Calibration found = fit_calibration(chain(11, 0, 1), kCodes, false);
  EXPECT_NEAR(found.span, 0.25, 1e-12);
  EXPECT_NEAR(found.zero, 127, 1e-9);
  EXPECT_FALSE(found.inverted);
  EXPECT_LT(found.residual, 1e-9);
  EXPECT_EQ(found.points, 11u);
}

TEST(Calibration, FallingValuesAreAnInvertedOutput) {
  auto points = chain(11, 0, 1);
  for (CalibrationPoint& point : points) point.measured = -point.measured;
  const Calibration found = fit_calibration(points, kCodes, false);
  EXPECT_TRUE(found.inverted);
  EXPECT_NEAR(found.span, 0.25, 1e-12);
  EXPECT_NEAR(found.zero, 127, 1e-9);
}

TEST(Calibration, ArcsecondsOfARotaryAxisAreDegrees) {
  const Calibration found = fit_calibration({{0, -36}, {100, 0}, {200, 36}}, 200, true);
  EXPECT_NEAR(found.span, 0.02, 1e-15);
  EXPECT_NEAR(found.zero, 100, 1e-12);
}

TEST(Calibration, UncertaintiesCoverTheTruth) {
  constexpr int kRuns = 2000;
  RecordProperty("seed", 1);
  int span_within = 0, zero_within = 0;
  for (int run = 0; run < kRuns; ++run) {
    const Calibration found = fit_calibration(chain(21, 0.5, static_cast<unsigned>(run + 1)), kCodes, false);
    span_within += std::fabs(found.span - 0.25) < 2 * found.span_std ? 1 : 0;
    zero_within += std::fabs(found.zero - 127) < 2 * found.zero_std ? 1 : 0;
  }
  // Student's t with 19 degrees of freedom is within 2 in 94.0 %; 2000 runs scatter by 0.53 % (3 sigma: 1.6).
  EXPECT_NEAR(span_within, 0.940 * kRuns, 0.016 * kRuns);
  EXPECT_NEAR(zero_within, 0.940 * kRuns, 0.016 * kRuns);
}

TEST(Calibration, RefusesWhatIsNoLine) {
  EXPECT_THROW(fit_calibration({{0, 0}, {1, 1}}, kCodes, false), BoardError);
  EXPECT_THROW(fit_calibration({{5, 0}, {5, 1}, {5, 2}}, kCodes, false), BoardError);
  EXPECT_THROW(fit_calibration({{0, 1}, {10, -1}, {20, 1}, {30, -1}}, kCodes, false), BoardError)
      << "an output that is not wired";
  EXPECT_THROW(fit_calibration({{0, 3}, {10, 3}, {20, 3}}, kCodes, false), BoardError);
}

class CalibrationFile : public testing::Test {
 protected:
  std::string path_ = testing::TempDir() + "calibration_" + std::to_string(getpid());
  void put(const std::string& text) const { std::ofstream(path_) << text; }
  std::string get() const {
    std::ifstream file(path_);
    return {std::istreambuf_iterator<char>(file), {}};
  }
  std::string refusal() const {
    try {
      read_calibration_points(path_, false);
    } catch (const BoardError& error) {
      return error.what.substr(path_.size());
    }
    return "taken";
  }
  ~CalibrationFile() override { ::unlink(path_.c_str()); }
};

TEST_F(CalibrationFile, PointsAreReadOrRefusedWithTheirLine) {
  put("# by a lever gauge\ncode,measured[um]\r\n0,-124.5\n254,124.51\n");
  const auto points = read_calibration_points(path_, false);
  ASSERT_EQ(points.size(), 2u);
  EXPECT_EQ(points[1].code, 254);
  EXPECT_EQ(points[1].measured, 124.51);
  put("code,measured[mm]\n0,1\n");
  EXPECT_EQ(refusal(), ":1: the header must be code,measured[um]");
  put("code,measured[um]\n0,1\n1.5,2\n");
  EXPECT_EQ(refusal(), ":3: no code: 1.5,2");
  put("code,measured[um]\n0,1 um\n");
  EXPECT_EQ(refusal(), ":2: no measured value: 0,1 um");
  put("code,measured[um]\n0,nan\n");
  EXPECT_EQ(refusal(), ":2: no measured value: 0,nan");
  put("");
  EXPECT_EQ(refusal(), ": the header code,measured[um] is missing");
}

TEST_F(CalibrationFile, IsReplacedAsAWhole) {
  put("old\n");
  write_calibration(path_, fit_calibration(chain(11, 0, 1), kCodes, false), "X");
  EXPECT_NE(get().find("\nspan = 0.25  # "), std::string::npos) << get();
  EXPECT_NE(get().find("\nzero = 127  # 127.000 "), std::string::npos) << get();
  EXPECT_NE(get().find("\npolarity = \"normal\"\n"), std::string::npos) << get();
  EXPECT_THROW(write_calibration(path_ + "/x", Calibration{}, "X"), BoardError);
}

TEST_F(CalibrationFile, MayBeALink) {
  const std::string link = path_ + ".link";
  ASSERT_EQ(::symlink(path_.c_str(), link.c_str()), 0);
  write_calibration(link, fit_calibration(chain(11, 0, 1), kCodes, false), "X");
  EXPECT_EQ(::unlink(link.c_str()), 0);
  EXPECT_NE(get().find("\nspan = 0.25  # "), std::string::npos) << get();
}

/// A converter, and the axis behind it with another gain and zero than the board thinks.
struct Axis : CorrectionWriter {
  explicit Axis(const AnalogueScale& s) : scale(s) {}
  HalFault write_correction(std::uint32_t, AxisTravel correction) noexcept override {
    if (broken) return HalFault::kRefused;
    const std::int64_t next = scale.code_for(correction);
    worst = std::max(worst, std::abs(next - code));
    code = next;
    return HalFault::kNone;
  }
  AnalogueScale scale;
  std::int64_t code = 200, worst = 0;
  bool broken = false;
};

constexpr AnalogueScale kScale{.span = 4 * 4095, .codes = 4095, .zero = 2000, .low = 95, .high = 4095};

TEST(CalibrateOutput, StepsUpAndDownAndEndsAtItsZero) {
  Axis axis(kScale);
  SimClock clock;
  std::atomic<bool> stop{false};
  std::istringstream answers("1\n2\nwhat\n3\n2.5\n1.5\n");
  std::ostringstream questions;
  const auto points = calibrate_output(axis, kScale, 200, 3, clock, answers, questions, stop);
  ASSERT_EQ(points.size(), 5u);
  const std::int64_t codes[] = {95, 2095, 4095, 2095, 95};
  const double values[] = {1, 2, 3, 2.5, 1.5};
  for (int i = 0; i < 5; ++i) {
    EXPECT_EQ(points[static_cast<std::size_t>(i)].code, codes[i]);
    EXPECT_EQ(points[static_cast<std::size_t>(i)].measured, values[i]);
  }
  EXPECT_EQ(axis.code, 2000);
  EXPECT_LE(axis.worst, 9) << "4000 codes in 5 s, every 10 ms";
  EXPECT_NE(questions.str().find("a number, or q"), std::string::npos);
}

TEST(CalibrateOutput, EndedEarlyItGoesBackToItsZero) {
  for (const char* typed : {"1\n2\nq\n", "1\n2\n"}) {
    Axis axis(kScale);
    SimClock clock;
    std::atomic<bool> stop{false};
    std::istringstream answers(typed);
    std::ostringstream questions;
    EXPECT_EQ(calibrate_output(axis, kScale, 200, 3, clock, answers, questions, stop).size(), 2u);
    EXPECT_EQ(axis.code, 2000);
  }
}

TEST(CalibrateOutput, RefusedWriteIsTold) {
  Axis axis(kScale);
  axis.broken = true;
  SimClock clock;
  std::atomic<bool> stop{false};
  std::istringstream answers("1\n");
  std::ostringstream questions;
  EXPECT_THROW(calibrate_output(axis, kScale, 200, 3, clock, answers, questions, stop), BoardError);
}

}  // namespace
}  // namespace vernier::calibration_test
