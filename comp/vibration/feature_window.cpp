// SPDX-License-Identifier: Apache-2.0
#include "comp/vibration/feature_window.h"

#include "comp/fixed.h"

namespace vernier {
namespace {

constexpr Scaled kMillion = scaled(std::uint64_t{1'000'000});
constexpr Scaled kMillionth = reciprocal(kMillion);

Wide signed_product(std::int64_t a, std::int64_t b) noexcept { return wide(a) * wide(b); }

Wide fourth_power(std::int64_t x) noexcept {
  const auto square = static_cast<std::uint64_t>(x * x);
  return long_product(square, square);
}

void put(FeatureValues& out, Feature feature, Scaled value) noexcept {
  out.value[static_cast<unsigned>(feature)] = InputMicro(count_of(value));
}
void put_signed(FeatureValues& out, Feature feature, Scaled value, bool negative) noexcept {
  const std::int64_t count = count_of(value);
  out.value[static_cast<unsigned>(feature)] = InputMicro(negative ? -count : count);
}
template <class... Features>
void undefine(FeatureValues& out, Features... features) noexcept {
  ((out.undefined |= std::uint32_t{1} << static_cast<unsigned>(features)), ...);
}

}  // namespace

bool FeatureWindow::start(const FeatureScale& scale, const SpectralWeights& weights) noexcept {
  constexpr std::int64_t kMaxLsb = std::int64_t{1} << 30, kMaxRate = std::int64_t{1} << 42;
  if (scale.lsb.count < 1 || scale.lsb.count > kMaxLsb) return false;
  if (scale.rate.count < 1 || scale.rate.count > kMaxRate || weights.window == 0) return false;
  sums_ = Sums{};
  next_ = seen_ = held_ = 0;
  weights_ = &weights;
  window_ = weights.window;
  const Scaled n = scaled(std::uint64_t{window_});
  lsb_ = scaled(static_cast<std::uint64_t>(scale.lsb.count));
  rate_ = scaled(static_cast<std::uint64_t>(scale.rate.count));
  inverse_n_ = reciprocal(n);
  root_n_ = n * inverse_root(n);
  power_scale_ = lsb_ * lsb_ * kMillionth * inverse_n_;
  variance_scale_ = power_scale_ * reciprocal(scaled(std::uint64_t{window_ - 1}));
  for (auto& row : samples_)
    for (std::int32_t& sample : row) sample = 0;
  for (std::int32_t& node : highest_) node = -kLimit;
  for (std::int32_t& node : lowest_) node = kLimit;
  return true;
}

// Weighted sum of the samples at odd distances from a place: 2^51 at most.
std::int64_t FeatureWindow::neighbours(std::uint32_t parity, std::uint32_t place) const noexcept {
  const std::int32_t* after = samples_[1 - parity] + place + parity;
  const std::int32_t* before = after + window_ / 2 - 1;
  std::int64_t sum = 0;
  for (std::uint32_t i = 0; i < weights_->pairs; ++i)
    sum += std::int64_t{weights_->weight[i]} * (after[i] + *before--);
  return sum + std::int64_t{weights_->middle} * after[weights_->pairs];
}

// Puts a sample in its place and renews the extremes: its group, then one node of each of seven levels.
void FeatureWindow::store(std::uint32_t parity, std::uint32_t place, std::int32_t sample) noexcept {
  const std::uint32_t half = window_ / 2;
  std::int32_t* row = samples_[parity];
  row[place] = sample;
  row[place + half] = sample;
  const std::uint32_t first = place / kGroup * kGroup;
  std::int32_t high = sample, low = sample;
  for (std::uint32_t i = first; i < lower(first + kGroup, half); ++i) {
    high = higher(high, row[i]);
    low = lower(low, row[i]);
  }
  std::uint32_t node = kLeaves + parity * (kLeaves / 2) + place / kGroup;
  highest_[node] = high;
  lowest_[node] = low;
  for (node /= 2; node > 0; node /= 2) {
    highest_[node] = higher(highest_[2 * node], highest_[2 * node + 1]);
    lowest_[node] = lower(lowest_[2 * node], lowest_[2 * node + 1]);
  }
}

void FeatureWindow::push(std::int32_t sample) noexcept {
  const std::int32_t taken = clamp(sample, -kLimit, kLimit);
  if (taken != sample) ++held_;
  const std::uint32_t parity = next_ & 1, place = next_ / 2;
  const std::int64_t x = taken, old = samples_[parity][place], change = x - old;
  // x'Hx of a symmetric H with an empty diagonal: one element's change adds 2 change (Hx).
  sums_.spectral = sums_.spectral + signed_product(neighbours(parity, place), 2 * change);
  sums_.absolute += static_cast<std::uint64_t>(magnitude_of(x) - magnitude_of(old));
  sums_.first += change;
  sums_.square += static_cast<std::uint64_t>(x * x - old * old);
  sums_.cube = sums_.cube + wide(x * x * x - old * old * old);
  sums_.fourth = sums_.fourth + fourth_power(x) - fourth_power(old);
  store(parity, place, taken);
  next_ = next_ + 1 == window_ ? 0 : next_ + 1;
  if (seen_ < window_) ++seen_;
}

// What needs no central moment. Their units: sums in LSB, inverse_* per LSB.
void FeatureWindow::amplitudes(FeatureValues& out, Scaled mean_square, Scaled inverse_rms,
                               Scaled inverse_mav) const noexcept {
  const std::int32_t top = highest_[1], bottom = lowest_[1];
  const auto largest = static_cast<std::uint64_t>(higher(magnitude_of(top), magnitude_of(bottom)));
  const Scaled peak = scaled(static_cast<std::uint64_t>(magnitude_of(top)));
  const Scaled rms = mean_square * inverse_rms;
  put(out, Feature::kMav, scaled(sums_.absolute) * inverse_n_ * lsb_);
  put(out, Feature::kRms, rms * lsb_);
  put_signed(out, Feature::kPeak, peak * lsb_, top < 0);
  if (sums_.square == 0) {
    undefine(out, Feature::kShape, Feature::kImpact, Feature::kCrest, Feature::kFrequency,
             Feature::kPeakImpact, Feature::kPeakCrest);
    return;
  }
  const Scaled per_mav = inverse_mav * kMillion, per_rms = inverse_rms * kMillion;
  put(out, Feature::kShape, rms * per_mav);
  put(out, Feature::kImpact, scaled(largest) * per_mav);
  put(out, Feature::kCrest, scaled(largest) * per_rms);
  put_signed(out, Feature::kPeakImpact, peak * per_mav, top < 0);
  put_signed(out, Feature::kPeakCrest, peak * per_rms, top < 0);
  // rate (1/4 - spectral / (2^34 sum x^2)); the rounded weights may carry a constant signal just below zero.
  const Wide moment = Wide{sums_.square >> 32, sums_.square << 32} - sums_.spectral;
  if (!is_negative(moment))
    put(out, Feature::kFrequency, rate_ * shifted(scaled(moment) * reciprocal(scaled(sums_.square)), -34));
}

// Variance, skewness and kurtosis from n^k times the central moments, exact: C2 = n S2 - S1^2,
// C3 = n^2 S3 - 3 n S1 S2 + 2 S1^3, C4 = n^3 S4 - 4 n^2 S1 S3 + 6 n S1^2 S2 - 3 S1^4.
void FeatureWindow::shapes(FeatureValues& out) const noexcept {
  const Wide n = wide(window_), s1 = wide(sums_.first), s2 = {0, sums_.square};
  const Wide n_s2 = n * s2, s1_s1 = s1 * s1, n_n = n * n;
  const Wide second = n_s2 - s1_s1;
  put(out, Feature::kVar, scaled(second) * variance_scale_);
  if (second == Wide{}) {
    undefine(out, Feature::kKurtosis, Feature::kSkewness);
    return;
  }
  const Wide third = n_n * sums_.cube - s1 * (wide(3) * n_s2 - wide(2) * s1_s1);
  const Wide fourth =
      n_n * (n * sums_.fourth - wide(4) * s1 * sums_.cube) + s1_s1 * (wide(6) * n_s2 - wide(3) * s1_s1);
  const Scaled root = inverse_root(scaled(second)), inverse = root * root;
  put(out, Feature::kKurtosis, scaled(fourth) * inverse * inverse * kMillion);
  put_signed(out, Feature::kSkewness, scaled(magnitude(third)) * inverse * root * kMillion,
             is_negative(third));
}

FeatureValues FeatureWindow::features() const noexcept {
  FeatureValues out;
  put(out, Feature::kBandpower, scaled(sums_.square) * power_scale_);
  const Scaled mean_square = scaled(sums_.square) * inverse_n_;
  const bool nothing = sums_.square == 0;
  const Scaled inverse_rms = nothing ? Scaled{} : inverse_root(scaled(sums_.square)) * root_n_;
  const Scaled inverse_mav =
      nothing ? Scaled{} : reciprocal(scaled(sums_.absolute)) * scaled(std::uint64_t{window_});
  amplitudes(out, mean_square, inverse_rms, inverse_mav);
  shapes(out);
  return out;
}

}  // namespace vernier
