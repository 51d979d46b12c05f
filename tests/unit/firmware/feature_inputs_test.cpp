// SPDX-License-Identifier: GPL-3.0-or-later
// Features of an accelerometer at the board: against the definitions in double, and in the tick.
#include "firmware/core/cycle/feature_inputs.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <complex>
#include <iterator>
#include <vector>

#include "firmware/core/service.h"
#include "hal/sim/plant.h"
#include "hal/sim/roaming.h"
#include "hal/sim/sim_clock.h"
#include "tests/unit/firmware/small_machine.h"
#include "tools/model/machine_reader.h"
#include "tools/vibration/signal_features.h"

namespace vernier::feature_inputs_test {

using namespace vernier::compile;
using namespace vernier::model;
using namespace vernier::vibration;
namespace {

constexpr double kPi = 3.14159265358979323846;

/// Inputs whose values a test sets; says how often each was read.
class SetInputs : public InputReader {
 public:
  HalFault read_input(std::uint32_t input, InputMicro& value) noexcept override {
    ++reads[input];
    if (silent[input]) return HalFault::kNoReading;
    value = values[input];
    return HalFault::kNone;
  }
  InputMicro values[kMaxInputs];
  bool silent[kMaxInputs] = {};
  int reads[kMaxInputs] = {};
};

std::vector<FeatureRequest> all_features(std::uint32_t first, std::uint32_t window, std::int64_t lsb) {
  std::vector<FeatureRequest> requests;
  for (unsigned i = 0; i < kFeatures; ++i)
    requests.push_back({.input = first + i,
                        .of = 0,
                        .feature = static_cast<Feature>(i),
                        .window = window,
                        .lsb = InputMicro(lsb)});
  return requests;
}

TEST(FeatureInputs, HaveTheNamesOfTheFeaturesCommand) {
  for (std::size_t i = 0; i < kFeatureNames.size(); ++i) {
    Feature feature{};
    ASSERT_TRUE(feature_of(kFeatureNames[i], feature)) << kFeatureNames[i];
    EXPECT_EQ(static_cast<std::size_t>(feature), i);
  }
  Feature feature{};
  EXPECT_FALSE(feature_of("rms", feature));
}

// GIVEN a sine of 0.31 g at 41.3 Hz on 0.02 g, seen through a board at 1 kHz with 10 ug
// THEN each feature is the one of the samples in double, to half a millionth and the rounding of FREQUENCY.
TEST(FeatureInputs, AgreeWithTheDefinitionsInDouble) {
  constexpr std::uint32_t kWindow = 800;
  constexpr std::int64_t kLsb = 10;
  SetInputs source;
  const auto requests = all_features(1, kWindow, kLsb);
  FeatureInputs inputs(source, 1 + kFeatures, requests, TimeUs(1000));
  ASSERT_EQ(inputs.refused(), kNoInput);
  EXPECT_EQ(inputs.windows(), 1u) << "one signal, one window";
  Fourier fourier(kWindow);
  std::vector<double> samples;
  for (int tick = 0; tick < 3000; ++tick) {
    const double g = 0.02 + 0.31 * std::sin(2 * kPi * 41.3e-3 * tick + 0.4);
    source.values[0] = InputMicro(std::llround(1e6 * g));
    inputs.begin_tick();
    samples.push_back(1e-6 * kLsb *
                      std::round(static_cast<double>(source.values[0].count) / static_cast<double>(kLsb)));
    InputMicro value;
    if (tick + 1 < static_cast<int>(kWindow)) {
      ASSERT_EQ(inputs.read_input(3, value), HalFault::kNoReading) << "not full in tick " << tick;
      continue;
    }
    if (tick % 17 != 0) continue;
    const SignalFeatures exact = signal_features(std::span(samples).last(kWindow), 1000, fourier);
    for (unsigned i = 0; i < kFeatures; ++i) {
      ASSERT_EQ(inputs.read_input(1 + i, value), HalFault::kNone);
      const bool frequency = i == static_cast<unsigned>(Feature::kFrequency);
      // 1e-9 relative for the double's own sums; 1000 Hz * 800 * 2^-36 of 1e-6 Hz for the rounded weights.
      const double bound = 0.501 + 1e-9 * std::abs(exact[i] * 1e6) + (frequency ? 1e9 * 800 * 0x1p-36 : 0);
      EXPECT_NEAR(static_cast<double>(value.count), 1e6 * exact[i], bound) << kFeatureNames[i];
    }
  }
  // What a sine must have, whatever computes it: RMS of the tone and its mean value, kurtosis 1.5.
  InputMicro rms, kurtosis;
  ASSERT_EQ(inputs.read_input(1 + static_cast<unsigned>(Feature::kRms), rms), HalFault::kNone);
  ASSERT_EQ(inputs.read_input(1 + static_cast<unsigned>(Feature::kKurtosis), kurtosis), HalFault::kNone);
  EXPECT_NEAR(static_cast<double>(rms.count) * 1e-6, std::hypot(0.31 / std::sqrt(2), 0.02), 1e-4);
  EXPECT_NEAR(static_cast<double>(kurtosis.count) * 1e-6, 1.5, 0.01);
  EXPECT_EQ(source.reads[0], 3000) << "once a tick";
  EXPECT_EQ(inputs.held(), 0u);
}

TEST(FeatureInputs, RoundEachSampleToTheNearestResolution) {
  for (const std::int64_t lsb : {1, 2, 3, 7, 10, 999'999, 1 << 30}) {
    SetInputs source;
    FeatureInputs inputs(
        source, 2, {{.input = 1, .of = 0, .feature = Feature::kPeak, .window = 6, .lsb = InputMicro(lsb)}},
        TimeUs(1000));
    ASSERT_EQ(inputs.refused(), kNoInput);
    const std::int64_t most = FeatureWindow::kLimit * lsb;
    for (const std::int64_t value :
         {std::int64_t{0}, lsb / 2, lsb / 2 + 1, (lsb - 1) / 2, lsb, 3 * lsb / 2, 5 * lsb + lsb / 2 - 1, most,
          most - lsb / 2, most - (lsb - 1) / 2, most / 3})
      for (const std::int64_t sign : {-1, 1}) {
        source.values[0] = InputMicro(sign * value);
        for (int i = 0; i < 6; ++i) inputs.begin_tick();
        InputMicro peak;
        ASSERT_EQ(inputs.read_input(1, peak), HalFault::kNone);
        const std::int64_t nearest = sign * ((value + lsb / 2) / lsb) * lsb;
        EXPECT_EQ(peak.count, nearest) << "lsb " << lsb << " value " << sign * value;
      }
    EXPECT_EQ(inputs.held(), 0u);
    source.values[0] = InputMicro(INT64_MIN);
    inputs.begin_tick();
    EXPECT_EQ(inputs.held(), 1u);
  }
}

TEST(FeatureInputs, TakeOneSignalOffAnother) {
  SetInputs source;
  FeatureInputs inputs(source, 3, {{.input = 2, .of = 0, .minus = 1, .feature = Feature::kMav, .window = 8}},
                       TimeUs(1000));
  for (int tick = 0; tick < 8; ++tick) {
    source.values[0] = InputMicro(700'000 + (tick % 2 == 0 ? 100'000 : -100'000));
    source.values[1] = InputMicro(700'000);
    inputs.begin_tick();
  }
  InputMicro mav;
  ASSERT_EQ(inputs.read_input(2, mav), HalFault::kNone);
  EXPECT_EQ(mav.count, 100'000);
}

TEST(FeatureInputs, ASilentSubtractedSignalIsAMissingSample) {
  SetInputs source;
  const FeatureRequest request{
      .input = 2, .of = 0, .minus = 1, .feature = Feature::kMav, .window = 8, .bridged = 0};
  FeatureInputs inputs(source, 3, {request}, TimeUs(1000));
  for (int tick = 0; tick < 8; ++tick) inputs.begin_tick();
  InputMicro mav;
  ASSERT_EQ(inputs.read_input(2, mav), HalFault::kNone);
  source.silent[1] = true;
  inputs.begin_tick();
  EXPECT_EQ(inputs.read_input(2, mav), HalFault::kNoReading);
}

TEST(FeatureInputs, AnInputWithoutAFeaturePassesAndAFaultLeavesItsValue) {
  SetInputs source;
  FeatureInputs inputs(source, 2, {{.input = 1, .of = 0, .feature = Feature::kRms, .window = 20}},
                       TimeUs(1000));
  source.values[0] = InputMicro(50'000);
  inputs.begin_tick();
  InputMicro value(1);
  EXPECT_EQ(inputs.read_input(0, value), HalFault::kNone);
  EXPECT_EQ(value.count, 50'000);
  source.silent[0] = true;
  inputs.begin_tick();
  value = InputMicro(1);
  EXPECT_EQ(inputs.read_input(0, value), HalFault::kNoReading);
  EXPECT_EQ(value.count, 1);
}

TEST(FeatureInputs, SampleEverySoManyTicks) {
  SetInputs source;
  FeatureInputs inputs(source, 2,
                       {{.input = 1, .of = 0, .feature = Feature::kFrequency, .window = 40, .every = 10}},
                       TimeUs(1000));
  InputMicro frequency;
  for (int tick = 0; tick < 391; ++tick) {
    EXPECT_EQ(inputs.read_input(1, frequency), HalFault::kNoReading) << tick;
    source.values[0] = InputMicro(std::llround(1e6 * std::sin(2 * kPi * 0.025 * tick)));  // 25 Hz of 100
    inputs.begin_tick();
  }
  ASSERT_EQ(inputs.read_input(1, frequency), HalFault::kNone);
  EXPECT_NEAR(static_cast<double>(frequency.count), 25e6, 100);
}

TEST(FeatureInputs, BridgeAFewMissingSamplesAndStartAgainAfterMore) {
  SetInputs source;
  const FeatureRequest request{.input = 1, .of = 0, .feature = Feature::kRms, .window = 20, .bridged = 3};
  FeatureInputs inputs(source, 2, {request}, TimeUs(1000));
  source.values[0] = InputMicro(50'000);
  InputMicro value;
  const auto answers = [&](int ticks) {
    int count = 0;
    for (int i = 0; i < ticks; ++i) {
      inputs.begin_tick();
      if (inputs.read_input(1, value) == HalFault::kNone) ++count;
    }
    return count;
  };
  EXPECT_EQ(answers(30), 11);
  source.silent[0] = true;
  EXPECT_EQ(answers(3), 3) << "bridged";
  EXPECT_EQ(value.count, 50'000);
  EXPECT_EQ(inputs.read_input(0, value), HalFault::kNoReading) << "the signal itself is not";
  EXPECT_EQ(answers(1), 0);
  source.silent[0] = false;
  EXPECT_EQ(answers(19), 0) << "the window has a gap";
  EXPECT_EQ(answers(1), 1);
}

// Before the first sample no value can replace a missing one.
TEST(FeatureInputs, SignalThatIsSilentAtFirstFillsItsWindowWithSamplesOnly) {
  SetInputs source;
  const FeatureRequest request{.input = 1, .of = 0, .feature = Feature::kRms, .window = 20, .bridged = 3};
  FeatureInputs inputs(source, 2, {request}, TimeUs(1000));
  InputMicro value;
  source.silent[0] = true;
  for (int i = 0; i < 3; ++i) inputs.begin_tick();
  source.silent[0] = false;
  source.values[0] = InputMicro(50'000);
  for (int i = 0; i < 19; ++i) {
    inputs.begin_tick();
    EXPECT_EQ(inputs.read_input(1, value), HalFault::kNoReading) << i;
  }
  inputs.begin_tick();
  ASSERT_EQ(inputs.read_input(1, value), HalFault::kNone);
  EXPECT_EQ(value.count, 50'000);
}

TEST(FeatureInputs, AreSilentWhereUndefined) {
  SetInputs source;
  FeatureInputs inputs(source, 3,
                       {{.input = 1, .of = 0, .feature = Feature::kRms, .window = 6},
                        {.input = 2, .of = 0, .feature = Feature::kKurtosis, .window = 6}},
                       TimeUs(1000));
  for (int i = 0; i < 6; ++i) inputs.begin_tick();
  InputMicro value(7);
  EXPECT_EQ(inputs.read_input(1, value), HalFault::kNone);
  EXPECT_EQ(value.count, 0);
  EXPECT_EQ(inputs.read_input(2, value), HalFault::kNoReading) << "a constant has no kurtosis";
  EXPECT_EQ(inputs.read_input(3, value), HalFault::kNoDevice);
}

TEST(FeatureInputs, RefuseWhatCannotBeServed) {
  SetInputs source;
  const FeatureRequest good{.input = 1, .of = 0};
  const auto refused = [&](FeatureRequest bad) {
    return FeatureInputs(source, 3, {good, bad}, TimeUs(1000)).refused() == 1;
  };
  EXPECT_FALSE(refused({.input = 2, .of = 0}));
  EXPECT_TRUE(refused({.input = 2, .of = 1})) << "of a feature";
  EXPECT_TRUE(refused({.input = 2, .of = 2})) << "of itself";
  EXPECT_TRUE(refused({.input = 3, .of = 0})) << "beyond the board";
  EXPECT_TRUE(refused({.input = 2, .of = 0, .minus = 1}));
  EXPECT_TRUE(refused({.input = 2, .of = 0, .window = 801}));
  EXPECT_TRUE(refused({.input = 2, .of = 0, .window = 2050}));
  EXPECT_TRUE(refused({.input = 2, .of = 0, .every = 0}));
  EXPECT_TRUE(refused({.input = 2, .of = 0, .lsb = InputMicro(0)}));
  EXPECT_FALSE(refused({.input = 2, .of = 0, .lsb = InputMicro(std::int64_t{1} << 30)}));
  EXPECT_TRUE(refused({.input = 2, .of = 0, .lsb = InputMicro((std::int64_t{1} << 30) + 1)}));
  EXPECT_TRUE(refused({.input = 2, .of = 3})) << "of an input beyond the board";
  EXPECT_EQ(FeatureInputs(source, 3, {good}, TimeUs(0)).refused(), 0u) << "no tick";
  EXPECT_EQ(FeatureInputs(source, 3, {good}, TimeUs(1)).refused(), kNoInput) << "the shortest tick";
  // A displacement has a scale of its own; its samples are multiples of lsb as well.
  const auto displacement = [&](std::int64_t lsb) {
    return refused({.input = 2, .of = 0, .lsb = InputMicro(lsb), .corner_mHz = 500, .lsb_nm_s2 = 98'000});
  };
  EXPECT_FALSE(displacement(std::int64_t{1} << 30));
  EXPECT_TRUE(displacement((std::int64_t{1} << 30) + 1));
  EXPECT_TRUE(displacement(0));
  // The first request that cannot be served is named.
  EXPECT_EQ(FeatureInputs(source, 3, {{.input = 1, .of = 1}, {.input = 2, .of = 2}}, TimeUs(1000)).refused(),
            0u);
}

// Each value of a request that changes the samples or the window is another window.
TEST(FeatureInputs, OnlyFeaturesOfOneSignalShareAWindow) {
  SetInputs source;
  const FeatureRequest one{.input = 1, .of = 0, .window = 100};
  const auto windows = [&](FeatureRequest other) {
    const FeatureInputs inputs(source, 5, {one, other}, TimeUs(1000));
    EXPECT_EQ(inputs.refused(), kNoInput);
    return inputs.windows();
  };
  FeatureRequest same = one;
  same.input = 2, same.feature = Feature::kPeak;
  EXPECT_EQ(windows(same), 1u);
  const auto changed = [&](auto change) {
    FeatureRequest other = same;
    change(other);
    return windows(other);
  };
  EXPECT_EQ(changed([](FeatureRequest& r) { r.of = 3; }), 2u);
  EXPECT_EQ(changed([](FeatureRequest& r) { r.minus = 3; }), 2u);
  EXPECT_EQ(changed([](FeatureRequest& r) { r.window = 200; }), 2u);
  EXPECT_EQ(changed([](FeatureRequest& r) { r.every = 2; }), 2u);
  EXPECT_EQ(changed([](FeatureRequest& r) { r.lsb = InputMicro(20); }), 2u);
  EXPECT_EQ(changed([](FeatureRequest& r) { r.bridged = 4; }), 2u);
  EXPECT_EQ(changed([](FeatureRequest& r) { r.corner_mHz = 500; }), 2u);
  EXPECT_EQ(changed([](FeatureRequest& r) { r.lsb_nm_s2 = 1000; }), 2u);
}

TEST(FeatureInputs, NoMoreWindowsThanInputs) {
  SetInputs source;
  std::vector<FeatureRequest> requests;
  for (std::uint32_t i = 0; i <= kMaxInputs; ++i)
    requests.push_back({.input = 1, .of = 0, .window = 10 + 2 * i});
  EXPECT_EQ(FeatureInputs(source, 2, requests, TimeUs(1000)).refused(), kMaxInputs);
}

// GIVEN a simulated machine whose accelerometer swings with 0.05 g at ten tones at once, on 10 mg of bias
// THEN the board's input is its motion: 50 mm at 0.5 Hz to 0.3 um at 200 Hz.
TEST(FeatureInputs, DisplacementIsTheMotionOfASimulatedMachine) {
  constexpr double kTones_Hz[] = {0.5, 1, 2, 5, 10, 20, 50, 100, 150, 200}, kTone_g = 0.05, kCorner_Hz = 0.05;
  constexpr int kSettled = 60'000, kFirst = 80'000, kCount = 20'000;
  Roaming motion({{0, 600'000'000}}, {InputMicro(10'000), InputMicro(0)}, TimeUs(1000), 0.01, 1);
  for (const double tone : kTones_Hz) motion.vibrate(0, 1e6 * kTone_g, tone);
  SimPlant plant(motion, 1, 2);
  plant.release();
  FeatureInputs inputs(plant, 2, {{.input = 1, .of = 0, .corner_mHz = 50}}, TimeUs(1000));
  ASSERT_EQ(inputs.refused(), kNoInput);
  std::complex<double> sums[std::size(kTones_Hz)] = {};
  for (int tick = 1; tick < kFirst + kCount; ++tick) {
    plant.advance();
    inputs.begin_tick();
    InputMicro value;
    ASSERT_EQ(inputs.read_input(1, value), tick < kSettled ? HalFault::kNoReading : HalFault::kNone) << tick;
    if (tick < kFirst) continue;
    // Half a cosine to either side: what drifts by micrometres must not count as a tone of 0.3 um.
    const double weight = 1 - std::cos(2 * kPi * (tick - kFirst + 0.5) / kCount);
    const double t_s = 1e-3 * static_cast<double>(plant.tick());
    for (std::size_t i = 0; i < std::size(kTones_Hz); ++i)
      sums[i] +=
          weight * 1e-6 * static_cast<double>(value.count) * std::polar(1.0, -2 * kPi * kTones_Hz[i] * t_s);
  }
  EXPECT_EQ(inputs.held(), 0u);
  std::printf("the board's input at 1 kHz, corner %.2f Hz\n", kCorner_Hz);
  for (std::size_t i = 0; i < std::size(kTones_Hz); ++i) {
    const double tone = kTones_Hz[i], r = kCorner_Hz / tone;
    const double true_um = -kTone_g * 9806650 / std::pow(2 * kPi * tone, 2);
    const std::complex<double> got = sums[i] * std::complex<double>(0, 2) / double{kCount} / true_um;
    const double phase_deg = std::arg(got) * 180 / kPi;
    const double lead_deg = 2 * std::atan2(std::sqrt(2) * r, 1 - r * r) * 180 / kPi;
    std::printf("  %6.1f Hz  amplitude %+7.3f %%  phase %+7.3f deg (the corner alone %+.3f)\n", tone,
                100 * (std::abs(got) - 1), phase_deg, lead_deg);
    EXPECT_NEAR(std::abs(got), 1 / (1 + std::pow(r, 4)), 0.003) << tone;  // the filter's own at 1 kHz
    EXPECT_NEAR(phase_deg, lead_deg, 0.05) << tone;
  }
}

// The page of the filter: the gain is exact at 18 % of the rate of the samples. GIVEN 180 Hz at a tick of 1
// kHz, or 90 Hz at every second tick THEN the amplitude is that of the motion, without the 0.05 % that a part
// of a hundred in this frequency makes.
TEST(FeatureInputs, DisplacementIsExactAtEighteenHundredthsOfItsRate) {
  for (const std::uint32_t every : {1u, 2u}) {
    constexpr double kPeak_m_s2 = 10;
    const double rate_Hz = 1000.0 / every, tone_Hz = 0.18 * rate_Hz, omega = 2 * kPi * tone_Hz;
    SetInputs source;
    FeatureInputs inputs(source, 2,
                         {{.input = 1,
                           .of = 0,
                           .every = every,
                           .lsb = InputMicro(20),
                           .corner_mHz = 500,
                           .lsb_nm_s2 = 20'000}},
                         TimeUs(1000));
    ASSERT_EQ(inputs.refused(), kNoInput);
    std::complex<double> sum;
    constexpr int kSettled = 20'000, kSamples = 10'000;
    for (int k = 0; k < kSettled + kSamples; ++k) {
      source.values[0] = InputMicro(std::llround(1e6 * kPeak_m_s2 * std::cos(omega * k / rate_Hz)));
      for (std::uint32_t tick = 0; tick < every; ++tick) inputs.begin_tick();
      InputMicro value;
      if (k < kSettled) continue;
      ASSERT_EQ(inputs.read_input(1, value), HalFault::kNone);
      sum += 1e-6 * static_cast<double>(value.count) * std::polar(2.0 / kSamples, -omega * k / rate_Hz);
    }
    const double true_um = 1e6 * kPeak_m_s2 / (omega * omega);
    EXPECT_NEAR(std::abs(sum) / true_um, 1, 1e-4) << tone_Hz;
  }
}

TEST(FeatureInputs, DisplacementStartsFromRestAfterAGap) {
  SetInputs source;
  const FeatureRequest request{.input = 1, .of = 0, .bridged = 3, .corner_mHz = 5000};
  FeatureInputs inputs(source, 2, {request}, TimeUs(1000));
  ASSERT_EQ(inputs.refused(), kNoInput);
  InputMicro value;
  std::vector<std::int64_t> first, second;
  const auto fill = [&](int ticks, std::vector<std::int64_t>& values) {
    for (int tick = 0; tick < ticks; ++tick) {
      source.values[0] = InputMicro(std::llround(1e5 * std::sin(0.2 * tick)));
      inputs.begin_tick();
      if (inputs.read_input(1, value) == HalFault::kNone) values.push_back(value.count);
    }
  };
  fill(1000, first);
  ASSERT_EQ(first.size(), 401u) << "three periods of 5 Hz are 600 samples";
  source.silent[0] = true;
  for (int tick = 0; tick < 3; ++tick) {
    inputs.begin_tick();
    EXPECT_EQ(inputs.read_input(1, value), HalFault::kNone) << "bridged";
  }
  inputs.begin_tick();
  EXPECT_EQ(inputs.read_input(1, value), HalFault::kNoReading);
  source.silent[0] = false;
  fill(1000, second);
  EXPECT_EQ(first, second);
  source.values[0] = InputMicro(INT64_MAX);
  inputs.begin_tick();
  EXPECT_EQ(inputs.held(), 1u) << "of the sample";
  // The filter starts again after a gap, but the counter never goes back.
  source.silent[0] = true;
  for (int tick = 0; tick < 4; ++tick) inputs.begin_tick();
  const std::uint64_t before = inputs.held();
  EXPECT_EQ(before, 1u + 3u) << "three samples were bridged with the limited one";
  source.silent[0] = false, source.values[0] = InputMicro(0);
  inputs.begin_tick();
  EXPECT_EQ(inputs.held(), before);
  source.values[0] = InputMicro(INT64_MIN);
  inputs.begin_tick();
  EXPECT_EQ(inputs.held(), before + 1);
}

// Each signal counts up to 2^60, before one is subtracted from the other.
TEST(FeatureInputs, SignalsAreLimitedBeforeTheirDifference) {
  constexpr std::int64_t kMost = std::int64_t{1} << 60;
  struct {
    std::int64_t of, minus, peak;
  } const cases[] = {{kMost, kMost - 5000, 5000},   {kMost + 5000, kMost, 0},   {kMost, kMost + 5000, 0},
                     {-kMost, 5000 - kMost, -5000}, {-kMost - 5000, -kMost, 0}, {-kMost, -kMost - 5000, 0}};
  for (const auto& wanted : cases) {
    SetInputs source;
    FeatureInputs inputs(
        source, 3, {{.input = 2, .of = 0, .minus = 1, .feature = Feature::kPeak, .window = 6}}, TimeUs(1000));
    source.values[0] = InputMicro(wanted.of), source.values[1] = InputMicro(wanted.minus);
    for (int i = 0; i < 6; ++i) inputs.begin_tick();
    InputMicro peak;
    ASSERT_EQ(inputs.read_input(2, peak), HalFault::kNone);
    EXPECT_EQ(peak.count, wanted.peak) << wanted.of << " " << wanted.minus;
  }
}

// A displacement is valid after three periods of its corner, rounded up to a sample.
TEST(FeatureInputs, DisplacementIsReadyAfterThreePeriodsOfItsCorner) {
  struct {
    std::int64_t corner_mHz;
    int samples;
  } const cases[] = {{15'000, 200}, {15'001, 200}, {14'999, 201}, {1000, 3000}};
  for (const auto& wanted : cases) {
    SetInputs source;
    FeatureInputs inputs(source, 2,
                         {{.input = 1, .of = 0, .corner_mHz = wanted.corner_mHz, .lsb_nm_s2 = 98'000}},
                         TimeUs(1000));
    ASSERT_EQ(inputs.refused(), kNoInput);
    InputMicro value;
    int samples = 0;
    for (; inputs.read_input(1, value) == HalFault::kNoReading && samples < 5000; ++samples)
      inputs.begin_tick();
    EXPECT_EQ(samples, wanted.samples) << wanted.corner_mHz;
  }
}

TEST(FeatureInputs, RefuseADisplacementThatItsFilterCannotKeep) {
  SetInputs source;
  const auto refused = [&](FeatureRequest bad) {
    return FeatureInputs(source, 3, {bad}, TimeUs(1000)).refused() == 0;
  };
  EXPECT_FALSE(refused({.input = 2, .of = 0, .corner_mHz = 15'625}));
  EXPECT_TRUE(refused({.input = 2, .of = 0, .corner_mHz = 15'626})) << "rate / 64";
  EXPECT_FALSE(refused({.input = 2, .of = 0, .corner_mHz = 8}));
  EXPECT_TRUE(refused({.input = 2, .of = 0, .corner_mHz = 7})) << "rate / 2^17";
  EXPECT_TRUE(refused({.input = 2, .of = 0, .every = 10, .corner_mHz = 1'563})) << "of the samples";
  EXPECT_TRUE(refused({.input = 2, .of = 0, .corner_mHz = -1}));
  EXPECT_TRUE(refused({.input = 2, .of = 0, .corner_mHz = 500, .lsb_nm_s2 = 0}));
  EXPECT_TRUE(refused({.input = 2, .of = 2, .corner_mHz = 500})) << "of itself";
}

// A learned term: 1 mm per g of the accelerometer's RMS in X, within 0.05..0.5 g and faded out beyond.
constexpr const char* kLearnedMachine = R"xml(<machine name="learned">
  <variables>
    <static>
      <k value="0.1" nominal="0" unit="mm/g"/>
      <low value="0.05" unit="g" Hide="true"/>
      <high value="0.3" unit="g" Hide="true"/>
      <fade value="0.1" unit="g" Hide="true"/>
    </static>
    <machineaxes>
      <X rotary="false" min="0" max="600" maxcorrection="0.125" maxslew="5"/>
    </machineaxes>
    <inputs><own_RMS unit="g" reference="0" min="0" max="1"/></inputs>
  </variables>
  <transforms branch="tool">
    <sixdof n="1" X="X+max(0,1-max(0,max(low-own_RMS,own_RMS-high))/fade)*k*own_RMS" Y="0" Z="0" rX="0" rY="0" rZ="0"/>
  </transforms>
</machine>)xml";

/// The learned machine on a board with an accelerometer of a given amplitude, g.
class LearnedBoard {
 public:
  explicit LearnedBoard(double amplitude_g)
      : machine_(parse_machine(kLearnedMachine, "learned.xml")),
        image_(load_image(compile_machine(machine_, kLearnedMachine, {}).image, machine_)),
        motion_({{0, 600'000'000}}, {InputMicro(0), InputMicro(0)}, TimeUs(1000), 0.01, 1),
        plant_(motion_, 1, 2),
        features_(plant_, 2, {{.input = 1, .of = 0, .feature = Feature::kRms, .window = 800}}, TimeUs(1000)),
        cycle_({{{"X"}}, {"acc_x", "own_RMS"}}, TimeUs(1000), Board{clock_, plant_, features_, plant_}),
        bound_(image_->view) {
    motion_.vibrate(0, amplitude_g * 1e6, 50);
    Name offender;
    EXPECT_EQ(bind(image_->view, {{{"X"}}, {"acc_x", "own_RMS"}}, TimeUs(1000), bound_, offender),
              BindFault::kNone);
    EXPECT_EQ(bound_.input[0], 1u) << "found by its name";
    cycle_.use(bound_);
    plant_.release();
  }
  void run(int ticks) {
    for (int i = 0; i < ticks; ++i) {
      plant_.advance();
      const bool ready = cycle_.mode() == Mode::kReady && cycle_.weight() == WeightQ16{};
      cycle_.tick(TimeUs(1000 * plant_.tick()), ready ? Command::kActivate : Command::kNone);
    }
  }
  Cycle& cycle() { return cycle_; }
  double correction_um() const { return 1e-3 * static_cast<double>(plant_.written(0).count); }

 private:
  Machine machine_;
  std::unique_ptr<LoadedImage> image_;
  Roaming motion_;
  SimPlant plant_;
  SimClock clock_;
  FeatureInputs features_;
  Cycle cycle_;
  BoundProgram bound_;
};

TEST(FeatureInputs, ALearnedTermIsCorrectedAtTheBoard) {
  LearnedBoard board(0.25);
  board.run(700);
  EXPECT_EQ(board.cycle().mode(), Mode::kChecking) << "the window is not full yet";
  EXPECT_EQ(board.cycle().latched(), Fault::kNone);
  board.run(1500);
  ASSERT_EQ(board.cycle().mode(), Mode::kActive);
  // 800 ms are forty periods: RMS is amplitude over root 2. 10 ug of resolution are 1 nm, as is the equation.
  EXPECT_NEAR(board.correction_um(), -100 * 0.25 / std::sqrt(2), 0.002);
  ASSERT_EQ(board.cycle().program().share_names.size, 1u) << "one effect";
  Correction shares[kMaxShares];
  EquationState state;
  std::int32_t registers[kMaxRegisters];
  board.cycle().equation_state(state);
  const BoundProgram& program = board.cycle().program();
  ASSERT_TRUE(run_shares(program.shares, program.program, state, registers, shares));
  EXPECT_NEAR(1e-3 * shares[0].counts, board.correction_um(), 0.002) << "what watch shows of the effect";
}

TEST(FeatureInputs, ALearnedTermFadesBeyondItsDomainAtTheBoard) {
  const double rms = 0.5 / std::sqrt(2);  // 0.054 g above the domain: 46 % are left
  LearnedBoard half(0.5), outside(1.0);
  half.run(2500), outside.run(2500);
  ASSERT_EQ(half.cycle().mode(), Mode::kActive);
  ASSERT_EQ(outside.cycle().mode(), Mode::kActive);
  EXPECT_NEAR(half.correction_um(), -100 * rms * (1 - (rms - 0.3) / 0.1), 0.02);
  EXPECT_NEAR(outside.correction_um(), 0, 0.002);
}

}  // namespace
}  // namespace vernier::feature_inputs_test
