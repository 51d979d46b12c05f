// SPDX-License-Identifier: Apache-2.0
#include "firmware/cycle.h"

#include "comp/fixed.h"

namespace vernier {
namespace {

Fault first_of(Fault a, Fault b) noexcept { return a != Fault::kNone ? a : b; }

}  // namespace

Cycle::Cycle(const ImageView& view, const Board& board, const CycleLimits& limits) noexcept
    : board_(board), program_(view.program()), limits_(limits), compensator_(view.program()) {
  const TimeUs tick(view.header().tick_us);
  for (std::uint32_t i = 0; i < view.axes().size; ++i) {
    const std::uint32_t flags = view.axes()[i].flags;
    AxisLimits axis = (flags & kRotary) != 0 ? limits.rotary : limits.linear;
    axis.rollover = (flags & kRollover) != 0;
    axes_[i] = AxisMonitor(axis, tick, board.axes.gives_motion());
  }
  for (std::uint32_t i = 0; i < view.inputs().size; ++i) inputs_[i] = InputMicro(view.inputs()[i].reference);
}

Fault Cycle::read_axes() noexcept {
  Fault fault = Fault::kNone;
  for (std::uint32_t i = 0; i < program_.axis_count; ++i) {
    AxisReading reading;
    const bool present = board_.axes.read_axis(i, reading) == HalFault::kNone;
    fault = first_of(fault, axes_[i].take(present, reading, health_));
  }
  // Feed and curvature of a silent controller are held; its axes are silent too and raise the fault.
  PathReading path;
  if (board_.axes.read_path(path) == HalFault::kNone) path_ = path;
  return fault;
}

Fault Cycle::read_inputs() noexcept {
  Fault fault = Fault::kNone;
  for (std::uint32_t i = 0; i < program_.input_count; ++i) {
    InputMicro value;
    if (board_.inputs.read_input(i, value) == HalFault::kNone) {
      inputs_[i] = value;
      heard_[i] = true;
      silent_[i] = 0;
      continue;
    }
    ++health_.missing_inputs;
    silent_[i] = silent_[i] < UINT32_MAX ? silent_[i] + 1 : silent_[i];
    if (silent_[i] > limits_.missing_input_ticks) fault = first_of(fault, Fault::kInputMissing);
  }
  return fault;
}

bool Cycle::complete() const noexcept {
  for (std::uint32_t i = 0; i < program_.axis_count; ++i)
    if (!axes_[i].known()) return false;
  for (std::uint32_t i = 0; i < program_.input_count; ++i)
    if (!heard_[i]) return false;
  return true;
}

void Cycle::fill_input(TimeUs time) noexcept {
  for (std::uint32_t i = 0; i < program_.axis_count; ++i) input_.axis[i] = axes_[i].state();
  for (std::uint32_t i = 0; i < program_.input_count; ++i) input_.input[i] = inputs_[i];
  input_.feed = path_.feed;
  input_.curvature = path_.curvature;
  input_.visit = path_.visit;
  input_.time = time;
}

// A refused write is repeated with the same value: whichever of the two the drive holds, its next step is
// within the limit. The compensator has meanwhile gone on, so the way to it is limited here again.
Fault Cycle::write(const CycleOutput& output) noexcept {
  Fault fault = Fault::kNone;
  at_zero_ = settled_ = true;
  for (const Output& out : program_.outputs) {
    const std::uint32_t axis = out.axis;
    const std::int64_t wanted = output.correction[axis].counts, held = written_[axis].count;
    const AxisTravel next =
        repeat_[axis]
            ? pending_[axis]
            : AxisTravel(held + clamp(wanted - held, -std::int64_t{out.slew}, std::int64_t{out.slew}));
    repeat_[axis] = board_.corrections.write_correction(axis, next) != HalFault::kNone;
    if (repeat_[axis]) {
      ++health_.failed_writes;
      pending_[axis] = next;
      fault = Fault::kWriteFailed;
    } else {
      written_[axis] = next;
    }
    at_zero_ = at_zero_ && !repeat_[axis] && written_[axis] == AxisTravel{};
    settled_ = settled_ && !repeat_[axis] && written_[axis].count == wanted;
  }
  settled_ = settled_ && (output.flags & kSlewing) == 0;
  return fault;
}

void Cycle::count(const CycleOutput& output) noexcept {
  ++health_.ticks;
  health_.active_ticks += mode_.mode() == Mode::kActive ? 1 : 0;
  health_.saturated += (output.flags & kSaturated) != 0 ? 1 : 0;
  health_.slewing += (output.flags & kSlewing) != 0 ? 1 : 0;
  health_.beyond_range += (output.flags & kBeyondRange) != 0 ? 1 : 0;
}

TickReport Cycle::tick(TimeUs time, Command command, Fault outer) noexcept {
  const Fault axes = read_axes(), inputs = read_inputs();
  mode_.before(command, first_of(outer, first_of(axes, inputs)), complete(), health_);
  const bool ramping_out_fault = mode_.latched() != Fault::kNone && mode_.mode() == Mode::kRampOut;
  if (!ramping_out_fault) fill_input(time);
  const CycleOutput output = compensator_.step(input_, mode_.weight());
  const Fault writing = write(output);
  mode_.after(writing, at_zero_, settled_, health_);
  count(output);
  return {output, mode_.mode(), mode_.latched()};
}

}  // namespace vernier
