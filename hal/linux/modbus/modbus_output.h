// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <array>
#include <atomic>
#include <chrono>
#include <cstdint>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <thread>
#include <vector>

#include "hal/linux/modbus/modbus_input.h"
#include "hal/linux/output_device.h"
#include "hal/support/register_block.h"

namespace vernier {

/// Registers of a controller (PLC) that take corrections. The block begins at `address`: sequence number,
/// valid bits (bit p: place p), then two registers for each place, a signed 32-bit number, high word first.
struct ModbusOutputSettings {
  static constexpr int kSequence = RegisterBlock::kSequence, kValid = RegisterBlock::kValid,
                       kValues = RegisterBlock::kValues, kPlaces = RegisterBlock::kPlaces;

  static constexpr int kLongestPeriod_ms = 50;

  struct Axis {
    AnalogueScale scale;                     // the register holds code - scale.zero
    int place = 0;                           // 0 .. kPlaces - 1
    std::int64_t most_per_tick = INT32_MAX;  // largest change of the correction in a tick, counts
  };
  int unit = 1, address = 0;
  int echo = 0;             // register to which the controller copies the sequence number that it has used
  TimeUs period{5'000};     // from one exchange to the next
  TimeUs timeout{100'000};  // longest time without an echo, and without a tick
  TimeUs tick{1'000};
  std::vector<Axis> axes;
};

/// Corrections of several axes as registers of a controller. A separate thread writes the block and reads the
/// echo; a tick only leaves its value and never waits. If no new sequence number comes back in `timeout`, the
/// thread clears the valid bits and all writes are refused. The valid bit of an axis is set again when the
/// board's own correction of the axis is zero: the return of a connection causes no step. So it is if a
/// controller was restarted within the time-out and has lost the block, and if the process stood still for
/// longer than the time-out. A value that an earlier process left in the block stays there without its valid
/// bit, until writes move it to zero.
/// Only one board writes a block. An echo that is none of the last sequence numbers is a loss: another board
/// writes, or the controller was restarted. After a loss the thread writes nothing until the sequence number
/// has stood still for as long as another board may need for a block.
class ModbusOutput : public OutputDevice {
 public:
  /// Longest time for an answer, as the lines of `settings` must have it. A serial line is quiet for as long
  /// again after an answer that did not come: both together are half of the time-out, so that one lost answer
  /// is no loss of the controller.
  static TimeUs wait_for_answer(TimeUs timeout, bool serial) {
    return TimeUs(timeout.count / (serial ? 4 : 2));
  }
  /// line: used by this output only. Returns null with `error` set if the controller does not answer, does
  /// not return the sequence number, or is written by another board. Waits for the controller.
  /// Not real-time safe.
  static std::unique_ptr<ModbusOutput> open(std::shared_ptr<ModbusLine> line,
                                            const ModbusOutputSettings& settings, std::string& error);
  /// Clears the valid bits. If writes have moved the value of an earlier process to zero, waits until the
  /// controller has the zero, at most the time-out.
  ~ModbusOutput() override;
  ModbusOutput(const ModbusOutput&) = delete;
  ModbusOutput& operator=(const ModbusOutput&) = delete;

  /// kRefused: the controller does not return the sequence number; or a correction grows whose valid bit is
  /// not set. Real-time safe.
  HalFault write_correction(std::uint32_t axis, AxisTravel correction) noexcept override;
  AxisTravel within_range(std::uint32_t axis, AxisTravel correction) const noexcept override;

  /// open() has found that nothing else changes the sequence number.
  bool lock() noexcept override { return true; }
  /// Before the first write: the value that the block had at open(), at most the range of the axis.
  HalFault read_back(std::uint32_t axis, AxisTravel& correction) noexcept override;
  std::string attempt(std::uint32_t axis) override;
  std::string trial() const override;
  std::uint64_t held_at_end(std::uint32_t axis) const noexcept override { return places_[axis].held_at_end; }
  const AnalogueScale& scale(std::uint32_t axis) const noexcept override {
    return settings_.axes[axis].scale;
  }
  /// Exchanges, losses, and the delay from the tick of a correction to the answer to its write.
  std::string account() const override;

 private:
  using Clock = std::chrono::steady_clock;
  /// State of one axis. The tick writes `wanted`; the thread writes `valid` and `refuse`, which the tick
  /// clears.
  struct Place {
    std::atomic<std::int32_t> wanted{0};  // register's number
    std::atomic<bool> valid{false}, refuse{false};
    std::int32_t sent = 0;
    /// `sent` began at a value of an earlier process, and is not at zero yet. The thread clears it.
    std::atomic<bool> left_over{false};
    std::int64_t most_per_period = 1;
    std::uint64_t held_at_end = 0;
  };

  ModbusOutput(std::shared_ptr<ModbusLine> line, const ModbusOutputSettings& settings);
  std::string begin();
  bool take_left_overs();
  int registers() const;
  void run();
  bool write_block(Clock::time_point began);
  void exchange(bool last = false);
  void lose_controller();
  bool may_write(Clock::time_point began, bool ticks_are_on);
  void choose_values(Clock::time_point now, bool ticks_are_on);
  bool echo_is_new(std::uint16_t echo, Clock::time_point now) const;
  void judge(bool answered, std::uint16_t echo, Clock::time_point now, bool ticks_are_on);
  void lose();
  bool ticks_run(Clock::time_point now) const;

  const std::shared_ptr<ModbusLine> line_;
  const ModbusOutputSettings settings_;
  std::vector<AnalogueConverter> converters_;
  std::array<Place, ModbusOutputSettings::kPlaces> places_;  // by axis
  std::atomic<bool> healthy_{false}, stop_{false};
  std::atomic<std::int64_t> stored_ns_{INT64_MIN};  // when a tick left its value
  std::uint16_t sequence_ = 0;
  std::uint16_t kept_ = 0;  // of the last block that the controller surely took
  /// The number that the block had when this board was about to write its first block, until it has.
  std::optional<std::uint16_t> found_;
  bool repeat_ = false;      // the controller may have the last block or the one before
  bool unanswered_ = false;  // the last exchange
  Clock::time_point good_, written_;
  std::optional<Clock::time_point> still_since_;  // found_ stands still; nothing is written meanwhile
  std::array<Clock::time_point, 256> sent_at_{};  // by the low byte of the sequence number

  mutable std::mutex guard_;  // of the figures below
  std::uint64_t exchanges_ = 0, failed_ = 0, losses_ = 0, foreign_ = 0;
  std::vector<std::uint64_t> delays_;  // in tenths of a millisecond
  std::int64_t delayed_ = INT64_MIN;   // tick whose delay was counted last
  std::thread thread_;
};

}  // namespace vernier
