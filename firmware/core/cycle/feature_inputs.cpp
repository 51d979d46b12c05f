// SPDX-License-Identifier: Apache-2.0
#include "firmware/core/cycle/feature_inputs.h"

#include <algorithm>
#include <array>

#include "comp/fixed.h"
#include "comp/wide.h"

namespace vernier {
namespace {

constexpr std::array<const char*, kFeatures> kNames = {
    "MAV",      "VAR",       "RMS",       "SHAPE", "IMPACT",     "CREST",    "KURTOSIS",
    "SKEWNESS", "FREQUENCY", "BANDPOWER", "PEAK",  "PEAKIMPACT", "PEAKCREST"};
constexpr std::int64_t kMostMicro = std::int64_t{1} << 60;  // of a signal; a difference of two fits int64
constexpr std::int64_t kMostLsb = std::int64_t{1} << 30;
constexpr std::int64_t kMicroHzTimesUs = 1'000'000'000'000, kMilliHzTimesUs = 1'000'000'000;
constexpr std::int64_t kSettlingPeriods = 3, kMicroUmPerNm = 1000;

bool same_signal(const FeatureRequest& a, const FeatureRequest& b) noexcept {
  return a.of == b.of && a.minus == b.minus && a.window == b.window && a.every == b.every && a.lsb == b.lsb &&
         a.bridged == b.bridged && a.corner_mHz == b.corner_mHz && a.lsb_nm_s2 == b.lsb_nm_s2;
}

// Nearest multiple of lsb to value, ties away from zero; limited to just beyond the window's limit, and
// counted there. The product is the quotient or one below it, as size < 2^51 and the inverse is cut by less
// than 1: the remainder decides. No division.
std::int32_t rounded(std::int64_t value, std::int64_t lsb, std::uint64_t inverse) noexcept {
  const std::int64_t most = (std::int64_t{FeatureWindow::kLimit} + 1) * lsb;
  const std::int64_t size = lower(magnitude_of(value), most) + lsb / 2;
  auto quotient =
      static_cast<std::int64_t>(long_product(static_cast<std::uint64_t>(size) << 1, inverse).high);
  if (size - quotient * lsb >= lsb) ++quotient;
  return narrow(value < 0 ? -quotient : quotient);
}

}  // namespace

bool feature_of(std::string_view name, Feature& feature) noexcept {
  const auto found = std::find(kNames.begin(), kNames.end(), name);
  if (found == kNames.end()) return false;
  feature = static_cast<Feature>(found - kNames.begin());
  return true;
}

FeatureInputs::FeatureInputs(InputReader& source, std::uint32_t inputs,
                             std::span<const FeatureRequest> requests, TimeUs tick)
    : source_(source), inputs_(lower(inputs, kMaxInputs)) {
  bool is_feature[kMaxInputs] = {};
  for (const FeatureRequest& request : requests)
    if (request.input < inputs_) is_feature[request.input] = true;
  const auto has_samples = [&](std::uint32_t input) { return input < inputs_ && !is_feature[input]; };
  for (std::uint32_t i = 0; i < requests.size() && refused_ == kNoInput; ++i) {
    const FeatureRequest& request = requests[i];
    const bool known = request.input < inputs_ && has_samples(request.of) &&
                       (request.minus == kNoInput || has_samples(request.minus));
    const Signal* const signal = known ? signal_of(request, tick) : nullptr;
    if (signal == nullptr) {
      refused_ = i;
    } else {
      feature_[request.input] = signal;
      which_[request.input] = request.feature;
    }
  }
}

const SpectralWeights* FeatureInputs::weights_of(std::uint32_t window) {
  for (std::uint32_t i = 0; i < weight_count_; ++i)
    if (weights_[i]->window == window) return weights_[i].get();
  auto weights = std::make_unique<SpectralWeights>();
  if (weight_count_ == kMaxInputs || !prepare_weights(window, *weights)) return nullptr;
  weights_[weight_count_] = std::move(weights);
  return weights_[weight_count_++].get();
}

bool FeatureInputs::start_window(const FeatureRequest& request, TimeUs tick, Signal& signal) {
  const SpectralWeights* const weights = weights_of(request.window);
  if (weights == nullptr) return false;
  signal.full = request.window;
  const InputMicro rate(kMicroHzTimesUs / (tick.count * std::int64_t{request.every}));
  return signal.window.start({request.lsb, rate}, *weights);
}

bool FeatureInputs::start_filter(const FeatureRequest& request, TimeUs tick, Signal& signal) {
  const std::int64_t rate_mHz = kMilliHzTimesUs / (tick.count * std::int64_t{request.every});
  if (!signal.at_rest.start({request.lsb_nm_s2, rate_mHz, request.corner_mHz, rate_mHz * 18 / 100}))
    return false;
  signal.filter = signal.at_rest;
  signal.full =
      static_cast<std::uint32_t>((kSettlingPeriods * rate_mHz + request.corner_mHz - 1) / request.corner_mHz);
  return true;
}

FeatureInputs::Signal* FeatureInputs::signal_of(const FeatureRequest& request, TimeUs tick) {
  for (const auto& signal : windows_in_use())
    if (same_signal(signal->from, request)) return signal.get();
  if (request.every == 0 || tick.count < 1 || request.lsb.count < 1 || request.lsb.count > kMostLsb ||
      window_count_ == kMaxInputs)
    return nullptr;
  auto signal = std::make_unique<Signal>();
  signal->from = request;
  signal->inverse = (std::uint64_t{1} << 63) / static_cast<std::uint64_t>(request.lsb.count);
  const bool started =
      request.corner_mHz == 0 ? start_window(request, tick, *signal) : start_filter(request, tick, *signal);
  if (!started) return nullptr;
  windows_[window_count_] = std::move(signal);
  return windows_[window_count_++].get();
}

std::uint64_t FeatureInputs::held() const noexcept {
  std::uint64_t held = 0;
  for (const auto& signal : windows_in_use())
    held += signal->window.held() + signal->held_before + signal->filter.held();
  return held;
}

bool FeatureInputs::sample_of(const Signal& signal, std::int32_t& sample) const noexcept {
  const FeatureRequest& from = signal.from;
  const Reading& of = reading_[from.of];
  if (of.fault != HalFault::kNone) return false;
  std::int64_t value = clamp(of.value.count, -kMostMicro, kMostMicro);
  if (from.minus != kNoInput) {
    const Reading& minus = reading_[from.minus];
    if (minus.fault != HalFault::kNone) return false;
    value -= clamp(minus.value.count, -kMostMicro, kMostMicro);
  }
  sample = rounded(value, from.lsb.count, signal.inverse);
  return true;
}

void FeatureInputs::take(Signal& signal) noexcept {
  if (--signal.until_sample > 0) return;
  signal.until_sample = signal.from.every;
  if (sample_of(signal, signal.last)) {
    signal.missing = 0;
  } else if (signal.in_a_row == 0 || ++signal.missing > signal.from.bridged) {
    signal.in_a_row = 0;
    signal.ready = false;
    return;
  }
  use_sample(signal);
}

void FeatureInputs::use_sample(Signal& signal) noexcept {
  const bool displaced = signal.from.corner_mHz != 0;
  if (displaced && signal.in_a_row == 0) {
    signal.held_before += signal.filter.held();
    signal.filter = signal.at_rest;
  }
  signal.in_a_row = lower(signal.in_a_row + 1, signal.full);
  signal.ready = signal.in_a_row == signal.full;
  if (displaced) {
    signal.displacement = signal.filter.step(signal.last);
    return;
  }
  signal.window.push(signal.last);
  if (signal.ready) signal.values = signal.window.features();
}

void FeatureInputs::begin_tick() noexcept {
  source_.begin_tick();
  for (std::uint32_t input = 0; input < inputs_; ++input)
    if (feature_[input] == nullptr) reading_[input].fault = source_.read_input(input, reading_[input].value);
  for (const auto& signal : windows_in_use()) take(*signal);
}

HalFault FeatureInputs::read_input(std::uint32_t input, InputMicro& value) noexcept {
  if (input >= inputs_) return HalFault::kNoDevice;
  const Signal* const signal = feature_[input];
  if (signal == nullptr) {
    if (reading_[input].fault == HalFault::kNone) value = reading_[input].value;
    return reading_[input].fault;
  }
  if (!signal->ready) return HalFault::kNoReading;
  if (signal->from.corner_mHz != 0) {
    value = InputMicro(kMicroUmPerNm * signal->displacement.count);
    return HalFault::kNone;
  }
  const auto which = static_cast<unsigned>(which_[input]);
  if ((signal->values.undefined >> which & 1) != 0) return HalFault::kNoReading;
  value = signal->values.value[which];
  return HalFault::kNone;
}

}  // namespace vernier
