// SPDX-License-Identifier: Apache-2.0
#include "hal/sim/roaming.h"

#include <algorithm>
#include <cmath>
#include <random>
#include <utility>

namespace vernier {
namespace {

constexpr double kPi = 3.14159265358979323846;

}  // namespace

Roaming::Roaming(const std::vector<RoamingAxis>& axes, std::vector<InputMicro> inputs, TimeUs tick,
                 double share_per_s, std::uint64_t seed)
    : inputs_(std::move(inputs)), tick_s_(static_cast<double>(tick.count) * 1e-6) {
  std::mt19937_64 random(seed);
  std::uniform_real_distribution<double> share(0.5, 1), phase(0, 2 * kPi);
  for (const RoamingAxis& axis : axes) {
    const double low = static_cast<double>(axis.low), high = static_cast<double>(axis.high);
    // Peak speed of amplitude * sin(rate * t) is amplitude * rate, amplitude half the range.
    swings_.push_back({(low + high) / 2, (high - low) / 2, 2 * share_per_s * share(random), phase(random)});
  }
}

void Roaming::vibrate(std::uint32_t input, double amplitude_micro, double frequency_Hz) {
  if (input < inputs_.size() && input < kMaxInputs)
    vibrations_.push_back({input, amplitude_micro, 2 * kPi * frequency_Hz});
}

void Roaming::at(std::int64_t tick, PlantState& state) noexcept {
  const double t = static_cast<double>(tick) * tick_s_;
  for (std::size_t i = 0; i < swings_.size() && i < kMaxAxes; ++i) {
    const Swing& swing = swings_[i];
    const double angle = swing.rate * t + swing.phase;
    const double turn = (std::floor(angle / kPi - 0.5) + 0.5) * kPi;  // the last reversal
    const double sine = std::sin(angle), speed = swing.amplitude * swing.rate * std::cos(angle);
    AxisReading& axis = state.axis[i];
    axis.position = AxisPosition(std::llround(swing.middle + swing.amplitude * sine));
    axis.velocity = AxisSpeed(std::llround(speed));
    axis.acceleration = AxisAcceleration(std::llround(-swing.amplitude * swing.rate * swing.rate * sine));
    axis.since = AxisTravel(std::llround(swing.amplitude * std::abs(sine - std::sin(turn))));
    axis.sense = static_cast<std::int8_t>(speed > 0 ? 1 : speed < 0 ? -1 : 0);
  }
  for (std::size_t i = 0; i < inputs_.size() && i < kMaxInputs; ++i) state.input[i] = inputs_[i];
  for (const Vibration& vibration : vibrations_)
    state.input[vibration.input].count += std::llround(vibration.amplitude * std::sin(vibration.rate * t));
}

}  // namespace vernier
