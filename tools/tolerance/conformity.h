// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "tools/effects/catalogue.h"
#include "tools/model/machine.h"
#include "tools/tolerance/feature_values.h"

namespace vernier::tolerance {

struct ConformityOptions {
  PartFrame frame = PartFrame::kPart;
  std::uint64_t seed = 1;
  /// Trials continue, ten thousand at a time, until their result is stable. Stable: twice the standard
  /// deviation of the averaged interval ends is below this share of the standard uncertainty (one digit of
  /// two: JCGM 101:2008, 7.9).
  double tolerance = 0.05;
  std::size_t most_trials = 500000;
  /// Probability from which a tolerance counts as met, or as not met: the default conformance probability
  /// limit of ISO 14253-1:2017.
  double confidence = 0.95;
  /// Standard deviation of the independent error of each point, mm: repeatability, tool, cutting. The machine
  /// file does not contain process_mm.
  double process_mm = 0;
  bool with_rotary = false;              // the correction moves all axes
  std::function<void(double)> progress;  // share done
};

enum class PartVerdict : std::uint8_t { kConforms, kDoesNotConform, kCannotBeSaid };
const char* verdict_words(PartVerdict verdict);

/// Expected result for one characteristic, mm.
struct Expectation {
  double value = 0;          // of the machine as it was fitted
  double mean = 0, std = 0;  // over the trials
  /// Ends of the interval that contains 95 % of the trials: 2.5 % of the trials are below `low`, and 2.5 %
  /// are above `high`. If the model has a discrepancy, each end of the interval is that of the wavelength
  /// with the widest interval.
  double low = 0, high = 0;
  double u95 = 0;  // half of that interval
  /// Probability of conformity; with a discrepancy, that of the wavelength that is least favourable to the
  /// verdict.
  std::optional<double> probability;
  std::optional<PartVerdict> verdict;
};

/// Contribution of a source to a characteristic.
struct SourceShare {
  std::string name, effect;
  /// fall_mm: decrease of the uncorrected value when the source is switched off, mm. largest: probability
  /// that the decrease by no other source is larger.
  double fall_mm = 0, largest = 0;
  /// Part of the variance: covariance of the source's contribution with the whole. A value below 0 means that
  /// the source and other sources are correlated.
  double variance = 0;
  double open = 0;  // part of the variance that is this source's and that no reading bears on
};

struct CharacteristicResult {
  std::size_t feature = 0;
  PartCharacteristic what = PartCharacteristic::kPosition;
  std::optional<std::array<double, 2>> limits_mm;
  Expectation off, on;               // without and with the correction
  std::vector<SourceShare> sources;  // largest fall first
  /// The sources whose removal lowers the value most, with the required confidence: one source if it is
  /// significant, none if no decrease is above a nanometre.
  std::vector<std::string> dominant;
  double open = 0;         // part of the variance that no reading bears on
  double process = 0;      // part of the points' own errors
  double discrepancy = 0;  // part of the model discrepancy
  bool outside = false;    // the feature extends beyond the measured ranges: no verdict
};

struct PartConformity {
  std::vector<CharacteristicResult> characteristics;
  std::size_t trials = 0;
  std::uint64_t seed = 0;
  bool settled = true;     // the numerical tolerance was reached
  bool exact = false;      // every trial through the whole chain; else linear in the parameters
  double linear_mm = 0;    // by how much the linear trials were off in those that were tried with the chain
  bool open_known = true;  // the machine file states what its readings did not determine
  std::array<double, 3> discrepancy_mm{};  // discrepancy found by the fit, in every interval; x, y, z
  std::vector<std::string> stale;          // parameters that were changed since the fit
  std::vector<std::string> outside;        // "Z -350..-300": ranges of the part that were not measured
};

/// Computes the distribution of every characteristic of the part, with and without the machine's correction.
/// Method: Monte Carlo over the covariance of the last fit in the machine file (JCGM 101:2008). Throws
/// InputError if the machine was never fitted.
PartConformity part_conformity(const model::Machine& machine, const PlacedPart& part, const std::string& file,
                               const std::vector<effects::Effect>& catalogue,
                               const ConformityOptions& options = {});

}  // namespace vernier::tolerance
