// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <initializer_list>
#include <memory>
#include <span>
#include <string_view>

#include "comp/equation.h"
#include "comp/vibration/displacement.h"
#include "comp/vibration/feature_window.h"
#include "hal/clock.h"
#include "hal/input_reader.h"

namespace vernier {

constexpr std::uint32_t kNoInput = UINT32_MAX;

/// Request for a board input that is a feature of the signal of another input.
struct FeatureRequest {
  std::uint32_t input = 0;         // the board's input that it becomes
  std::uint32_t of = 0;            // the board's input whose samples are taken
  std::uint32_t minus = kNoInput;  // another one that is taken off sample by sample
  Feature feature = Feature::kRms;
  std::uint32_t window = 1500;  // samples; even, 6..2048
  std::uint32_t every = 1;      // ticks from sample to sample
  InputMicro lsb{10};           // resolution of a sample, 1e-6 of the unit of `of`; 1..2^30
  std::uint32_t bridged = 3;    // missing samples in a row for which the last one is used
  /// If not 0, the input is the displacement (um) of an accelerometer instead of a feature of a window. Lower
  /// cut-off frequency of the displacement, mHz: rate/2^17 .. rate/64. The lsb of a sample is then lsb_nm_s2
  /// too, nm/s^2.
  std::int64_t corner_mHz = 0;
  std::int64_t lsb_nm_s2 = 98067;
};

/// Converts the name of a feature as `vernier features` writes it ("RMS") to a Feature; false if the name is
/// not known. Not real-time safe.
bool feature_of(std::string_view name, Feature& feature) noexcept;

/// The board's inputs, some of which are features and displacements. In each tick every other input is read
/// once. On a sampling tick each window receives a sample, and the features of the window are computed.
/// Features of the same signal, window and resolution share one window. A tick needs, for each window, one
/// FeatureWindow::push and one features(): 5500 instructions of x86-64 at 800 samples, 8900 at 2048
/// (tools/docs/vibration.md). Samples: round(signal / lsb), ties away from zero, exact; limited to +-524287
/// lsb and counted. A feature gives no reading (kNoReading) in three cases: the window of the feature is not
/// full; the feature is 0/0 (FeatureValues::undefined); more samples than `bridged` are missing and fewer new
/// samples have come since. No window contains a gap. A displacement has a filter
/// (comp/vibration/displacement.h, exact at 0.18 of the rate) instead of a window. The filter of a
/// displacement starts from rest, gives no reading for three periods of its corner, and starts again after a
/// gap. The displacement is that of the latest sample, to 1 nm. A tick of the displacement filter needs 200
/// instructions of x86-64.
class FeatureInputs : public InputReader {
 public:
  /// source: reads all inputs that are not features, and outlives this object. inputs: number of inputs of
  /// the board, at most kMaxInputs. tick: period of the firmware's tick. A request with an impossible window
  /// (length, resolution, an `of` that is a feature) is refused: `refused()` then names the request. Not
  /// real-time safe.
  FeatureInputs(InputReader& source, std::uint32_t inputs, std::span<const FeatureRequest> requests,
                TimeUs tick);
  FeatureInputs(InputReader& source, std::uint32_t inputs, std::initializer_list<FeatureRequest> requests,
                TimeUs tick)
      : FeatureInputs(source, inputs, std::span(requests.begin(), requests.size()), tick) {}

  /// Returns the index of the first request that cannot be served, or kNoInput. Not real-time safe.
  std::uint32_t refused() const noexcept { return refused_; }
  std::size_t windows() const noexcept { return window_count_; }
  /// Returns the number of samples so far that were beyond the range of a window or filter, and of
  /// displacements beyond +-2.1 m. Real-time safe.
  std::uint64_t held() const noexcept;

  void begin_tick() noexcept override;
  HalFault read_input(std::uint32_t input, InputMicro& value) noexcept override;

 private:
  /// The window of a signal and the sources of its samples.
  struct Signal {
    FeatureRequest from;
    std::uint64_t inverse = 0;  // 2^63 / lsb, cut
    FeatureWindow window;
    FeatureValues values;
    Displacement at_rest, filter;  // a displacement's, in place of the window
    LengthNm displacement;
    std::uint32_t full = 0;         // samples in a row that it takes to be ready
    std::uint64_t held_before = 0;  // by filters that a gap has ended
    std::uint32_t until_sample = 1, in_a_row = 0, missing = 0;
    std::int32_t last = 0;
    bool ready = false;
  };
  struct Reading {
    InputMicro value;
    HalFault fault = HalFault::kNoReading;
  };

  std::span<const std::unique_ptr<Signal>> windows_in_use() const noexcept {
    return {windows_, window_count_};
  }
  Signal* signal_of(const FeatureRequest& request, TimeUs tick);
  const SpectralWeights* weights_of(std::uint32_t window);
  bool start_window(const FeatureRequest& request, TimeUs tick, Signal& signal);
  static bool start_filter(const FeatureRequest& request, TimeUs tick, Signal& signal);
  void take(Signal& signal) noexcept;
  static void use_sample(Signal& signal) noexcept;
  bool sample_of(const Signal& signal, std::int32_t& sample) const noexcept;

  InputReader& source_;
  std::uint32_t inputs_, refused_ = kNoInput;
  // The number of entries is at most the number of features; the constructor allocates the memory.
  std::unique_ptr<SpectralWeights> weights_[kMaxInputs];
  std::unique_ptr<Signal> windows_[kMaxInputs];
  std::uint32_t weight_count_ = 0, window_count_ = 0;
  const Signal* feature_[kMaxInputs] = {};  // null: the source's own input
  Feature which_[kMaxInputs] = {};
  Reading reading_[kMaxInputs];
};

}  // namespace vernier
