// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <array>
#include <atomic>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <type_traits>

#include "comp/probing/workpiece_frame.h"
#include "firmware/core/bound_program.h"
#include "firmware/core/mode.h"
#include "tables/records.h"

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
