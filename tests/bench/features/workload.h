// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <cstdint>

#include "comp/vibration/displacement.h"
#include "comp/vibration/feature_window.h"

namespace vernier::bench {

/// One axis of an accelerometer on any target: samples of a seeded noise, a window of features, a
/// displacement.
struct VibrationLoad {
  SpectralWeights weights;
  FeatureWindow window;
  Displacement displacement;
  std::uint32_t state = 1;
  std::uint64_t hash = 0;  // nothing runs constructors on the bare board

  bool start(std::uint32_t samples) {
    return prepare_weights(samples, weights) && window.start({}, weights) && displacement.start({});
  }
  std::int32_t sample() {
    state = state * 1664525u + 1013904223u;
    return static_cast<std::int32_t>(state >> 13) - (1 << 18);
  }
  void mix(std::int64_t value) { hash = (hash ^ static_cast<std::uint64_t>(value)) * 1099511628211u; }
  void push() { window.push(sample()); }
  void evaluate() {
    for (const InputMicro& value : window.features().value) mix(value.count);
  }
  void integrate() { mix(displacement.step(sample()).count); }
};

constexpr std::uint32_t kLoadWindows[] = {800, 1500, 2048};

}  // namespace vernier::bench
