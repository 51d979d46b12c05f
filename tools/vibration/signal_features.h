// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <array>
#include <span>
#include <string>
#include <vector>

#include "tools/vibration/fourier.h"

namespace vernier::vibration {

/// Names of the features of comp/vibration/feature_window.h. The functions of signal_features.h compute the
/// same features in double precision. The features in double precision are the reference for the fixed-point
/// code of the board, and the output of `vernier features`. The names of the features are in the order of the
/// enumeration Feature.
inline constexpr std::array<const char*, 13> kFeatureNames = {
    "MAV",      "VAR",       "RMS",       "SHAPE", "IMPACT",     "CREST",    "KURTOSIS",
    "SKEWNESS", "FREQUENCY", "BANDPOWER", "PEAK",  "PEAKIMPACT", "PEAKCREST"};
using SignalFeatures = std::array<double, kFeatureNames.size()>;

/// Returns true if the feature has the unit of the signal: MAV, RMS and PEAK. VAR and BANDPOWER have the
/// square of the signal's unit, and FREQUENCY is in Hz. Features other than MAV, RMS, PEAK, VAR, BANDPOWER
/// and FREQUENCY have no unit.
bool in_signal_unit(std::size_t feature);

/// Returns the features of a window of samples x, sampled at rate_Hz; the length of x must be that of
/// `fourier`. A feature is NaN if its formula gives 0/0, for example the kurtosis of a constant signal. The
/// central moments are computed in a second pass over the samples.
SignalFeatures signal_features(std::span<const double> x, double rate_Hz, Fourier& fourier);

}  // namespace vernier::vibration
