// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstddef>
#include <cstdint>

#include "comp/equation.h"
#include "comp/quantity.h"
#include "comp/slew_limit.h"

namespace vernier {

/// Motion of one axis in its count (nm, or 2^-32 turn).
struct AxisInput {
  AxisPosition position;
  AxisSpeed velocity;
  AxisAcceleration acceleration;
  AxisTravel since{INT64_MAX};  // travel since the last reversal; a long way where unknown
  std::int8_t sense = 0;        // -1, 0, +1: direction of the last motion
};

/// Values of one tick that the error equation may use. The indices are those of the axes and inputs in the
/// image.
struct CycleInput {
  AxisInput axis[kMaxAxes];
  InputMicro input[kMaxInputs];
  FeedNmPerMin feed;
  CurvatureNanoPerMm curvature;
  TimeUs time;  // since start
  VisitCount visit;
};

/// Source of a channel in the CycleInput.
enum class ChannelKind : std::uint8_t {
  kPosition = 0,
  kVelocity = 1,
  kAcceleration = 2,
  kSense = 3,
  kSince = 4,
  kInput = 5,
  kFeed = 6,
  kCurvature = 7,
  kTime = 8,
  kVisit = 9,
};
constexpr std::uint8_t kChannelKindCount = static_cast<std::uint8_t>(ChannelKind::kVisit) + 1;

/// Converts one quantity of the CycleInput to the program's format: limit to [low, high], then
/// round(round(value / 2^pre_shift) * multiplier / 2^shift). 32 bytes, as in the correction image.
struct Channel {
  ChannelKind kind;
  std::uint8_t index;       // axis or input
  std::uint8_t pre_shift;   // 0..40: brings the limits into int32
  std::uint8_t shift;       // 0..61
  std::int32_t multiplier;  // > 0
  std::int64_t low, high;   // in the quantity's own count
  std::int64_t
      wrap;  // 0, or one period: a value beyond the limits comes back by whole turns (a power of two)
};
static_assert(sizeof(Channel) == 32);
static_assert(offsetof(Channel, kind) == 0 && offsetof(Channel, index) == 1 &&
              offsetof(Channel, pre_shift) == 2 && offsetof(Channel, shift) == 3 &&
              offsetof(Channel, multiplier) == 4 && offsetof(Channel, low) == 8 &&
              offsetof(Channel, high) == 16 && offsetof(Channel, wrap) == 24);

/// Converts one result of the equation to the deviation of an axis: round(register * multiplier / 2^shift) in
/// axis counts.
struct Output {
  std::uint16_t axis;
  std::uint16_t source;  // register
  std::uint32_t shift;   // 0..61
  std::int32_t multiplier;
  std::int32_t limit;  // largest |correction|, axis counts
  std::int32_t slew;   // largest change a tick, axis counts
};
static_assert(sizeof(Output) == 20);
static_assert(offsetof(Output, axis) == 0 && offsetof(Output, source) == 2 && offsetof(Output, shift) == 4 &&
              offsetof(Output, multiplier) == 8 && offsetof(Output, limit) == 12 &&
              offsetof(Output, slew) == 16);

/// The whole program of a machine, non-owning.
struct Program {
  Equation equation;
  View<Channel> channels;
  View<Output> outputs;
  std::uint32_t axis_count = 0;
  std::uint32_t input_count = 0;
};

/// Deviation: actual minus nominal along an axis. Correction: the value that is added to the command of the
/// axis. Axis counts. Deviation and Correction are separate types, so that the compiler finds a mix of their
/// signs.
struct Deviation {
  std::int32_t counts = 0;
};
struct Correction {
  std::int32_t counts = 0;
};
/// The only place that converts a deviation to a correction. -INT32_MIN becomes INT32_MAX. Real-time safe.
constexpr Correction correction_for(Deviation deviation) noexcept {
  return Correction{deviation.counts == INT32_MIN ? INT32_MAX : -deviation.counts};
}
/// The correction of a linear axis as a length.
constexpr LengthNm length_of(Correction correction) { return LengthNm(correction.counts); }

/// Flags for the limits that act on the corrections in this tick. A flag is reported in each tick in which
/// its limit acts; a flag is never latched.
enum CycleFlag : std::uint32_t {
  kBeyondRange = 1u << 0,  // a channel outside its declared range: its edge was held
  kSaturated = 1u << 1,    // a correction at its limit
  kSlewing = 1u << 2,      // a correction still on its way
};

struct CycleOutput {
  Correction correction[kMaxAxes];    // 0 for axes that are not corrected
  Correction wanted[kMaxAxes];        // the same at full weight and before the slew limit
  std::uint32_t flags = 0;            // CycleFlag
  std::uint32_t beyond_channels = 0;  // number of channels beyond their range
};

/// Returns the value of an input of the tick, limited to the range of its channel, in the format of the
/// program. The result is monotone, so the limits give the range. Real-time safe.
std::int32_t channel_value(const Channel& channel, std::int64_t value) noexcept;

struct ShareProgram;

/// Start values of a tick, with which the tick can be executed again elsewhere.
struct EquationState {
  static constexpr std::uint32_t kMostChannels = 256;  // of a program whose shares can be shown
  std::uint32_t channel_count = 0, starting = 0;
  std::int32_t channel[kMostChannels] = {};
  LagState lag[kMaxLags] = {};
};

/// The printed form of a program (`vernier compile`, equation.cpp): computes the deviations of the outputs
/// from the channels, in the order and formats of the program. Real-time safe.
using PrintedEquation = void (*)(const std::int32_t* channel, LagState* lag, bool starting,
                                 std::int32_t* deviation) noexcept;

/// One tick of compensation: equation, magnitude limit, ramp weight, slew limit. Owns the registers, lags and
/// slew state. The program must have been verified and must outlive the compensator.
class Compensator {
 public:
  /// Starts with registers, lags and correction 0. Not real-time safe.
  explicit Compensator(const Program& program) noexcept;

