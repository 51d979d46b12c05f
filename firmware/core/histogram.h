// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <bit>
#include <cstdint>

namespace vernier {

/// Counts of durations in a fixed memory: exact below 128 ns, then 64 bins an octave (1.6 %), to 2^40 ns.
class Histogram {
 public:
  /// ns: negative counts as 0. realtime.
  void add(std::int64_t ns) noexcept {
    const auto value = static_cast<std::uint64_t>(ns < 0 ? 0 : ns);
    ++bins_[bin_of(value < kLimit ? value : kLimit - 1)];
    ++count_;
    if (ns > max_) max_ = ns;
  }
  std::uint64_t count() const noexcept { return count_; }
  std::int64_t max_ns() const noexcept { return max_; }

  /// Upper edge of the bin that holds the given share of all, at most the largest value seen; 0 when empty.
  /// per_million: 990000 for p99. tool.
  std::int64_t percentile_ns(std::uint64_t per_million) const noexcept {
    // Rounded up, so that the percentile of few values is one of them and not below all.
    const std::uint64_t wanted = (count_ * per_million + 999999) / 1000000;
    std::uint64_t seen = 0;
    for (std::uint32_t bin = 0; bin < kBins; ++bin) {
      seen += bins_[bin];
      if (seen >= wanted && seen > 0) {
        const auto edge = static_cast<std::int64_t>(upper_edge(bin));
        return edge < max_ ? edge : max_;
      }
    }
    return max_;
  }

  static constexpr std::uint32_t bin_of(std::uint64_t value) noexcept {
    const auto width = static_cast<std::uint32_t>(std::bit_width(value));
    const std::uint32_t shift = width > 7 ? width - 7 : 0;
    return shift * 64 + static_cast<std::uint32_t>(value >> shift);
  }
  /// Largest value of a bin.
  static constexpr std::uint64_t upper_edge(std::uint32_t bin) noexcept {
    const std::uint32_t shift = bin < 128 ? 0 : bin / 64 - 1;
    return ((std::uint64_t{bin} - std::uint64_t{shift} * 64 + 1) << shift) - 1;
  }

 private:
  static constexpr std::uint64_t kLimit = std::uint64_t{1} << 40;
  static constexpr std::uint32_t kBins = 33 * 64 + 128;

  std::uint64_t bins_[kBins] = {};
  std::uint64_t count_ = 0;
  std::int64_t max_ = 0;
};

}  // namespace vernier
