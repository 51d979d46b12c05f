// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <bit>
#include <cstdint>

namespace vernier {

/// Histogram of durations with a fixed memory. Bins are exact below 2^(kOctaveBits + 1) ns; above, each
/// octave has 2^kOctaveBits bins, up to 2^40 ns. The count of a bin stops at its largest value.
template <unsigned kOctaveBits>
class HistogramOf {
 public:
  /// `ns`: duration; a negative duration counts as 0. Real-time safe.
  void add(std::int64_t ns) noexcept {
    const auto value = static_cast<std::uint64_t>(ns < 0 ? 0 : ns);
    std::uint32_t& bin = bins_[bin_of(value < kLimit ? value : kLimit - 1)];
    if (bin < UINT32_MAX) ++bin;
    ++count_;
    last_ = ns;
    if (ns > max_) max_ = ns;
  }
  std::uint64_t count() const noexcept { return count_; }
  std::int64_t max_ns() const noexcept { return max_; }
  std::int64_t last_ns() const noexcept { return last_; }

  /// Returns the upper edge of the bin that contains the given share of all durations, at most the largest
  /// duration; 0 if the histogram is empty. `per_million`: share of the durations in 1e-6, for example 990000
  /// for the 99 % percentile. realtime, one pass over the bins.
  std::int64_t percentile_ns(std::uint64_t per_million) const noexcept {
    // The rank is rounded up. For only a few values, the percentile is therefore the upper edge of the bin of
    // one of the values, at most the largest value. The function contains no division, because the tick calls
    // this function. The counts are below 2^44.
    const std::uint64_t wanted = count_ * per_million;
    std::uint64_t seen = 0;
    for (std::uint32_t bin = 0; bin < kBins; ++bin) {
      seen += bins_[bin];
      if (seen * 1'000'000 >= wanted && seen > 0) {
        const auto edge = static_cast<std::int64_t>(upper_edge(bin));
        return edge < max_ ? edge : max_;
      }
    }
    return max_;
  }

  static constexpr std::uint32_t bin_of(std::uint64_t value) noexcept {
    const auto width = static_cast<std::uint32_t>(std::bit_width(value));
    const std::uint32_t shift = width > kOctaveBits + 1 ? width - kOctaveBits - 1 : 0;
    return (shift << kOctaveBits) + static_cast<std::uint32_t>(value >> shift);
  }
  /// Returns the largest value of a bin.
  static constexpr std::uint64_t upper_edge(std::uint32_t bin) noexcept {
    const std::uint32_t shift = bin < (2u << kOctaveBits) ? 0 : (bin >> kOctaveBits) - 1;
    return ((std::uint64_t{bin} - (std::uint64_t{shift} << kOctaveBits) + 1) << shift) - 1;
  }

 private:
  static constexpr std::uint64_t kLimit = std::uint64_t{1} << 40;
  static constexpr std::uint32_t kBins = (41 - kOctaveBits) << kOctaveBits;

  std::uint32_t bins_[kBins] = {};
  std::uint64_t count_ = 0;
  std::int64_t max_ = 0, last_ = 0;
};

/// Number of bins per octave, as a power of two. The value 6 gives 64 bins per octave (1.6 %) and 9 KB per
/// histogram. A small target sets a smaller number.
#ifndef VERNIER_HISTOGRAM_OCTAVE_BITS
#define VERNIER_HISTOGRAM_OCTAVE_BITS 6
#endif
using Histogram = HistogramOf<VERNIER_HISTOGRAM_OCTAVE_BITS>;

}  // namespace vernier
