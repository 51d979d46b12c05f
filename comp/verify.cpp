// SPDX-License-Identifier: Apache-2.0
#include "comp/verify.h"

#include "comp/fixed.h"

namespace vernier {
namespace {

constexpr std::int64_t kLow = INT32_MIN, kHigh = INT32_MAX;

constexpr bool fits(const ValueRange& r) { return r.low >= kLow && r.high <= kHigh && r.low <= r.high; }

ValueRange product(const ValueRange& a, const ValueRange& b) {
  const std::int64_t p[4] = {a.low * b.low, a.low * b.high, a.high * b.low, a.high * b.high};
  return {lower(lower(p[0], p[1]), lower(p[2], p[3])), higher(higher(p[0], p[1]), higher(p[2], p[3]))};
}
constexpr ValueRange constant(std::int64_t value) { return {value, value}; }
constexpr ValueRange sum(const ValueRange& a, const ValueRange& b) {
  return {a.low + b.low, a.high + b.high};
}
constexpr ValueRange shifted(const ValueRange& a, unsigned shift) {
  return {round_shift(a.low, shift), round_shift(a.high, shift)};
}
constexpr ValueRange hull(const ValueRange& a, const ValueRange& b) {
  return {lower(a.low, b.low), higher(a.high, b.high)};
}
constexpr bool factor_ok(std::int32_t k) { return k >= -kMaxFactor && k <= kMaxFactor; }

bool table_ok(const View<Segment>& table) {
  if (table.size == 0) return false;
  for (std::uint32_t i = 0; i < table.size; ++i) {
    const Segment& segment = table[i];
    const std::int64_t next = std::int64_t{segment.start} + segment.length;
    if (segment.length == 0 || next > kHigh || segment.shift > 33) return false;
    if (i + 1 < table.size && table[i + 1].start != next) return false;
    // The reciprocal is the smallest that reaches one at the far end: 2^(30+shift) <= length*reciprocal <
    // that + length.
    const std::uint64_t one = std::uint64_t{1} << (30 + segment.shift);
    const std::uint64_t reach = std::uint64_t{segment.length} * segment.reciprocal;
    if (reach < one || reach - one >= segment.length) return false;
  }
  return true;
}

bool wrap_ok(const Wrap& wrap) {
  if (wrap.period <= 0 || wrap.reciprocal <= 0 || wrap.shift > kMaxShift) return false;
  if (std::int64_t{wrap.first} + wrap.period - 1 > kHigh) return false;
  // Number of periods at most one off over 2^32 counts: 2^32 * |reciprocal * period - 2^shift| <= 2^shift *
  // period.
  const std::int64_t one = std::int64_t{1} << wrap.shift;
  const std::int64_t error = magnitude_of(std::int64_t{wrap.reciprocal} * wrap.period - one);
  return error <= (one >> 32) * wrap.period;
}

ValueRange column_range(const View<std::int32_t>& column) {
  ValueRange range = constant(column[0]);
  for (const std::int32_t value : column) range = hull(range, constant(value));
  return range;
}

bool cubic_range(const View<std::int32_t>& column, std::uint32_t segments, ValueRange& range) {
  const ValueRange fraction{0, kFractionOne};
  for (std::uint32_t i = 0; i < segments; ++i) {
    const std::int32_t* const c = column.data + std::size_t{4} * i;
    const ValueRange second = sum(constant(c[2]), shifted(product(constant(c[3]), fraction), 30));
    const ValueRange first = sum(constant(c[1]), shifted(product(second, fraction), 30));
    if (!fits(second) || !fits(first)) return false;
    const ValueRange value = sum(constant(c[0]), shifted(product(first, fraction), 30));
    range = i == 0 ? value : hull(range, value);
  }
  return true;
}

bool second_operand_is_register(OpCode op) {
  return op == OpCode::kLinear || op == OpCode::kMultiply || op == OpCode::kMultiplyAdd ||
         op == OpCode::kMin || op == OpCode::kMax || op == OpCode::kEqual || op == OpCode::kLess;
}
bool third_operand_is_register(OpCode op) {
  return op == OpCode::kMultiplyAdd || op == OpCode::kFraction || op == OpCode::kLinearColumn ||
         op == OpCode::kCubicColumn;
}
bool is_look_up(OpCode op) {
  return op == OpCode::kSegment || op == OpCode::kFraction || op == OpCode::kLinearColumn ||
         op == OpCode::kCubicColumn;
}

ProgramFault look_up_range(const Equation& e, const Instruction& s, const ValueRange* r, ValueRange& out) {
  const ValueRange& a = r[s.a];
  if (s.op == OpCode::kSegment) {
    if (s.b >= e.tables.size) return ProgramFault::kOperand;
    out = {0, std::int64_t{e.tables[s.b].size} - 1};
    return ProgramFault::kNone;
  }
  const ValueRange& segment = r[s.c];
  if (segment.low < 0) return ProgramFault::kSegmentRange;
  if (s.op == OpCode::kFraction) {
    if (s.b >= e.tables.size) return ProgramFault::kOperand;
    if (segment.high >= e.tables[s.b].size) return ProgramFault::kSegmentRange;
    out = {0, kFractionOne};
    return ProgramFault::kNone;
  }
  if (s.b >= e.columns.size) return ProgramFault::kOperand;
  if (a.low < 0 || a.high > kFractionOne) return ProgramFault::kOverflow;
  const View<std::int32_t>& column = e.columns[s.b];
  if (s.op == OpCode::kLinearColumn) {
    if (segment.high + 1 >= column.size) return ProgramFault::kSegmentRange;
    out = column_range(column);
    return ProgramFault::kNone;
  }
  if (4 * (segment.high + 1) > column.size) return ProgramFault::kSegmentRange;
  return cubic_range(column, static_cast<std::uint32_t>(segment.high + 1), out) ? ProgramFault::kNone
                                                                                : ProgramFault::kOverflow;
}

ProgramFault arithmetic_range(const Equation& e, const Instruction& s, const ValueRange* r, ValueRange& out) {
  const ValueRange& a = r[s.a];
  const ValueRange& b = second_operand_is_register(s.op) ? r[s.b] : a;  // s.b may be an index of another kind
  switch (s.op) {
    case OpCode::kLinear:
      out = shifted(sum(product(a, constant(s.k)), product(b, constant(s.l))), s.shift);
      break;
    case OpCode::kMultiply:
      out = shifted(product(a, b), s.shift);
      break;
    case OpCode::kMultiplyAdd:
      out = shifted(sum(product(a, b), product(r[s.c], constant(s.k))), s.shift);
      break;
    case OpCode::kAbs:
      out = {a.low > 0 ? a.low : (a.high < 0 ? -a.high : 0),
             higher(magnitude_of(a.low), magnitude_of(a.high))};
      break;
    case OpCode::kMin:
      out = {lower(a.low, b.low), lower(a.high, b.high)};
      break;
    case OpCode::kMax:
      out = {higher(a.low, b.low), higher(a.high, b.high)};
      break;
    case OpCode::kSign:
      out = {a.low > 0 ? 1 : (a.low == 0 ? 0 : -1), a.high < 0 ? -1 : (a.high == 0 ? 0 : 1)};
      break;
    case OpCode::kEqual:
    case OpCode::kLess:
      out = {0, 1};
      break;
    case OpCode::kWrap:
      if (s.b >= e.wraps.size) return ProgramFault::kOperand;
      out = {e.wraps[s.b].first, std::int64_t{e.wraps[s.b].first} + e.wraps[s.b].period - 1};
      break;
    case OpCode::kLag:
      if (s.b >= e.lag_count) return ProgramFault::kLag;
      if (s.shift < 31 || s.k < 0) return ProgramFault::kShift;
      out = a;  // a convex combination of the inputs so far, rounded monotonically
      break;
    default:
      return ProgramFault::kOpCode;
  }
  return ProgramFault::kNone;
}

std::uint8_t index_limit(ChannelKind kind, const Program& program) {
  if (kind <= ChannelKind::kSince) return static_cast<std::uint8_t>(program.axis_count);
  return kind == ChannelKind::kInput ? static_cast<std::uint8_t>(program.input_count) : 1;
}

ProgramFault verify_channels(const Program& program, ValueRange* ranges) {
  constexpr std::int64_t kFar = std::int64_t{1} << 60;
  for (std::uint32_t i = 0; i < program.channels.size; ++i) {
    const Channel& c = program.channels[i];
    const bool known =
        static_cast<std::uint8_t>(c.kind) < kChannelKindCount && c.index < index_limit(c.kind, program);
    const bool limits = c.low <= c.high && c.low > -kFar && c.high < kFar;
    if (!known || !limits || c.pre_shift > 40 || c.shift > kMaxShift || c.multiplier <= 0)
      return ProgramFault::kChannel;
    if (c.wrap < 0 || (c.wrap & (c.wrap - 1)) != 0 || c.wrap >= kFar) return ProgramFault::kChannel;
    const ValueRange narrowed{round_shift(c.low, c.pre_shift), round_shift(c.high, c.pre_shift)};
    if (!fits(narrowed)) return ProgramFault::kChannel;
    const ValueRange value = shifted(product(narrowed, constant(c.multiplier)), c.shift);
    if (!fits(value)) return ProgramFault::kOverflow;
    ranges[program.equation.first_channel() + i] = value;
  }
  return ProgramFault::kNone;
}

ProgramFault verify_stores(const Equation& e) {
  for (const View<Segment>& table : e.tables)
    if (!table_ok(table)) return ProgramFault::kTable;
  for (const View<std::int32_t>& column : e.columns)
    if (column.size == 0) return ProgramFault::kColumn;
  for (const Wrap& wrap : e.wraps)
    if (!wrap_ok(wrap)) return ProgramFault::kWrap;
  return ProgramFault::kNone;
}

ProgramFault verify_outputs(const Program& program) {
  std::uint32_t seen = 0;
  for (const Output& o : program.outputs) {
    if (o.axis >= program.axis_count || (seen >> o.axis & 1u) != 0) return ProgramFault::kOutput;
    if (o.source >= program.equation.register_count() || o.shift > kMaxShift) return ProgramFault::kOutput;
    if (o.limit < 0 || o.slew < 0 || !factor_ok(o.multiplier)) return ProgramFault::kOutput;
    seen |= 1u << o.axis;
  }
  return ProgramFault::kNone;
}

ProgramFault verify_size(const Program& program) {
  const Equation& e = program.equation;
  constexpr std::uint32_t kMost = kMaxRegisters;
  if (e.constants.size > kMost || e.channel_count > kMost || e.instructions.size > kMost)
    return ProgramFault::kTooLong;
  if (e.register_count() > kMost || e.lag_count > kMaxLags) return ProgramFault::kTooLong;
  if (program.axis_count > kMaxAxes || program.input_count > kMaxInputs) return ProgramFault::kTooLong;
  return e.channel_count == program.channels.size ? ProgramFault::kNone : ProgramFault::kChannel;
}

}  // namespace

ProgramFault range_of(const Equation& equation, const Instruction& step, std::uint32_t position,
                      const ValueRange* ranges, ValueRange& result) noexcept {
  if (static_cast<std::uint8_t>(step.op) >= kOpCodeCount) return ProgramFault::kOpCode;
  if (step.a >= position) return ProgramFault::kOperand;
  if (second_operand_is_register(step.op) && step.b >= position) return ProgramFault::kOperand;
  if (third_operand_is_register(step.op) && step.c >= position) return ProgramFault::kOperand;
  if (step.shift > kMaxShift) return ProgramFault::kShift;
  if (step.op == OpCode::kLinear && !(factor_ok(step.k) && factor_ok(step.l))) return ProgramFault::kShift;
  if (step.op == OpCode::kMultiplyAdd && !factor_ok(step.k)) return ProgramFault::kShift;
  const ProgramFault fault = is_look_up(step.op) ? look_up_range(equation, step, ranges, result)
                                                 : arithmetic_range(equation, step, ranges, result);
  if (fault != ProgramFault::kNone) return fault;
  return fits(result) ? ProgramFault::kNone : ProgramFault::kOverflow;
}

ProgramFault verify_program(const Program& program, ValueRange* ranges) noexcept {
  const Equation& e = program.equation;
  ProgramFault fault = verify_size(program);
  if (fault == ProgramFault::kNone) fault = verify_stores(e);
  if (fault == ProgramFault::kNone) fault = verify_channels(program, ranges);
  if (fault != ProgramFault::kNone) return fault;
  for (std::uint32_t i = 0; i < e.constants.size; ++i) ranges[i] = constant(e.constants[i]);

  std::uint32_t lags_used = 0;
  std::uint32_t position = e.first_result();
  for (const Instruction& step : e.instructions) {
    // The operands are checked before arithmetic_range reads them: a register index below `position` is in
    // `ranges`.
    fault = range_of(e, step, position, ranges, ranges[position]);
    if (fault != ProgramFault::kNone) return fault;
    if (step.op == OpCode::kLag) {
      if ((lags_used >> step.b & 1u) != 0) return ProgramFault::kLag;
      lags_used |= 1u << step.b;
    }
    ++position;
  }
  if (lags_used != (std::uint32_t{1} << e.lag_count) - 1) return ProgramFault::kLag;
  return verify_outputs(program);
}

}  // namespace vernier
