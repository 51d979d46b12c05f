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
  /// Monte Carlo trials continue in blocks of ten thousand until the ends of the interval are stable. An end
  /// of the interval is stable if twice the standard deviation of its average is below this share of the
  /// standard uncertainty (JCGM 101:2008, 7.9). If the model has a discrepancy, the permitted share for a
  /// stable interval end is doubled.
  double tolerance = 0.05;
  std::size_t most_trials = 500000;
  /// Probability from which a tolerance is met, or not met: the default conformance probability limit of ISO
  /// 14253-1:2017.
  double confidence = 0.95;
  /// Standard deviation of the independent error of each point, mm: repeatability of the machine, error of
  /// the tool, error of cutting. The machine file does not contain process_mm.
  double process_mm = 0;
  bool with_rotary = false;              // true: the correction also moves the rotary axes
  std::function<void(double)> progress;  // function that gets the completed share of the computation, 0..1
};

enum class PartVerdict : std::uint8_t { kConforms, kDoesNotConform, kCannotBeSaid };
const char* verdict_words(PartVerdict verdict);

/// Expected result for one characteristic of the part, mm.
struct Expectation {
  double value = 0;          // value of the characteristic for the machine as it was fitted
  double mean = 0, std = 0;  // mean and standard deviation over the trials
  /// Ends of the interval that contains 95 % of the trials: 2.5 % of the trials are below `low`, and 2.5 %
  /// are above `high`. If the model has a discrepancy, `low` is the smallest and `high` the largest of the
  /// interval ends over the assumed wavelengths of the discrepancy.
  double low = 0, high = 0;
  double u95 = 0;  // half of the width of the 95 % interval
  /// Probability that the part conforms. If the model has a discrepancy, the probability is that of the
  /// wavelength that is least favourable to the verdict.
  std::optional<double> probability;
  std::optional<PartVerdict> verdict;
};

/// Contribution of one source of error to one characteristic of the part.
struct SourceShare {
  std::string name, effect;
  /// fall_mm: decrease of the absolute value of the characteristic (uncorrected machine) if the error of this
  /// source is zero, mm. largest: probability that no other source has a larger decrease.
  double fall_mm = 0, largest = 0;
  /// Share of the variance of the characteristic: covariance of the source's contribution with the sum of all
  /// contributions. A negative share of the variance means that the source is correlated with other sources.
  double variance = 0;
  double open = 0;  // share of the variance from the part of this source that the measurements do not
                    // determine
};

struct CharacteristicResult {
  std::size_t feature = 0;
  PartCharacteristic what = PartCharacteristic::kPosition;
  std::optional<std::array<double, 2>> limits_mm;
  Expectation off, on;               // expected results without and with the correction
  std::vector<SourceShare> sources;  // sources in the order of their fall_mm, largest first
  /// The sources whose removal decreases the characteristic most, with the required confidence. The list
  /// contains one source if this source is significant, and no source if every decrease is below a nanometre.
  std::vector<std::string> dominant;
  double open = 0;         // share of the variance that the measurements do not determine
  double process = 0;      // share of the variance from the independent errors of the points
  double discrepancy = 0;  // share of the variance from the discrepancy of the model
  bool outside = false;    // true: the feature extends beyond the measured ranges, so there is no verdict
};

struct PartConformity {
  std::vector<CharacteristicResult> characteristics;
  std::size_t trials = 0;
  std::uint64_t seed = 0;
  bool settled = true;     // true: the numerical tolerance of the trials was reached
  bool exact = false;      // true: each trial is computed with the whole kinematic chain; false: the trials
                           // are linear in the parameters
  double linear_mm = 0;    // largest difference between linear trials and trials with the kinematic chain,
                           // for a few trials
  bool open_known = true;  // true: the machine file states which parameters the measurements did not
                           // determine
  /// Discrepancy of the model that the fit found, included in each interval; x, y, z
  std::array<double, 3> discrepancy_mm{};
  std::vector<std::string> stale;    // names of parameters that were changed after the fit
  std::vector<std::string> outside;  // ranges of the part that were not measured, for example "Z -350
                                     // to -300"
};

/// Computes the distribution of each characteristic of a part, with and without the machine's correction.
/// Method: Monte Carlo with the covariance matrix of the last fit in the machine file (JCGM 101:2008). Throws
/// InputError if the machine was never fitted.
PartConformity part_conformity(const model::Machine& machine, const PlacedPart& part, const std::string& file,
                               const std::vector<effects::Effect>& catalogue,
                               const ConformityOptions& options = {});

}  // namespace vernier::tolerance
