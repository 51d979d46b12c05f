// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <array>
#include <span>
#include <string>
#include <vector>

#include "tools/vibration/fourier.h"

namespace vernier::vibration {

/// Names of the features of comp/vibration/feature_window.h, which this file computes in double by their
/// definitions. The values in double are the reference for the fixed-point code, and the output of `vernier
/// features`. The order of the names is that of the enumeration Feature.
inline constexpr std::array<const char*, 13> kFeatureNames = {
    "MAV",      "VAR",       "RMS",       "SHAPE", "IMPACT",     "CREST",    "KURTOSIS",
    "SKEWNESS", "FREQUENCY", "BANDPOWER", "PEAK",  "PEAKIMPACT", "PEAKCREST"};
using SignalFeatures = std::array<double, kFeatureNames.size()>;

/// True if a feature is in the unit of the signal (MAV, RMS, PEAK). VAR and BANDPOWER are in the square of
/// that unit, FREQUENCY in Hz, other features are pure numbers.
bool in_signal_unit(std::size_t feature);

/// Returns the features of the samples x (n samples, the length of `fourier`) at a rate in Hz. The value of a
/// feature is NaN if the feature is 0/0, for example the kurtosis of a constant signal. The central moments
/// need two passes over the samples.
SignalFeatures signal_features(std::span<const double> x, double rate_Hz, Fourier& fourier);

}  // namespace vernier::vibration
