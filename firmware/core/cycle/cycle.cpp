// SPDX-License-Identifier: Apache-2.0
#include "firmware/core/cycle/cycle.h"

#include "comp/fixed.h"
#include "tables/link_format.h"

namespace vernier {
namespace {

Fault first_of(Fault a, Fault b) noexcept { return a != Fault::kNone ? a : b; }

}  // namespace

Cycle::Cycle(const ImageView& view, const Board& board, const CycleLimits& limits) noexcept
    : board_(board),
      limits_(limits),
      own_dense_(dense_size(view.program().equation)),
      own_(std::make_unique<BoundProgram>(view, own_dense_.memory())),
      now_(own_.get()) {
  set_up(wiring_of(view), TimeUs(view.header().tick_us));
  use(*own_);
}

Cycle::Cycle(const Wiring& wiring, TimeUs tick, const Board& board, const CycleLimits& limits) noexcept
    : board_(board), limits_(limits), own_(std::make_unique<BoundProgram>()), now_(own_.get()) {
  set_up(wiring, tick);
}

void Cycle::set_up(const Wiring& wiring, TimeUs tick) noexcept {
  for (std::size_t i = 0; i < wiring.axes.size(); ++i) {
    const AxisSetting& setting = limits_.axis[i];
    AxisLimits axis = setting.own ? setting.limits : wiring.axes[i].rotary ? limits_.rotary : limits_.linear;
    axis.rollover = wiring.axes[i].rollover;
    axes_[i] = AxisMonitor(axis, tick, board_.axes.gives_motion());
    linear_[i] = !wiring.axes[i].rotary;
  }
  for (WeightQ16& weight : axis_weight_) weight = kFullWeight;
  axis_count_ = static_cast<std::uint32_t>(wiring.axes.size());
  input_count_ = static_cast<std::uint32_t>(wiring.inputs.size());
}

BoundProgram* Cycle::use(BoundProgram& next) noexcept {
  BoundProgram* const before = now_;
  now_ = &next;
  for (const Output& out : next.program.outputs) {
    const std::uint32_t axis = next.axis[out.axis];
    const std::int64_t held = written_[axis].count;
    next.compensator.start_from(out.axis,
                                Correction{narrow(clamp<std::int64_t>(held, INT32_MIN, INT32_MAX))});
    const std::int64_t slew = lower<std::int64_t>(out.slew, limits_.axis[axis].motion.slew);
    // A program whose axis may not move does not strand what an earlier one has put there.
    if (slew > 0) drive_[axis].slew = slew;
  }
  for (bool& used : uses_axis_) used = false;
  for (bool& used : uses_input_) used = false;
  for (std::uint32_t i = 0; i < next.program.axis_count; ++i) uses_axis_[next.axis[i]] = true;
  for (std::uint32_t i = 0; i < next.program.input_count; ++i)
    uses_input_[next.input[i]] = next.reads_input[i];
  for (std::uint32_t i = 0; i < next.program.input_count; ++i)
    if (!heard_[next.input[i]]) inputs_[next.input[i]] = next.reference[i];
  ++health_.programs;
  return before;
}

Fault Cycle::read_axes(TicksQ8 elapsed) noexcept {
  Fault fault = Fault::kNone;
  board_.axes.begin_tick();
  for (std::uint32_t i = 0; i < now_->program.axis_count; ++i) {
    const std::uint32_t axis = now_->axis[i];
    AxisReading reading;
    const bool present = board_.axes.read_axis(axis, reading) == HalFault::kNone;
    fault = first_of(fault, axes_[axis].take(present, reading, health_, elapsed));
  }
  // Inputs that no program needs are read as well, for records and touches; their failure is no fault.
  for (std::uint32_t axis = 0; axis < axis_count_; ++axis) {
    AxisReading reading;
    if (uses_axis_[axis]) continue;
    const bool present = board_.axes.read_axis(axis, reading) == HalFault::kNone;
    axes_[axis].take(present, reading, idle_health_, elapsed);
  }
  // If the controller gives no reading, feed and curvature keep their values; its axes give no reading either
  // and raise the fault.
  PathReading path;
  if (board_.axes.read_path(path) == HalFault::kNone) path_ = path;
  if (!path_.tells_feed) path_.feed = feed_of_axes();
  return fault;
}

// Speed of the linear axes together: the path speed of a machine with perpendicular axes.
FeedNmPerMin Cycle::feed_of_axes() const noexcept {
  constexpr std::int64_t kMost = 1'000'000'000;  // 1 m/s: squares of all axes fit into 64 bits
  static_assert(kMaxAxes <= 18);
  std::uint64_t squares = 0;
  for (std::uint32_t axis = 0; axis < axis_count_; ++axis) {
    if (!linear_[axis]) continue;
    const std::int64_t speed = clamp(axes_[axis].state().velocity.count, -kMost, kMost);
    squares += static_cast<std::uint64_t>(speed * speed);
  }
  // Integer square root, bit by bit.
  std::uint64_t root = 0;
  for (std::uint64_t bit = std::uint64_t{1} << 31; bit > 0; bit >>= 1)
    if ((root | bit) * (root | bit) <= squares) root |= bit;
  constexpr std::int64_t kSecondsPerMinute = 60;
  return FeedNmPerMin(static_cast<std::int64_t>(root) * kSecondsPerMinute);
}

Fault Cycle::take_input(std::uint32_t input, InputMicro value) noexcept {
  const InputLimits& limits = limits_.input[input];
  // Unsigned, so that no two readings overflow.
  const std::int64_t before = inputs_[input].count;
  const auto step = static_cast<std::uint64_t>(higher(value.count, before)) -
                    static_cast<std::uint64_t>(lower(value.count, before));
  const bool jumps = heard_[input] && step > static_cast<std::uint64_t>(limits.step);
  const bool outside = value.count < limits.low || value.count > limits.high;
  if (jumps || outside) ++health_.implausible;
  if (outside) return Fault::kInputImplausible;
  inputs_[input] = value;
  heard_[input] = true;
  silent_[input] = 0;
  // A reading that jumps is a fault once, and the measure of the next ones.
  return jumps ? Fault::kInputImplausible : Fault::kNone;
}

Fault Cycle::read_inputs() noexcept {
  Fault fault = Fault::kNone;
  board_.inputs.begin_tick();
  for (std::uint32_t i = 0; i < now_->program.input_count; ++i) {
    const std::uint32_t input = now_->input[i];
    if (!now_->reads_input[i]) continue;
    InputMicro value;
    if (board_.inputs.read_input(input, value) == HalFault::kNone) {
      fault = first_of(fault, take_input(input, value));
      continue;
    }
    ++health_.missing_inputs;
    silent_[input] = silent_[input] < UINT32_MAX ? silent_[input] + 1 : silent_[input];
    if (silent_[input] > limits_.missing_input_ticks) fault = first_of(fault, Fault::kInputMissing);
  }
  for (std::uint32_t input = 0; input < input_count_; ++input) {
    InputMicro value;
    if (!uses_input_[input] && board_.inputs.read_input(input, value) == HalFault::kNone)
      inputs_[input] = value;
  }
  return fault;
}

bool Cycle::complete() const noexcept {
  if (now_->empty()) return false;
  for (std::uint32_t i = 0; i < now_->program.axis_count; ++i)
    if (!axes_[now_->axis[i]].known()) return false;
  for (std::uint32_t i = 0; i < now_->program.input_count; ++i)
    if (now_->reads_input[i] && !heard_[now_->input[i]]) return false;
  return true;
}

void Cycle::fill_input(TimeUs time) noexcept {
  for (std::uint32_t i = 0; i < now_->program.axis_count; ++i) input_.axis[i] = axes_[now_->axis[i]].state();
  for (std::uint32_t i = 0; i < now_->program.input_count; ++i) input_.input[i] = inputs_[now_->input[i]];
  input_.feed = path_.feed;
  input_.curvature = path_.curvature;
  input_.visit = path_.visit;
  input_.time = time;
}

void Cycle::collect_wishes(const CycleOutput& output) noexcept {
  if (mode_.holding()) return;
  for (Drive& drive : drive_) drive.wanted = drive.whole = 0, drive.limits = 0;
  for (const Output& out : now_->program.outputs) {
    const std::uint32_t axis = now_->axis[out.axis];
    Drive& drive = drive_[axis];
    const std::int64_t largest = limits_.axis[axis].largest;
    const std::int64_t asked = multiply(output.correction[out.axis].counts, axis_weight_[axis].count, 16);
    drive.whole = output.wanted[out.axis].counts;
    drive.wanted = clamp(asked, -largest, largest);
    if (drive.wanted != asked) drive.limits |= kAtBoardLimit;
    if (higher(drive.whole, -drive.whole) >= out.limit && drive.whole != 0) drive.limits |= kAtImageLimit;
  }
}

// Reported state of an axis: the value of its output, and the limit that holds it.
void Cycle::judge_limits(std::uint32_t axis) noexcept {
  Drive& drive = drive_[axis];
  drive.achieved = board_.corrections.within_range(axis, written_[axis]);
  const std::uint32_t kept = drive.limits & (kAtBoardLimit | kAtImageLimit);
  const std::uint32_t at_end = drive.achieved != written_[axis] ? std::uint32_t{kAtOutputLimit} : 0u;
  const std::uint32_t moving = written_[axis].count != drive.wanted ? std::uint32_t{kOnItsWay} : 0u;
  drive.limits = static_cast<std::uint8_t>(kept | at_end | moving);
  held_ = held_ || (drive.limits & (kAtBoardLimit | kAtOutputLimit)) != 0;
}

// A refused write is repeated with the same value: whichever of the two the drive holds, its next step is
// within the limit. The compensator has meanwhile gone on, so the way to it is limited here again.
bool Cycle::write_axis(std::uint32_t axis) noexcept {
  Drive& drive = drive_[axis];
  const MotionBounds bounds{drive.slew, limits_.axis[axis].motion.acceleration};
  // For every history, no more than the limit of the board is ever written.
  const std::int64_t largest = limits_.axis[axis].largest;
  const AxisTravel next =
      drive.repeat ? drive.pending
                   : AxisTravel(clamp(drive.motion.approach(drive.wanted, bounds), -largest, largest));
  drive.repeat = board_.corrections.write_correction(axis, next) != HalFault::kNone;
  if (drive.repeat) {
    ++health_.failed_writes;
    drive.pending = next;
    drive.motion.stop_at(next.count);
  } else {
    written_[axis] = next;
  }
  return !drive.repeat;
}

Fault Cycle::write(const CycleOutput& output) noexcept {
  Fault fault = Fault::kNone;
  at_zero_ = settled_ = true;
  held_ = false;
  collect_wishes(output);
  for (std::uint32_t axis = 0; axis < kMaxAxes; ++axis) {
    if (drive_[axis].slew == 0) continue;
    const bool written = write_axis(axis);
    judge_limits(axis);
    if (!written) fault = Fault::kWriteFailed;
    at_zero_ = at_zero_ && written && written_[axis] == AxisTravel{};
    settled_ = settled_ && written && written_[axis].count == drive_[axis].wanted;
  }
  settled_ = settled_ && (output.flags & kSlewing) == 0;
  return fault;
}

void Cycle::count(const CycleOutput& output) noexcept {
  ++health_.ticks;
  health_.active_ticks += mode_.mode() == Mode::kActive ? 1 : 0;
  health_.saturated += (output.flags & kSaturated) != 0 || held_ ? 1 : 0;
  health_.slewing += (output.flags & kSlewing) != 0 ? 1 : 0;
  health_.beyond_range += (output.flags & kBeyondRange) != 0 ? 1 : 0;
}

TickReport Cycle::tick(TimeUs time, Command command, Fault outer, TicksQ8 elapsed) noexcept {
  const Fault axes = read_axes(elapsed), inputs = read_inputs();
  found_ = first_of(outer, first_of(axes, inputs));
  mode_.before(command, found_, complete(), health_);
  const bool ramping_out_fault = mode_.latched() != Fault::kNone && mode_.mode() == Mode::kRampOut;
  if (!ramping_out_fault) fill_input(time);
  const CycleOutput output = now_->compensator.step(input_, mode_.weight());
  const Fault writing = write(output);
  mode_.after(writing, at_zero_, settled_, health_);
  count(output);
  return {output, mode_.mode(), mode_.latched()};
}

}  // namespace vernier
