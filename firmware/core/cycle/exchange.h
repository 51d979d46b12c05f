// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <array>
#include <atomic>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <type_traits>

#include "comp/probing/workpiece_frame.h"
#include "firmware/core/cycle/bound_program.h"
#include "firmware/core/cycle/mode.h"
#include "tables/records.h"

namespace vernier {

/// A value that one thread writes and other threads read, word by word, without a lock. Real-time safe.
template <class T>
class AtomicWords {
  static_assert(std::is_trivially_copyable_v<T> && sizeof(T) % sizeof(std::uint32_t) == 0);
  static constexpr std::size_t kWords = sizeof(T) / sizeof(std::uint32_t);
  using Words = std::array<std::uint32_t, kWords>;

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
  std::array<std::atomic<std::uint32_t>, kWords> words_{};
};

/// A counter that one thread increases and other threads read. SharedCount needs no 64-bit atomic, which
/// small targets do not have. The writer stores the high half of the count before and after the low half. If
/// a reader sees two different high halves, it reads again (at most once in 2^32 counts).
class SharedCount {
 public:
  /// Only one thread may call store(). A reader that sees a new count also sees all earlier writes of the
  /// writer. Real-time safe.
  void store(std::uint64_t count) noexcept {
    const auto high = static_cast<std::uint32_t>(count >> 32);
    after_.store(high, std::memory_order_release);
    low_.store(static_cast<std::uint32_t>(count), std::memory_order_release);
    before_.store(high, std::memory_order_release);
  }
  std::uint64_t load() const noexcept {
    for (;;) {
      const std::uint32_t high = before_.load(std::memory_order_acquire);
      const std::uint32_t low = low_.load(std::memory_order_acquire);
      if (after_.load(std::memory_order_acquire) == high) return std::uint64_t{high} << 32 | low;
    }
  }

 private:
  std::atomic<std::uint32_t> before_{0}, low_{0}, after_{0};
};

/// The newest value of a variable with one writer and any number of readers. A reader always gets a complete
/// value. If the writer wrote during the read, the reader reads again. The writer of a Published value never
/// waits.
template <class T>
class Published {
 public:
  /// Only one thread may call publish(). Real-time safe.
  void publish(const T& value) noexcept {
    const std::uint32_t turn = turn_.load(std::memory_order_relaxed);
    turn_.store(turn + 1, std::memory_order_relaxed);
    std::atomic_thread_fence(std::memory_order_release);
    value_.put(value);
    turn_.store(turn + 2, std::memory_order_release);
  }
  /// Reads the newest value. Returns false if the writer changed the value during each of `tries` attempts.
  /// Not real-time safe.
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

/// Stores the last values of one writer. A reader requests a value by its number. The reader receives the
/// value, or the information that a newer value has overwritten it. The writer of a History never waits and
/// never fails: values that were not read in time are overwritten, and readers detect this.
template <class T>
class History {
 public:
  /// `size`: number of stored values, a power of two. Not real-time safe.
  explicit History(std::uint32_t size) : size_(size), values_(new AtomicWords<T>[size]) {}

  /// Only one thread may call add(). Real-time safe.
  void add(const T& value) noexcept {
    const std::uint64_t next = count_.load();
    begun_.store(next + 1);
    std::atomic_thread_fence(std::memory_order_release);
    values_[static_cast<std::uint32_t>(next) & (size_ - 1)].put(value);
    count_.store(next + 1);
  }
  /// Returns the number of values that were added. Value i can be read while i < count() <= i + size().
  std::uint64_t count() const noexcept { return count_.load(); }
  std::uint32_t size() const noexcept { return size_; }
  /// Returns the number of the oldest value that can still be read.
  std::uint64_t oldest() const noexcept {
    const std::uint64_t count = begun_.load();
    return count > size_ ? count - size_ : 0;
  }
  /// Reads the value with number `index`. Returns false if the value `index` was not yet written or
  /// is already overwritten. Not real-time safe.
  bool read(std::uint64_t index, T& value) const noexcept {
    if (index >= count()) return false;
    const T copy = values_[static_cast<std::uint32_t>(index) & (size_ - 1)].get();
    std::atomic_thread_fence(std::memory_order_acquire);
    if (begun_.load() > index + size_) return false;
    value = copy;
    return true;
  }

 private:
  SharedCount begun_, count_;
  std::uint32_t size_;
  std::unique_ptr<AtomicWords<T>[]> values_;
};

/// Start values of the error equation in one tick. Other threads compute the share of each effect
/// from these values.
struct EquationRecord {
  std::uint32_t programs = 0, reserved = 0;  // programs: HealthRecord::programs of the program to which this
                                             // state belongs
  EquationState state;
};

/// All data that the tick exchanges with the other threads of the daemon. Exchange has no locks: the tick
/// never waits for another thread.
struct Exchange {
  static constexpr std::uint32_t kHistory = 4096;  // number of stored ticks, about four seconds
  static constexpr std::uint32_t kTouches = 256;

  Published<HealthRecord> health;
  Published<StateRecord> state;
  Published<EquationRecord> equation;  // published ten times a second
  History<TickRecord> ticks;
  History<TouchRecord> touches;
  Published<WorkpieceFrame> workpiece;           // written by the thread of the links
  std::atomic<Command> command{Command::kNone};  // executed by the tick
  std::atomic<std::int32_t> axis_weight[kMaxAxes];
  // Operator settings in the form of the store (OperatorState): bit 0 deactivated, bit 8 holding, from bit 16
  // the latched fault.
  std::atomic<std::uint32_t> operator_said{0};
  std::atomic<std::uint32_t> setting_flags{0};  // SettingFlag, written by the thread of the store
  std::atomic<BoundProgram*> offered{nullptr};  // program that the next tick starts to use
  std::atomic<BoundProgram*> retired{nullptr};  // program that the tick no longer uses; its owner may free it

  /// `ticks_kept`, `touches_kept`: numbers of ticks and touches that the Exchange stores, powers of two. The
  /// constructor allocates all memory. Not real-time safe.
  explicit Exchange(std::uint32_t ticks_kept = kHistory, std::uint32_t touches_kept = kTouches)
      : ticks(ticks_kept), touches(touches_kept) {
    for (auto& weight : axis_weight) weight.store(kFullWeight.count);
    workpiece.publish({});
  }
};

}  // namespace vernier
