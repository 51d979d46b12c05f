// SPDX-License-Identifier: Apache-2.0
#include "comp/compensator.h"

#include "comp/fixed.h"

namespace vernier {
namespace {

std::int64_t quantity_of(const Channel& channel, const CycleInput& input) noexcept {
  switch (channel.kind) {
    case ChannelKind::kPosition:
      return input.axis[channel.index].position.count;
    case ChannelKind::kVelocity:
      return input.axis[channel.index].velocity.count;
    case ChannelKind::kAcceleration:
      return input.axis[channel.index].acceleration.count;
    case ChannelKind::kSense:
      return input.axis[channel.index].sense;
    case ChannelKind::kSince:
      return input.axis[channel.index].since.count;
    case ChannelKind::kInput:
      return input.input[channel.index].count;
    case ChannelKind::kFeed:
      return input.feed.count;
    case ChannelKind::kCurvature:
      return input.curvature.count;
    case ChannelKind::kTime:
      return input.time.count;
    case ChannelKind::kVisit:
      return input.visit.count;
  }
  return 0;
}

// The period is a power of two, so that coming back by whole turns is a mask; unsigned, so that any value may
// come.
std::int64_t unrolled(const Channel& channel, std::int64_t value) noexcept {
  const auto turns = static_cast<std::uint64_t>(value) - static_cast<std::uint64_t>(channel.low);
  return channel.low + static_cast<std::int64_t>(turns & static_cast<std::uint64_t>(channel.wrap - 1));
}

}  // namespace

std::int32_t channel_value(const Channel& channel, std::int64_t value) noexcept {
  const std::int64_t limited = clamp(value, channel.low, channel.high);
  return narrow(multiply(narrow(round_shift(limited, channel.pre_shift)), channel.multiplier, channel.shift));
}

Compensator::Compensator(const Program& program) noexcept : program_(program) {
  const View<std::int32_t>& constants = program_.equation.constants;
  for (std::uint32_t i = 0; i < constants.size; ++i) registers_[i] = constants[i];
}

void Compensator::reset() noexcept {
  starting_ = true;
  for (SlewLimit& slew : slew_) slew.reset();
}

void Compensator::read_channels(const CycleInput& input, CycleOutput& output) noexcept {
  std::int32_t* out = registers_ + program_.equation.first_channel();
  for (const Channel& channel : program_.channels) {
    std::int64_t value = quantity_of(channel, input);
    const bool beyond = value < channel.low || value > channel.high;
    if (beyond && channel.wrap != 0) {
      value = unrolled(channel, value);
    } else if (beyond && channel.kind != ChannelKind::kSince) {
      // Travel since a reversal has no end; holding its edge is the rule there, not an event.
      output.flags |= kBeyondRange;
      ++output.beyond_channels;
    }
    *out++ = channel_value(channel, value);
  }
}

void Compensator::state(EquationState& state) const noexcept {
  const Equation& e = program_.equation;
  state.channel_count = e.channel_count <= EquationState::kMostChannels ? e.channel_count : 0;
  state.starting = started_now_ ? 1 : 0;
  for (std::uint32_t i = 0; i < state.channel_count; ++i)
    state.channel[i] = registers_[e.first_channel() + i];
  for (std::uint32_t i = 0; i < e.lag_count; ++i) state.lag[i] = lags_before_[i];
}

void Compensator::run_printed() noexcept {
  std::int32_t deviation[kMaxAxes];
  printed_(registers_ + program_.equation.first_channel(), lags_, starting_, deviation);
  for (std::uint32_t i = 0; i < program_.outputs.size; ++i)
    registers_[program_.outputs[i].source] = deviation[i];
}

bool Compensator::use_dense(const DenseMemory& memory) noexcept {
  if (!make_dense(program_.equation, memory)) return false;
  dense_ = memory;
  return true;
}

void Compensator::run_dense_form() noexcept {
  const Equation& e = program_.equation;
  DenseFrame& frame = *dense_.frame;
  for (std::uint32_t i = e.first_channel(); i < e.first_result(); ++i) frame.registers[i] = registers_[i];
  frame.lags = lags_;
  frame.starting = starting_;
  run_dense(dense_);
  for (const Output& out : program_.outputs)
    registers_[out.source] = static_cast<std::int32_t>(frame.registers[out.source]);
}

CycleOutput Compensator::step(const CycleInput& input, WeightQ16 weight) noexcept {
  CycleOutput output;
  read_channels(input, output);
  for (std::uint32_t i = 0; i < program_.equation.lag_count; ++i) lags_before_[i] = lags_[i];
  started_now_ = starting_;
  if (printed_ != nullptr)
    run_printed();
  else if (dense())
    run_dense_form();
  else
    run_equation(program_.equation, registers_, lags_, starting_);
  starting_ = false;
  const std::int32_t share = clamp(weight.count, std::int32_t{0}, kFullWeight.count);
  for (const Output& out : program_.outputs) {
    bool saturated = false;
    const Deviation deviation{
        saturate(round_shift(std::int64_t{registers_[out.source]} * out.multiplier, out.shift), saturated)};
    const std::int32_t wanted = correction_for(deviation).counts;
    const std::int32_t limited = clamp(wanted, -out.limit, out.limit);
    output.wanted[out.axis] = Correction{limited};
    SlewLimit& slew = slew_[out.axis];
    output.correction[out.axis] = Correction{slew.approach(narrow(multiply(limited, share, 16)), out.slew)};
    if (saturated || limited != wanted) output.flags |= kSaturated;
    if (slew.limiting()) output.flags |= kSlewing;
  }
  return output;
}

}  // namespace vernier
