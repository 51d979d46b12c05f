// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstddef>
#include <cstdint>

#include "comp/dense.h"
#include "comp/equation.h"
#include "comp/quantity.h"
#include "comp/slew_limit.h"

namespace vernier {

/// Motion of one axis in counts of the axis (nm, or 2^-32 turn).
struct AxisInput {
  AxisPosition position;
  AxisSpeed velocity;
  AxisAcceleration acceleration;
  AxisTravel since{INT64_MAX};  // travel since the last reversal; a very large value if it is unknown
  std::int8_t sense = 0;        // direction of the last motion: -1, 0, +1
};

/// Values of one tick that the error equation may use. The indices of axes and inputs are those of the
/// correction image.
struct CycleInput {
  AxisInput axis[kMaxAxes];
  InputMicro input[kMaxInputs];
  FeedNmPerMin feed;
  CurvatureNanoPerMm curvature;
  TimeUs time;  // time since the start
  VisitCount visit;
};

/// Quantity of the CycleInput from which a channel gets its value.
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

/// Converts one quantity of the CycleInput to the number format of the program. The value is limited to [low,
/// high]; then the result is round(round(value / 2^pre_shift) * multiplier / 2^shift). A Channel has 32
/// bytes, as in the correction image.
struct Channel {
  ChannelKind kind;
  std::uint8_t index;       // index of the axis or input
  std::uint8_t pre_shift;   // 0..40: shift with which the limits fit int32
  std::uint8_t shift;       // 0..61
  std::int32_t multiplier;  // > 0
  std::int64_t low, high;   // limits, in counts of the quantity
  std::int64_t wrap;  // 0, or the length of one period (a power of two): a value beyond the limits is changed
                      // by whole periods
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
  std::uint16_t source;  // register that contains the result
  std::uint32_t shift;   // 0..61
  std::int32_t multiplier;
  std::int32_t limit;  // largest |correction|, axis counts
  std::int32_t slew;   // largest change per tick, axis counts
};
static_assert(sizeof(Output) == 20);
static_assert(offsetof(Output, axis) == 0 && offsetof(Output, source) == 2 && offsetof(Output, shift) == 4 &&
              offsetof(Output, multiplier) == 8 && offsetof(Output, limit) == 12 &&
              offsetof(Output, slew) == 16);

/// The complete correction program of a machine. A Program does not own its memory.
struct Program {
  Equation equation;
  View<Channel> channels;
  View<Output> outputs;
  std::uint32_t axis_count = 0;
  std::uint32_t input_count = 0;
};

/// A Deviation is the actual minus the nominal position of an axis. A Correction is the value that is added
/// to the command of an axis. Deviation and Correction are in counts of the axis. Deviation and
/// Correction are separate types. Because Deviation and Correction are separate types, the compiler
/// detects a wrong sign.
struct Deviation {
  std::int32_t counts = 0;
};
struct Correction {
  std::int32_t counts = 0;
};
/// Converts a deviation to a correction. No other function converts a deviation to a correction.
/// -INT32_MIN becomes INT32_MAX. Real-time safe.
constexpr Correction correction_for(Deviation deviation) noexcept {
  return Correction{deviation.counts == INT32_MIN ? INT32_MAX : -deviation.counts};
}
/// Returns the correction of a linear axis as a length.
constexpr LengthNm length_of(Correction correction) { return LengthNm(correction.counts); }

/// Flags for the limits that act on the corrections in this tick. A flag is reported in each tick in which
/// its limit acts; a flag is never latched.
enum CycleFlag : std::uint32_t {
  kBeyondRange = 1u << 0,  // a channel was outside its declared range, and the limit of the range was used
  kSaturated = 1u << 1,    // a correction is at its limit
  kSlewing = 1u << 2,      // a correction has not yet reached its target
};

struct CycleOutput {
  Correction correction[kMaxAxes];    // 0 for an axis that is not corrected
  Correction wanted[kMaxAxes];        // correction at full weight, before the slew limit
  std::uint32_t flags = 0;            // CycleFlag
  std::uint32_t beyond_channels = 0;  // number of channels beyond their range
};

/// Returns the value of an input of the tick, limited to the range of its channel, in the format of the
/// program. The conversion is monotone. The limits of the value give the limits of the result, because the
/// conversion is monotone. Real-time safe.
std::int32_t channel_value(const Channel& channel, std::int64_t value) noexcept;

struct ShareProgram;

/// Start values of the equation in one tick. With these start values, another thread can execute
/// the equation of the tick again.
struct EquationState {
  static constexpr std::uint32_t kMostChannels = 256;  // largest number of channels of a program whose shares
                                                       // can be displayed
  std::uint32_t channel_count = 0, starting = 0;
  std::int32_t channel[kMostChannels] = {};
  LagState lag[kMaxLags] = {};
};

/// The compiled form of a program (`vernier compile`, equation.cpp). The function computes the deviations of
/// the outputs from the channels, in the order and formats of the program. Real-time safe.
using PrintedEquation = void (*)(const std::int32_t* channel, LagState* lag, bool starting,
                                 std::int32_t* deviation) noexcept;

/// Computes one tick of the correction: equation, magnitude limit, ramp weight, slew limit. The Compensator
/// owns the registers, the lags and the state of the slew limits. The program must be verified before, and
/// must exist longer than the compensator.
class Compensator {
 public:
  /// Constructs a compensator whose registers, lags and corrections are 0. Not real-time safe.
  explicit Compensator(const Program& program) noexcept;

