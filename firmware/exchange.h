// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <array>
#include <atomic>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <type_traits>

#include "comp/workpiece_frame.h"
#include "firmware/bound_program.h"
#include "firmware/mode.h"

namespace vernier {

/// A value that one thread writes and others copy, word by word, without a lock. realtime.
template <class T>
class AtomicWords {
  static_assert(std::is_trivially_copyable_v<T> && sizeof(T) % sizeof(std::uint64_t) == 0);
  static constexpr std::size_t kWords = sizeof(T) / sizeof(std::uint64_t);
  using Words = std::array<std::uint64_t, kWords>;

 public:
  void put(const T& value) noexcept {
    const auto words = std::bit_cast<Words>(value);
    for (std::size_t i = 0; i < kWords; ++i) words_[i].store(words[i], std::memory_order_relaxed);
  }
  T get() const noexcept {
    Words words;
    for (std::size_t i = 0; i < kWords; ++i) words[i] = words_[i].load(std::memory_order_relaxed);
    return std::bit_cast<T>(words);
  }

 private:
  std::array<std::atomic<std::uint64_t>, kWords> words_{};
};

/// The newest value of one writer, whole: a reader that was overtaken reads again. The writer never waits.
template <class T>
class Published {
 public:
  /// One writer. realtime.
  void publish(const T& value) noexcept {
    const std::uint32_t turn = turn_.load(std::memory_order_relaxed);
    turn_.store(turn + 1, std::memory_order_relaxed);
    std::atomic_thread_fence(std::memory_order_release);
    value_.put(value);
    turn_.store(turn + 2, std::memory_order_release);
  }
  /// False where the writer was quicker so many times in a row. setup.
  bool read(T& value, int tries = 1000) const noexcept {
    for (int i = 0; i < tries; ++i) {
      const std::uint32_t before = turn_.load(std::memory_order_acquire);
      if ((before & 1) != 0) continue;
      const T copy = value_.get();
      std::atomic_thread_fence(std::memory_order_acquire);
      if (turn_.load(std::memory_order_relaxed) != before) continue;
      value = copy;
      return true;
    }
    return false;
  }

 private:
  std::atomic<std::uint32_t> turn_{0};
  AtomicWords<T> value_;
};

/// The last values of one writer; a reader names the value that it wants and learns whether it is still
/// there. The writer never waits and never fails: what nobody read in time is overwritten, and readers know
/// it.
template <class T, std::size_t kSize>
class History {
  static_assert(std::has_single_bit(kSize));

 public:
  /// One writer. realtime.
  void add(const T& value) noexcept {
    const std::uint64_t next = count_.load(std::memory_order_relaxed);
    begun_.store(next + 1, std::memory_order_relaxed);
    std::atomic_thread_fence(std::memory_order_release);
    values_[next % kSize].put(value);
    count_.store(next + 1, std::memory_order_release);
  }
  /// Values added so far; value i can be read while i < count() <= i + kSize.
  std::uint64_t count() const noexcept { return count_.load(std::memory_order_acquire); }
  /// Oldest value that is still there.
  std::uint64_t oldest() const noexcept {
    const std::uint64_t count = begun_.load(std::memory_order_acquire);
    return count > kSize ? count - kSize : 0;
  }
  /// False where value `index` is not there yet, or not any more. setup.
  bool read(std::uint64_t index, T& value) const noexcept {
    if (index >= count()) return false;
    const T copy = values_[index % kSize].get();
    std::atomic_thread_fence(std::memory_order_acquire);
    if (begun_.load(std::memory_order_relaxed) > index + kSize) return false;
    value = copy;
    return true;
  }

