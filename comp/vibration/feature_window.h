// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>

#include "comp/quantity.h"
#include "comp/vibration/scaled.h"
#include "comp/vibration/spectral_weights.h"

namespace vernier {

/// Features of one axis of an accelerometer over a window of samples x, m their mean (C. Walker, PhD thesis,
/// University of Strathclyde 2026, section 6.2.1; the last three as in the code of its appendix 16.8).
enum class Feature : std::uint8_t {
  kMav,        // sum |x| / n
  kVar,        // sum (x - m)^2 / (n - 1)
  kRms,        // sqrt(sum x^2 / n)
  kShape,      // RMS / MAV
  kImpact,     // max |x| / MAV
  kCrest,      // max |x| / RMS
  kKurtosis,   // fourth central moment / second^2: 3 for a normal signal
  kSkewness,   // third central moment / second^1.5
  kFrequency,  // sum f P / sum P over the one-sided periodogram (rectangular window, mean value included), Hz
  kBandpower,  // sum x^2 / n
  kPeak,       // max x
  kPeakImpact,  // max x / MAV
  kPeakCrest,   // max x / RMS
};
constexpr unsigned kFeatures = 13;

/// Meaning of the integer samples of a FeatureWindow: size of one count, and sample rate. `lsb`: value of one
/// LSB in 1e-6 of the signal's unit (10 for 10 ug and a signal in g), 1..2^30. `rate`: sample rate in 1e-6
/// Hz, 1..2^42.
struct FeatureScale {
  InputMicro lsb{10};
  InputMicro rate{1'000'000'000};
};

/// Features of a window, as inputs of an equation. The unit is 1e-6 of the signal's unit (squared for VAR and
/// BANDPOWER), 1e-6, or 1e-6 Hz. If bit i of `undefined` is set, feature i is 0/0 (all samples are zero, or
/// all are equal), and its value is 0.
struct FeatureValues {
  InputMicro value[kFeatures];
  std::uint32_t undefined = 0;
};

/// Stores the last n samples of one axis and computes their features. The computing time of a FeatureWindow
/// is the same for each sample. For each sample, four power sums and sum |x| add the new sample and subtract
/// the oldest sample exactly. A tree of groups updates the extremes, and n/4 products update the first
/// moment of the spectrum (spectral_weights.h). All values of the window are integers. Because all values of
/// the window are integers, they do not drift, for any running time. Ranges for n <= 2^11, |x| < 2^19: sum
/// x^2 < 2^49, sum x^3 < 2^68, sum x^4 < 2^87, moments times powers of n below 2^121, spectral sum below
/// 2^82. With these ranges, 128-bit sums are exact. The error of a value of features() is at most 0.501 of
/// 1e-6 plus 2^-54 of the value. For FREQUENCY, the rounding of the weights adds an error of rate n 2^-36
/// (36 uHz at 1651 Hz and n = 1500). A feature beyond the range of int64 is limited to the range of int64.
class FeatureWindow {
 public:
  static constexpr std::int32_t kLimit = (std::int32_t{1} << 19) - 1;

  /// Starts an empty window. `weights` must exist longer than the window. The windows of several axes may
  /// use the same weights. Returns false if scale or weights are out of range. Not real-time safe.
  bool start(const FeatureScale& scale, const SpectralWeights& weights) noexcept;

  /// Takes one sample in LSB. A sample beyond +-kLimit is limited to +-kLimit and counted. Real-time safe.
  void push(std::int32_t sample) noexcept;

  /// True if the window received n samples since start(). Real-time safe.
  bool filled() const noexcept { return seen_ >= window_; }
  std::uint32_t held() const noexcept { return held_; }

  /// Returns the features of the last n samples. Before the first n samples, the missing samples count as
  /// zero. Real-time safe.
  FeatureValues features() const noexcept;

 private:
  static constexpr std::uint32_t kMaxHalf = kMaxWindow / 2;
  static constexpr std::uint32_t kGroup = 16;
  static constexpr std::uint32_t kLeaves = kMaxWindow / kGroup;

  std::int64_t neighbours(std::uint32_t parity, std::uint32_t place) const noexcept;
  void store(std::uint32_t parity, std::uint32_t place, std::int32_t sample) noexcept;
  void amplitudes(FeatureValues& out, Scaled mean_square, Scaled inverse_rms,
                  Scaled inverse_mav) const noexcept;
  void shapes(FeatureValues& out) const noexcept;

  const SpectralWeights* weights_ = nullptr;
  std::uint32_t window_ = 0, next_ = 0, seen_ = 0, held_ = 0;
  Scaled lsb_, inverse_n_, root_n_, variance_scale_, power_scale_, rate_;
  struct Sums {
    std::uint64_t absolute = 0, square = 0;
    std::int64_t first = 0;
    Wide cube, fourth, spectral;
  };
  Sums sums_;
  // Samples with even index and samples with odd index are stored in separate arrays. Each array contains its
  // samples twice, one copy after the other. With this arrangement, the samples at odd distances from a
  // sample are adjacent in memory.
  std::int32_t samples_[2][2 * kMaxHalf];
  std::int32_t highest_[2 * kLeaves], lowest_[2 * kLeaves];  // node i of the tree combines the nodes 2i and
                                                             // 2i + 1
};

}  // namespace vernier
