// SPDX-License-Identifier: GPL-3.0-or-later
#include <gtest/gtest.h>

#include <cstdio>

#include "tests/unit/timebase/circle_record.h"
#include "tools/timebase/time_base.h"

namespace vernier::time_base_false_alarm_test {

using namespace vernier::model;
using namespace vernier::timebase;
namespace {

using test::circle_record;
using test::CircleRun;
using test::kPi;
using test::RadialError;
using test::repeating_error;

constexpr std::uint64_t kSeed = 20240607;

// Two turns in each sense with a right time base: everything that could be compared is.
std::vector<CircleRun> good_runs() {
  return {{"CCW", +1, 2, 700, 700, 0, 0, {}}, {"CW", -1, 2, 640, 640, 360, 360, {}}};
}

// One turn in each sense at two feeds: compared with one another.
std::vector<CircleRun> single_turns() {
  return {{"CCW", +1, 1, 700, 700, 0, 0, {}}, {"CW", -1, 1, 640, 640, 360, 360, {}}};
}

using Noise = std::function<double()>;

Noise white(std::mt19937_64& random, double um) {
  return [&random, um] { return std::normal_distribution<double>(0, um)(random); };
}

// First-order autoregression with a memory of that many rows.
Noise smooth(std::mt19937_64& random, double um, double memory) {
  const double keep = std::exp(-1 / memory), step = um * std::sqrt(1 - keep * keep);
  return [&random, keep, step, state = 0.0]() mutable {
    return state = keep * state + std::normal_distribution<double>(0, step)(random);
  };
}

// A resonance: second-order autoregression at a period, in rows.
Noise ringing(std::mt19937_64& random, double um, double period) {
  const double r = 0.98, a = 2 * r * std::cos(2 * kPi / period), step = um * (1 - r);
  return [&random, a, r, step, one = 0.0, two = 0.0]() mutable {
    const double now = a * one - r * r * two + std::normal_distribution<double>(0, step)(random);
    two = one;
    return one = now;
  };
}

int alarms(int surveys, const std::function<bool(std::mt19937_64&)>& survey) {
  std::mt19937_64 random(kSeed);
  std::printf("seed %llu, %d surveys\n", static_cast<unsigned long long>(kSeed), surveys);
  int count = 0;
  for (int i = 0; i < surveys; ++i) count += survey(random) ? 1 : 0;
  std::printf("false alarms: %d\n", count);
  return count;
}

bool alarm(const std::vector<CircleRun>& runs, const RadialError& error, const Noise& noise) {
  const auto record = circle_record(runs, error, noise);
  return examine_time_base(record.measurement, record.residual).found;
}

RadialError none() {
  return [](double, int, double) { return 0.0; };
}

TEST(TimeBaseFalseAlarm, ZeroResidualIsNone) {
  EXPECT_FALSE(alarm(good_runs(), none(), [] { return 0.0; }));
}

TEST(TimeBaseFalseAlarm, NoiseOfAnyColourIsNone) {
  // 1000 surveys: at most one alarm is 0.1 %.
  EXPECT_LE(alarms(1000,
                   [](std::mt19937_64& random) {
                     switch (random() % 4) {
                       case 0:
                         return alarm(good_runs(), none(), white(random, 5));
                       case 1:
                         return alarm(good_runs(), none(), smooth(random, 5, 5));
                       case 2:
                         return alarm(good_runs(), none(), smooth(random, 5, 200));
                       default:
                         return alarm(good_runs(), none(), ringing(random, 5, 20));
                     }
                   }),
            1);
}

double uniform(std::mt19937_64& random, double from, double to) {
  return std::uniform_real_distribution<double>(from, to)(random);
}

// Errors that machines have: of either axis backlash, cyclic error (its phase another in the other sense),
// reversal spikes, squareness and ovality, drift.
RadialError machine_error(std::mt19937_64& random) {
  struct Axis {
    double backlash, cyclic, pitch, phase, lost_phase, spike, decay;
  };
  std::array<Axis, 2> axes{};
  for (Axis& a : axes) {
    a = {uniform(random, -15, 15), uniform(random, 0, 10),   uniform(random, 5, 50), uniform(random, 0, 6.28),
         uniform(random, -1, 1),   uniform(random, -20, 20), uniform(random, 0.5, 8)};
  }
  const double oval = uniform(random, -10, 10), square = uniform(random, -10, 10),
               drift = uniform(random, -20, 20);
  return [axes, oval, square, drift](double angle_deg, int sense, double turned) {
    const double t = angle_deg * kPi / 180;
    double sum = oval * std::cos(2 * t) + square * std::sin(2 * t) + drift * turned;
    for (int k = 0; k < 2; ++k) {
      const Axis& a = axes[static_cast<std::size_t>(k)];
      const double along = k == 0 ? std::cos(t) : std::sin(t);
      const double dir = (k == 0 ? -std::sin(t) : std::cos(t)) * sense > 0 ? 1 : -1;
      const double since = 100 * (1 + dir * along);
      sum += along * (a.backlash * dir / 2 +
                      a.cyclic * std::sin(2 * kPi * 100 * along / a.pitch + a.phase + dir * a.lost_phase) +
                      a.spike * dir * std::exp(-since / a.decay));
    }
    return sum;
  };
}

TEST(TimeBaseFalseAlarm, MachineErrorsThatRepeatAreNone) {
  EXPECT_LE(alarms(1000,
                   [](std::mt19937_64& random) {
                     const RadialError error = machine_error(random);
                     return alarm(good_runs(), error, white(random, uniform(random, 0.1, 5)));
                   }),
            1);
}

TEST(TimeBaseFalseAlarm, OppositeSensesOfARightClockAreNone) {
  EXPECT_LE(alarms(1000,
                   [](std::mt19937_64& random) {
                     const RadialError error = random() % 2 == 0
                                                   ? machine_error(random)
                                                   : repeating_error(random(), 20, 40, uniform(random, 0, 2));
                     return alarm(single_turns(), error,
                                  smooth(random, uniform(random, 0.1, 10), uniform(random, 0.1, 50)));
                   }),
            1);
}

TEST(TimeBaseFalseAlarm, OneCyclicErrorAloneIsNone) {
  // A residual of one period repeats at every period: none of them is better than the one implied.
  EXPECT_LE(alarms(300,
                   [](std::mt19937_64& random) {
                     const int lobes = 3 + static_cast<int>(random() % 60);
                     const double phase = uniform(random, 0, 3);
                     const RadialError cyclic = [lobes, phase](double angle_deg, int sense, double) {
                       return 20 * std::sin(lobes * angle_deg * kPi / 180 + sense * phase);
                     };
                     return alarm(good_runs(), cyclic, white(random, 2));
                   }),
            0);
}

}  // namespace
}  // namespace vernier::time_base_false_alarm_test
