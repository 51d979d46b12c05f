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

/// Request for an input of the board that is a feature (for example RMS) of the signal of another input.
struct FeatureRequest {
  std::uint32_t input = 0;         // index of the board's input that receives the feature
  std::uint32_t of = 0;            // index of the board's input whose samples are used
  std::uint32_t minus = kNoInput;  // index of an input that is subtracted sample by sample
  Feature feature = Feature::kRms;
  std::uint32_t window = 1500;  // number of samples; even, 6..2048
  std::uint32_t every = 1;      // number of ticks between two samples
  InputMicro lsb{10};           // resolution of a sample, 1e-6 of the unit of the input `of`; 1..2^30
  std::uint32_t bridged = 3;    // number of successive missing samples that are replaced by the last sample
  /// If not 0, the input is the displacement (um) of an accelerometer instead of a feature. Value: lower
  /// cut-off frequency of the displacement, mHz, from rate/2^17 to rate/64. The resolution of a sample is
  /// then also lsb_nm_s2, nm/s^2.
  std::int64_t corner_mHz = 0;
  std::int64_t lsb_nm_s2 = 98067;
};

/// Converts the name of a feature in `vernier features` ("RMS") to a Feature. Returns false if the name is
/// unknown. Not real-time safe.
bool feature_of(std::string_view name, Feature& feature) noexcept;

/// The inputs of a board. Some of these inputs are features or displacements that are computed from other
/// inputs. In each tick, every input that is not computed is read once. On a sampling tick, each window
/// receives one sample, and the features of the window are computed. Features of the same signal, window and
/// resolution share one window. For each window, a tick needs one FeatureWindow::push and one features():
/// 5500 instructions of x86-64 at 800 samples, 8900 at 2048 (tools/docs/vibration.md). A sample is
/// round(signal / lsb), exact, with ties away from zero. Samples beyond +-524287 lsb are limited and counted.
/// A feature gives no reading (kNoReading) in three cases: its window is not full; the feature is 0/0
/// (FeatureValues::undefined); or more than `bridged` successive samples were missing and the window is not
/// yet full again. A window never contains a gap in the samples. A displacement uses a filter
/// (comp/vibration/displacement.h, exact at 0.18 of the rate) instead of a window. The filter of a
/// displacement starts at rest and gives no reading for three periods of its corner frequency.
/// After a gap in the samples, the filter of a displacement starts again. The displacement is that
/// of the latest sample, with a resolution of 1 nm. In each tick the displacement filter needs 200
/// instructions of x86-64.
class FeatureInputs : public InputReader {
 public:
  /// `source`: reads all inputs that are not features; it must exist longer than this object. `inputs`:
  /// number of inputs of the board, at most kMaxInputs. `tick`: duration of a tick of the firmware. A request
  /// that cannot be executed (length, resolution, an `of` that is a feature) is refused. After a
  /// refusal, the function refused() returns the index of the request. Not real-time safe.
  FeatureInputs(InputReader& source, std::uint32_t inputs, std::span<const FeatureRequest> requests,
                TimeUs tick);
  FeatureInputs(InputReader& source, std::uint32_t inputs, std::initializer_list<FeatureRequest> requests,
                TimeUs tick)
      : FeatureInputs(source, inputs, std::span(requests.begin(), requests.size()), tick) {}

  /// Returns the index of the first request that cannot be executed; kNoInput if there is no such request.
  /// Not real-time safe.
  std::uint32_t refused() const noexcept { return refused_; }
  std::size_t windows() const noexcept { return window_count_; }
  /// Returns the number of samples that were beyond the range of a window or filter, plus the number of
  /// displacements beyond +-2.1 m, since the start. Real-time safe.
  std::uint64_t held() const noexcept;

  void begin_tick() noexcept override;
  HalFault read_input(std::uint32_t input, InputMicro& value) noexcept override;

 private:
  /// The window (or filter) of a signal, and the source of its samples.
  struct Signal {
    FeatureRequest from;
    std::uint64_t inverse = 0;  // 2^63 / lsb, without the fraction
    FeatureWindow window;
    FeatureValues values;
    Displacement at_rest, filter;  // filter for a displacement, used instead of the window
    LengthNm displacement;
    std::uint32_t full = 0;         // number of successive samples that are necessary before the signal is
                                    // ready
    std::uint64_t held_before = 0;  // number of limited samples in filters that a gap has ended
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
  // The number of windows is at most the number of features. The constructor allocates the memory.
  std::unique_ptr<SpectralWeights> weights_[kMaxInputs];
  std::unique_ptr<Signal> windows_[kMaxInputs];
  std::uint32_t weight_count_ = 0, window_count_ = 0;
  const Signal* feature_[kMaxInputs] = {};  // null: the input is read from the source
  Feature which_[kMaxInputs] = {};
  Reading reading_[kMaxInputs];
};

}  // namespace vernier
