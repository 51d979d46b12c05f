// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <array>
#include <span>
#include <string>
#include <vector>

#include "tools/vibration/fourier.h"

namespace vernier::vibration {

/// The features of comp/vibration/feature_window.h in double, by their definitions. They are the
/// reference for the fixed-point code, and the output of `vernier features`. Same order.
inline constexpr std::array<const char*, 13> kFeatureNames = {
    "MAV",      "VAR",       "RMS",       "SHAPE", "IMPACT",     "CREST",    "KURTOSIS",
    "SKEWNESS", "FREQUENCY", "BANDPOWER", "PEAK",  "PEAKIMPACT", "PEAKCREST"};
using SignalFeatures = std::array<double, kFeatureNames.size()>;

/// Is this feature in the signal's own unit (MAV, RMS, PEAK)? VAR and BANDPOWER are in its square,
/// FREQUENCY in Hz, the others are pure numbers.
bool in_signal_unit(std::size_t feature);

/// Returns features of the samples x (n of them, the length of `fourier`) at a rate in Hz. Not
/// finite if a feature is 0/0. Two passes for the central moments. tool.
SignalFeatures signal_features(std::span<const double> x, double rate_Hz, Fourier& fourier);

}  // namespace vernier::vibration
