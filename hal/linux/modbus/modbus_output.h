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

/// Block of registers in a controller (PLC) that receives corrections. The block begins at `address`:
/// sequence number, valid bits (bit p for value p), and then two registers for each value. A value is a
/// signed 32-bit number, high word first.
struct ModbusOutputSettings {
  static constexpr int kSequence = RegisterBlock::kSequence, kValid = RegisterBlock::kValid,
                       kValues = RegisterBlock::kValues, kPlaces = RegisterBlock::kPlaces;

  static constexpr int kLongestPeriod_ms = 50;

  struct Axis {
    AnalogueScale scale;                     // the register contains code - scale.zero
    int place = 0;                           // place of the axis in the block, 0 to kPlaces - 1
    std::int64_t most_per_tick = INT32_MAX;  // largest change of the correction in one tick, counts
  };
  int unit = 1, address = 0;
  int echo = 0;             // echo: register to which the controller copies the last sequence number that it
                            // has used
  TimeUs period{5'000};     // time from one exchange to the next
  TimeUs timeout{100'000};  // longest permitted time without an echo, and without a tick
  TimeUs tick{1'000};
  std::vector<Axis> axes;
};

/// Writes the corrections of several axes to registers of a controller. A separate thread writes the block
/// and reads the echo. A tick only stores its value and never waits. If no new sequence number is returned
/// within `timeout`, the thread clears the valid bits, and all writes are refused. The valid bit of an axis
/// is set again when the board's own correction of the axis is zero. A restored connection therefore causes
/// no step of the correction. The same rule applies if a controller was restarted within the time-out and has
/// lost the block, or if the process was stopped for longer than the time-out. A value that an earlier
/// process left in the block stays there without its valid bit, until writes of this process move the value
/// to zero. Only one board may write a block. An echo that is not one of the last sequence numbers is a loss:
/// another board writes the block, or the controller was restarted. After a loss, the thread writes nothing
/// until the sequence number has not changed for the time that another board may need for a block.
class ModbusOutput : public OutputDevice {
 public:
  /// Returns the longest time for an answer, which the Modbus line must use. After a missing answer, a
  /// serial line is not used for a pause as long as the wait for the answer. The wait and the pause after a
  /// missing answer are together half of the time-out, so that one missing answer is not a loss of the
  /// controller.
  static TimeUs wait_for_answer(TimeUs timeout, bool serial) {
    return TimeUs(timeout.count / (serial ? 4 : 2));
  }
  /// `line`: a Modbus line that only this output uses. Returns null, and the reason in `error`, if the
  /// controller does not answer, does not return the sequence number, or is written by another board. open()
  /// waits for the controller. Not real-time safe.
  static std::unique_ptr<ModbusOutput> open(std::shared_ptr<ModbusLine> line,
                                            const ModbusOutputSettings& settings, std::string& error);
  /// The destructor clears the valid bits. If writes have moved the value of an earlier process to zero, the
  /// destructor waits until the controller has received the zero, for at most the time-out.
  ~ModbusOutput() override;
  ModbusOutput(const ModbusOutput&) = delete;
  ModbusOutput& operator=(const ModbusOutput&) = delete;

  /// The function write_correction() returns kRefused if the controller does not return the sequence number,
  /// or if a correction increases whose valid bit is not set. Real-time safe.
  HalFault write_correction(std::uint32_t axis, AxisTravel correction) noexcept override;
  AxisTravel within_range(std::uint32_t axis, AxisTravel correction) const noexcept override;

  /// Always returns true, because open() has already tested that no other device changes the
  /// sequence number of the block.
  bool lock() noexcept override { return true; }
  /// Returns, before the first write, the value that the block had at open(), limited to the range of the
  /// axis.
  HalFault read_back(std::uint32_t axis, AxisTravel& correction) noexcept override;
  std::string attempt(std::uint32_t axis) override;
  std::string trial() const override;
  std::uint64_t held_at_end(std::uint32_t axis) const noexcept override { return places_[axis].held_at_end; }
  const AnalogueScale& scale(std::uint32_t axis) const noexcept override {
    return settings_.axes[axis].scale;
  }
  /// Returns statistics: number of exchanges and losses, and the delay from the tick of a correction to the
  /// answer to its write.
  std::string account() const override;

 private:
  using Clock = std::chrono::steady_clock;
  /// State of the output of one axis. The tick writes `wanted`. The thread writes `valid` and `refuse`; the
  /// tick clears `refuse`.
  struct Place {
    std::atomic<std::int32_t> wanted{0};  // number for the register
    std::atomic<bool> valid{false}, refuse{false};
    std::int32_t sent = 0;
    /// True if `sent` began at a value of an earlier process and is not yet zero. The writing
    /// thread clears the flag left_over.
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
  std::array<Place, ModbusOutputSettings::kPlaces> places_;  // one entry for each axis
  std::atomic<bool> healthy_{false}, stop_{false};
  std::atomic<std::int64_t> stored_ns_{INT64_MIN};  // time at which a tick stored its value
  std::uint16_t sequence_ = 0;
  std::uint16_t kept_ = 0;  // sequence number of the last block that the controller certainly received
  /// Sequence number that the block had before this board wrote its first block; no value after this write.
  std::optional<std::uint16_t> found_;
  bool repeat_ = false;      // true: the controller has either the last block or the previous block
  bool unanswered_ = false;  // true: the last exchange was not answered
  /// Number of writes without an answer whose block the controller may still receive late.
  std::uint64_t unanswered_writes_ = 0;
  Clock::time_point good_, written_;
  std::optional<Clock::time_point> still_since_;  // time since which found_ has not changed; nothing is
                                                  // written during this time
  /// Time of each block, by the low byte of its sequence number
  std::array<Clock::time_point, 256> sent_at_{};

  mutable std::mutex guard_;  // protects the following statistics
  std::uint64_t exchanges_ = 0, failed_ = 0, losses_ = 0, foreign_ = 0;
  std::vector<std::uint64_t> delays_;  // number of delays in each bin of 0.1 ms
  std::int64_t delayed_ = INT64_MIN;   // last tick whose delay was counted
  std::thread thread_;
};

}  // namespace vernier
