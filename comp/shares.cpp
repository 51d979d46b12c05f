// SPDX-License-Identifier: Apache-2.0
#include "comp/shares.h"

#include "comp/fixed.h"

namespace vernier {
namespace {

bool may_stand_in_shares(OpCode op) {
  return op != OpCode::kWrap && op != OpCode::kLookUp && op != OpCode::kSineCosine && op != OpCode::kLag;
}

ProgramFault verify_share_outputs(const ShareProgram& shares, const Program& program) {
  for (const Share& s : shares.shares) {
    const bool known = s.axis < program.axis_count && s.source < shares.equation.register_count();
    if (!known || s.shift > kMaxShift || s.multiplier < -kMaxFactor || s.multiplier > kMaxFactor)
      return ProgramFault::kOutput;
  }
  return ProgramFault::kNone;
}

}  // namespace

ProgramFault verify_shares(const ShareProgram& shares, const Program& program, ValueRange* ranges) noexcept {
  const Equation& e = shares.equation;
  const std::uint32_t behind = program.equation.register_count();
  // Each of the three alone, so that their sum cannot come round.
  if (e.constants.size > kMaxRegisters || e.channel_count > kMaxRegisters || e.result_count > kMaxRegisters)
    return ProgramFault::kTooLong;
  if (behind + e.register_count() > kMaxRegisters || shares.shares.size > kMaxShares)
    return ProgramFault::kTooLong;
  if (e.channel_count != shares.sources.size) return ProgramFault::kChannel;
  ValueRange* const own = ranges + behind;
  for (std::uint32_t i = 0; i < e.constants.size; ++i) own[i] = {e.constants[i], e.constants[i]};
  for (std::uint32_t i = 0; i < e.channel_count; ++i) {
    if (shares.sources[i] >= behind) return ProgramFault::kChannel;
    own[e.first_channel() + i] = ranges[shares.sources[i]];
  }
  std::uint32_t position = e.first_result();
  for (const Instruction& step : e.instructions) {
    if (position == e.register_count()) return ProgramFault::kTooLong;
    if (!may_stand_in_shares(step.op)) return ProgramFault::kOpCode;
    const ProgramFault fault = range_of(e, step, position, own, own + position);
    if (fault != ProgramFault::kNone) return fault;
    ++position;
  }
  if (position != e.register_count()) return ProgramFault::kTooLong;
  return verify_share_outputs(shares, program);
}

bool run_shares(const ShareProgram& shares, const Program& program, const EquationState& state,
                std::int32_t* registers, Correction* corrections) noexcept {
  const Equation& tick = program.equation;
  if (state.channel_count != tick.channel_count) return false;
  for (std::uint32_t i = 0; i < tick.constants.size; ++i) registers[i] = tick.constants[i];
  for (std::uint32_t i = 0; i < tick.channel_count; ++i)
    registers[tick.first_channel() + i] = state.channel[i];
  LagState lags[kMaxLags];
  for (std::uint32_t i = 0; i < tick.lag_count; ++i) lags[i] = state.lag[i];
  run_equation(tick, registers, lags, state.starting != 0);
  const Equation& e = shares.equation;
  std::int32_t* const own = registers + program.equation.register_count();
  for (std::uint32_t i = 0; i < e.constants.size; ++i) own[i] = e.constants[i];
  for (std::uint32_t i = 0; i < e.channel_count; ++i)
    own[e.first_channel() + i] = registers[shares.sources[i]];
  run_equation(e, own, nullptr, false);
  for (std::uint32_t i = 0; i < shares.shares.size; ++i) {
    const Share& s = shares.shares[i];
    bool saturated = false;
    const std::int64_t deviation = round_shift(std::int64_t{own[s.source]} * s.multiplier, s.shift);
    corrections[i] = correction_for(Deviation{saturate(deviation, saturated)});
  }
  return true;
}

}  // namespace vernier