 private:
  std::atomic<std::uint64_t> begun_{0}, count_{0};
  std::array<AtomicWords<T>, kSize> values_;
};

/// A tick as others see it. Axes and inputs in the board's order, in their counts.
struct TickRecord {
  std::int64_t time_us = 0;
  std::int64_t position[kMaxAxes] = {};
  std::int32_t correction[kMaxAxes] = {};
  std::int64_t input[kMaxInputs] = {};
  std::int64_t feed_nm_per_min = 0;
  std::int8_t sense[kMaxAxes] = {};
  std::uint8_t mode = 0, fault = 0, holding = 0, reserved[5] = {};
};
static_assert(sizeof(TickRecord) % 8 == 0);

/// What is counted and measured, as others see it.
struct HealthRecord {
  std::uint64_t ticks = 0, active_ticks = 0, overruns = 0, skipped = 0;
  std::uint64_t missing_readings = 0, missing_inputs = 0, frozen_readings = 0, jumps = 0;
  std::uint64_t unreferenced = 0, implausible = 0, failed_writes = 0;
  std::uint64_t saturated = 0, slewing = 0, beyond_range = 0;
  std::uint64_t faults = 0, refused_commands = 0, programs = 0;
  // p50, p99, p99.9, maximum of the wake-up latency and of a tick's execution, ns
  std::int64_t latency_ns[4] = {}, execution_ns[4] = {};
};
// Counter n of LinkOp::kHealth is word n.
static_assert(sizeof(HealthRecord) == 200);
static_assert(offsetof(HealthRecord, ticks) == 0 && offsetof(HealthRecord, active_ticks) == 8 &&
              offsetof(HealthRecord, overruns) == 16 && offsetof(HealthRecord, skipped) == 24 &&
              offsetof(HealthRecord, missing_readings) == 32 &&
              offsetof(HealthRecord, missing_inputs) == 40 && offsetof(HealthRecord, frozen_readings) == 48 &&
              offsetof(HealthRecord, jumps) == 56 && offsetof(HealthRecord, unreferenced) == 64 &&
              offsetof(HealthRecord, implausible) == 72 && offsetof(HealthRecord, failed_writes) == 80 &&
              offsetof(HealthRecord, saturated) == 88 && offsetof(HealthRecord, slewing) == 96 &&
              offsetof(HealthRecord, beyond_range) == 104 && offsetof(HealthRecord, faults) == 112 &&
              offsetof(HealthRecord, refused_commands) == 120 && offsetof(HealthRecord, programs) == 128 &&
              offsetof(HealthRecord, latency_ns) == 136 && offsetof(HealthRecord, execution_ns) == 168);

/// What each effect adds to the corrections, as others see it.
struct ShareRecord {
  std::uint64_t programs = 0;  // HealthRecord::programs when it was taken: which program's shares these are
  std::uint32_t count = 0, reserved = 0;
  std::int32_t correction[kMaxShares] = {};  // counts of the share's axis
};
static_assert(sizeof(ShareRecord) % 8 == 0);

/// What is to be known about a touch.
enum TouchFlag : std::uint8_t {
  kTouchUncompensated = 1u << 0,  // no program ran: `compensated` is `position`
  kTouchWhileFaulted = 1u << 1,   // a fault was latched
  kTouchInWorkpiece = 1u << 2,    // the board has axes X, Y, Z: `workpiece_nm` is there
};

/// A touch of the probe as others see it. Axes in the board's order, in their counts. The counters say what
/// was lost until then, so that a reader knows whether touches are missing that never got a number.
struct TouchRecord {
  std::int64_t time_ns = 0;              // of the contact, the machine file's t
  std::int64_t position[kMaxAxes] = {};  // as the controller counts
  std::int64_t compensated[kMaxAxes] =
      {};  // where the axis would stand if its correction were all in: the tool
  std::int64_t uncertainty[kMaxAxes] =
      {};                             // standard uncertainty from the instant and from the interpolation
  std::int64_t workpiece_nm[3] = {};  // X, Y, Z
  std::uint32_t lost_edges = 0, lost_touches = 0, spikes = 0, missing = 0;
  std::uint8_t kind = 0, fault = 0, flags = 0, bounces = 0;  // TouchKind, LatchFault, TouchFlag
  std::uint8_t reserved[4] = {};
};
static_assert(sizeof(TouchRecord) % 8 == 0);

/// All that passes between the tick and the rest of the daemon. No locks: the tick never waits for anybody.
struct Exchange {
  static constexpr std::size_t kHistory = 4096;  // ticks, about four seconds
  static constexpr std::size_t kTouches = 256;

  Published<HealthRecord> health;
  Published<ShareRecord> shares;
  History<TickRecord, kHistory> ticks;
  History<TouchRecord, kTouches> touches;
  Published<WorkpieceFrame> workpiece;           // written by the links
  std::atomic<Command> command{Command::kNone};  // taken by the tick
  std::atomic<std::int32_t> axis_weight[kMaxAxes];
  std::atomic<BoundProgram*> offered{nullptr};  // to be taken over by the next tick
  std::atomic<BoundProgram*> retired{nullptr};  // was taken out; the owner may free it

  Exchange() {
    for (auto& weight : axis_weight) weight.store(kFullWeight.count);
    workpiece.publish({});
  }
};

}  // namespace vernier