  /// Computes the correction of this tick. Call step() once per tick, because the slew limit and the lags
  /// count ticks. `weight`: 0..kFullWeight, the share of the correction that is applied (during ramp-in and
  /// ramp-out). The function step() never fails. Real-time safe.
  CycleOutput step(const CycleInput& input, WeightQ16 weight = kFullWeight) noexcept;

  /// Starts the slew limit of an axis from the correction that its drive already has. With this start value,
  /// a change of the program causes no step of the correction. Not real-time safe.
  void start_from(std::uint32_t axis, Correction held) noexcept { slew_[axis].start_from(held.counts); }

  /// Resets the lags and the slew limits. After a reset, the next call of step() starts from zero
  /// correction. Not real-time safe.
  void reset() noexcept;

  /// Copies the channels and lags at the start of the last step. The copied state is empty for a program with
  /// more than kMostChannels channels. Only channels and lags that the program uses are copied. Real-time
  /// safe.
  void state(EquationState& state) const noexcept;

  /// After this call, step() executes the compiled C++ code `equation` instead of interpreting the program.
  /// The command `vernier compile` wrote this code from the same program. The compiled code and the
  /// interpreted program give identical corrections, to the last bit. The compiled code needs a
  /// fifth to a third of the instructions of the interpreted program. Not real-time safe.
  void use_printed(PrintedEquation equation) noexcept { printed_ = equation; }
  bool printed() const noexcept { return printed_ != nullptr; }

  /// After this call, step() executes the dense form of the program (comp/dense.h) instead of interpreting
  /// the program. The dense form and the interpreted program give identical corrections, to the last bit; the
  /// dense form needs a half of the instructions or less. `memory`: dense_size(program.equation) cells and
  /// one frame, which no other compensator uses. Returns false if the memory is too small: the program is
  /// interpreted as before. Not real-time safe.
  bool use_dense(const DenseMemory& memory) noexcept;
  bool dense() const noexcept { return dense_.cells != nullptr; }

  /// Returns the value of register i after the last step, for tests and for the inspection of intermediate
  /// values. In the printed and in the dense form only the channels and the outputs have values. Not
  /// real-time safe.
  std::int32_t register_value(std::uint32_t i) const noexcept { return registers_[i]; }

 private:
  void read_channels(const CycleInput& input, CycleOutput& output) noexcept;
  void run_printed() noexcept;
  void run_dense_form() noexcept;

  Program program_;
  PrintedEquation printed_ = nullptr;
  DenseMemory dense_;
  std::int32_t registers_[kMaxRegisters] = {};
  LagState lags_[kMaxLags] = {};
  LagState lags_before_[kMaxLags] = {};  // state of the lags before the tick
  bool started_now_ = false;
  SlewLimit slew_[kMaxAxes];
  bool starting_ = true;
};

}  // namespace vernier
