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
  /// Trials are repeated, ten thousand at a time, until twice the standard deviation of their
  /// averages of an interval's ends is below this share of its standard uncertainty: one digit of
  /// two (JCGM 101:2008, 7.9).
  double tolerance = 0.05;
  std::size_t most_trials = 500000;
  /// Probability above which a tolerance counts as kept, or as not kept: the default conformance
  /// probability limit of ISO 14253-1:2017.
  double confidence = 0.95;
  /// Standard deviation of each point's own error, mm: repeatability, tool, cutting. The machine
  /// file does not contain it.
  double process_mm = 0;
  bool with_rotary = false;              // the correction moves all axes
  std::function<void(double)> progress;  // share done
};

enum class PartVerdict : std::uint8_t { kConforms, kDoesNotConform, kCannotBeSaid };
const char* verdict_words(PartVerdict verdict);

/// Expected values of one characteristic, mm.
struct Expectation {
  double value = 0;          // of the machine as it was fitted
  double mean = 0, std = 0;  // over the trials
  /// Interval that contains 95 % of the trials, with equal shares below and above. If the model
  /// lacks something, the wavelength that makes each end widest is used.
  double low = 0, high = 0;
  double u95 = 0;  // half of that interval
  /// Of conformity. If the model lacks something, the wavelength that is least favourable to the
  /// verdict is used.
  std::optional<double> probability;
  std::optional<PartVerdict> verdict;
};

/// Influence of a source on a characteristic.
struct SourceShare {
  std::string name, effect;
  /// Decrease of the uncorrected value if the source is switched off, mm; and the probability that
  /// no other source has a larger decrease.
  double fall_mm = 0, largest = 0;
  /// Part of the variance: covariance of the source's own contribution with the whole. Below 0 if
  /// it is correlated with others.
  double variance = 0;
  double open = 0;  // part of the variance that is due to this source and that no reading determines
};

struct CharacteristicResult {
  std::size_t feature = 0;
  PartCharacteristic what = PartCharacteristic::kPosition;
  std::optional<std::array<double, 2>> limits_mm;
  Expectation off, on;               // without and with the correction
  std::vector<SourceShare> sources;  // largest decrease first
  /// The sources whose removal lowers the value most, with the required confidence: one source if it is
  /// significant, none if no decrease is above a nanometre.
  std::vector<std::string> dominant;
  double open = 0;         // part of the variance that no reading determines
  double process = 0;      // part of the points' own errors
  double discrepancy = 0;  // part of the discrepancy of the model
  bool outside = false;    // the feature is partly outside the measured range of an axis: no verdict
};

struct PartConformity {
  std::vector<CharacteristicResult> characteristics;
  std::size_t trials = 0;
  std::uint64_t seed = 0;
  bool settled = true;     // the numerical tolerance was reached
  bool exact = false;      // every trial through the whole chain; else linear in the parameters
  double linear_mm = 0;    // largest difference between linear trials and trials with the chain
  bool open_known = true;  // the machine file states what its readings did not determine
  std::array<double, 3> discrepancy_mm{};  // discrepancy that the fit found, in every interval; x, y, z
  std::vector<std::string> stale;          // parameters that were changed since the fit
  std::vector<std::string> outside;        // "Z -350..-300": ranges of the part that were not measured
};

/// Monte Carlo over the covariance of the last fit in the machine file (JCGM 101:2008): expected
/// value of every characteristic of the part, with and without the machine's correction. Throws
/// InputError if the machine was never fitted. tool.
PartConformity part_conformity(const model::Machine& machine, const PlacedPart& part, const std::string& file,
                               const std::vector<effects::Effect>& catalogue,
                               const ConformityOptions& options = {});

}  // namespace vernier::tolerance