  /// Returns the correction of this tick. Call step() once per tick: the slew limit and the lags count ticks.
  /// weight: 0..kFullWeight, the fraction of the correction that is applied (ramp-in, ramp-out). step() never
  /// fails. Real-time safe.
  CycleOutput step(const CycleInput& input, WeightQ16 weight = kFullWeight) noexcept;

  /// Starts the slew limit of an axis from the correction that its drive already has. With this start value,
  /// a change of the program causes no step of the correction. Not real-time safe.
  void start_from(std::uint32_t axis, Correction held) noexcept { slew_[axis].start_from(held.counts); }

  /// Resets the lags and the slew state: the next step starts from zero correction. Not real-time safe.
  void reset() noexcept;

  /// The channels and lags at the start of the last step; empty for a program with more channels than fit.
  /// Copies only existing channels and lags. Real-time safe.
  void state(EquationState& state) const noexcept;

  /// Makes step() call compiled C++ code (`equation`) in place of the interpreter of the program. `vernier
  /// compile` wrote this code from the same program. The corrections are identical to the last bit, and the
  /// code needs a sixth to a third of the instructions. Not real-time safe.
  void use_printed(PrintedEquation equation) noexcept { printed_ = equation; }
  bool printed() const noexcept { return printed_ != nullptr; }

  /// Register i after the last step, for tests and for watching intermediates. Not real-time safe.
  std::int32_t register_value(std::uint32_t i) const noexcept { return registers_[i]; }

 private:
  void read_channels(const CycleInput& input, CycleOutput& output) noexcept;
  void run_printed() noexcept;

  Program program_;
  PrintedEquation printed_ = nullptr;
  std::int32_t registers_[kMaxRegisters] = {};
  LagState lags_[kMaxLags] = {};
  LagState lags_before_[kMaxLags] = {};  // of the tick
  bool started_now_ = false;
  SlewLimit slew_[kMaxAxes];
  bool starting_ = true;
};

}  // namespace vernier
