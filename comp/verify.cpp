// SPDX-License-Identifier: Apache-2.0
#include "comp/verify.h"

#include "comp/fixed.h"
#include "comp/sine.h"

namespace vernier {
namespace {

constexpr std::int64_t kLow = INT32_MIN, kHigh = INT32_MAX;

// Every operation on ranges gives low <= high.
constexpr bool fits(const ValueRange& r) { return r.low >= kLow && r.high <= kHigh; }

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

bool segment_ok(const Segment& s) {
  if (s.length == 0 || std::int64_t{s.start} + s.length > kHigh || s.shift > 33) return false;
  // The reciprocal is the smallest that reaches one at the far end, and reaches no more than one:
  // 2^(30+shift) <= length*reciprocal < that + the smaller of length and 2^shift.
  const std::uint64_t one = std::uint64_t{1} << (30 + s.shift);
  const std::uint64_t reach = std::uint64_t{s.length} * s.reciprocal;
  return reach >= one && reach - one < s.length && (reach - one) >> s.shift == 0;
}

bool table_ok(const ErrorTable& table) {
  if (table.pieces == 0 || table.columns == 0 || table.columns > kMaxRegisters) return false;
  if (table.degree != 1 && table.degree != 3) return false;
  for (std::uint32_t i = 0; i < table.pieces; ++i) {
    const Segment s = segment_at(table.record(i));
    if (!segment_ok(s)) return false;
    if (i + 1 < table.pieces && table.record(i + 1)[0] != std::int64_t{s.start} + s.length) return false;
  }
  return table.grid_multiplier == 0 ? table.grid_shift == 0 : grid_finds_every_piece(table);
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

constexpr ValueRange truncated(const ValueRange& a) { return {a.low >> 30, a.high >> 30}; }

bool cubic_range(const std::int32_t* c, ValueRange& range) {
  const ValueRange fraction{0, kFractionOne};
  const ValueRange third = truncated(product(constant(c[3]), fraction));
  const ValueRange second = sum(constant(c[2]), third);
  if (!fits(second)) return false;
  const ValueRange first = sum(constant(c[1]), truncated(product(second, fraction)));
  if (!fits(first)) return false;
  range = sum(constant(c[0]), shifted(product(first, fraction), 30));
  return fits(range);
}

// The range of a column over all pieces of its table.
ProgramFault column_range(const ErrorTable& table, std::uint32_t column, ValueRange& out) {
  for (std::uint32_t i = 0; i < table.pieces; ++i) {
    const std::int32_t* const c = table.record(i) + kSegmentWords + column * (table.degree + 1u);
    ValueRange piece = hull(constant(c[0]), constant(std::int64_t{c[0]} + c[1]));
    if (table.degree == 3 ? !cubic_range(c, piece) : !fits(piece)) return ProgramFault::kOverflow;
    out = i == 0 ? piece : hull(out, piece);
  }
  return ProgramFault::kNone;
}

bool second_operand_is_register(OpCode op) {
  return op == OpCode::kLinear || op == OpCode::kMultiply || op == OpCode::kMin || op == OpCode::kMax ||
         op == OpCode::kEqual || op == OpCode::kLess;
}
// |sum| stays below 2^62, so that it and its rounding fit 64 bits.
bool sum_fits(const ValueRange& r) {
  constexpr std::int64_t kFar = std::int64_t{1} << 62;
  return r.low > -kFar && r.high < kFar;
}

ProgramFault dot_range(const Equation& e, const Instruction& s, std::uint32_t position, const ValueRange* r,
                       ValueRange& out) {
  const std::uint64_t terms = std::uint64_t{s.a} + s.b;
  if (s.l < 0 || static_cast<std::uint32_t>(s.l) + terms > e.terms.size || terms == 0)
    return ProgramFault::kOperand;
  if (s.c > 31) return ProgramFault::kShift;
  out = constant(std::int64_t{s.k} * (std::int64_t{1} << s.c));
  for (std::uint32_t i = 0; i < terms; ++i) {
    const ProductTerm& t = e.terms[static_cast<std::uint32_t>(s.l) + i];
    if (t.a >= position || t.b >= position) return ProgramFault::kOperand;
    if (t.shift > 62) return ProgramFault::kShift;
    const ValueRange p = product(r[t.a], r[t.b]);
    const ValueRange part{p.low >> t.shift, p.high >> t.shift};
    // Each part is at most 2^62 and the sum so far below 2^62: their sum is below 2^63.
    out = i < s.a ? sum(out, part) : sum(out, {-part.high, -part.low});
    if (!sum_fits(out)) return ProgramFault::kOverflow;
  }
  out = shifted(out, s.shift);
  return ProgramFault::kNone;
}

ProgramFault look_up_range(const Equation& e, const Instruction& s, ValueRange* results) {
  if (s.b >= e.tables.size) return ProgramFault::kOperand;
  for (std::uint32_t c = 0; c < e.tables[s.b].columns; ++c)
    if (const ProgramFault fault = column_range(e.tables[s.b], c, results[c]); fault != ProgramFault::kNone)
      return fault;
  return ProgramFault::kNone;
}

ProgramFault arithmetic_range(const Equation& e, const Instruction& s, const ValueRange* r, ValueRange& out) {
  const ValueRange& a = r[s.a];
  const ValueRange& b = second_operand_is_register(s.op) ? r[s.b] : a;  // s.b may be an index of another kind
  switch (s.op) {
    case OpCode::kLinear:
      if (!factor_ok(s.k) || !factor_ok(s.l)) return ProgramFault::kShift;
      out = shifted(sum(product(a, constant(s.k)), product(b, constant(s.l))), s.shift);
      break;
    case OpCode::kMultiply:
      out = shifted(product(a, b), s.shift);
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
    case OpCode::kSineCosine:
      if (s.k <= 0) return ProgramFault::kShift;
      out = {-kSineLimit, kSineLimit};
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
  if (e.tables.size > kMaxTables || e.terms.size > kMaxTerms) return ProgramFault::kTooLong;
  for (const ErrorTable& table : e.tables)
    if (!table_ok(table)) return ProgramFault::kTable;
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
  if (e.constants.size > kMost || e.channel_count > kMost || e.instructions.size > kMost ||
      e.result_count > kMost)
    return ProgramFault::kTooLong;
  if (e.register_count() > kMost || e.lag_count > kMaxLags) return ProgramFault::kTooLong;
  if (program.axis_count > kMaxAxes || program.input_count > kMaxInputs) return ProgramFault::kTooLong;
  return e.channel_count == program.channels.size ? ProgramFault::kNone : ProgramFault::kChannel;
}

}  // namespace

bool grid_finds_every_piece(const ErrorTable& table) noexcept {
  if (table.grid_shift > 63) return false;
  for (std::uint32_t i = 0; i < table.pieces; ++i) {
    const Segment s = segment_at(table.record(i));
    if (grid_piece(table, narrow(std::int64_t{s.start} + s.length - 1)) != i) return false;
    if (s.length > 1 && grid_piece(table, narrow(std::int64_t{s.start} + 1)) != i) return false;
  }
  return true;
}

ProgramFault range_of(const Equation& equation, const Instruction& step, std::uint32_t position,
                      const ValueRange* ranges, ValueRange* results) noexcept {
  if (static_cast<std::uint8_t>(step.op) >= kOpCodeCount) return ProgramFault::kOpCode;
  if (step.shift > kMaxShift) return ProgramFault::kShift;
  ProgramFault fault = ProgramFault::kNone;
  if (step.op == OpCode::kDot) {
    fault = dot_range(equation, step, position, ranges, *results);
  } else if (step.a >= position || (second_operand_is_register(step.op) && step.b >= position)) {
    fault = ProgramFault::kOperand;
  } else if (step.op == OpCode::kLookUp) {
    return look_up_range(equation, step, results);
  } else {
    fault = arithmetic_range(equation, step, ranges, *results);
    if (step.op == OpCode::kSineCosine) results[1] = results[0];
  }
  if (fault != ProgramFault::kNone) return fault;
  return fits(*results) ? ProgramFault::kNone : ProgramFault::kOverflow;
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
    // The operands are checked before their ranges are read: a register index below `position` is in
    // `ranges`.
    const std::uint32_t results = results_of(step, e.tables);
    if (position + results > e.register_count()) return ProgramFault::kTooLong;
    fault = range_of(e, step, position, ranges, ranges + position);
    if (fault != ProgramFault::kNone) return fault;
    if (step.op == OpCode::kLag) {
      if ((lags_used >> step.b & 1u) != 0) return ProgramFault::kLag;
      lags_used |= 1u << step.b;
    }
    position += results;
  }
  if (position != e.register_count()) return ProgramFault::kTooLong;
  if (lags_used != (std::uint32_t{1} << e.lag_count) - 1) return ProgramFault::kLag;
  return verify_outputs(program);
}

namespace {

// One piece found, and a value of each column: a cubic is three products where a line is one.
std::uint64_t look_up_work(const ErrorTable& table) noexcept {
  constexpr std::uint64_t kGrid = 10, kStep = 4;
  std::uint64_t search = kGrid;
  if (table.grid_multiplier == 0)
    for (std::uint32_t left = table.pieces; left > 1; left /= 2) search += kStep;
  return search + std::uint64_t{table.columns} * (table.degree == 3 ? 6 : 2);
}

// Largest number of cache lines that one interpolation may read from memory.
std::uint64_t look_up_lines(const ErrorTable& table) noexcept {
  constexpr std::uint64_t kLine = 64;  // bytes
  const std::uint64_t record = std::uint64_t{4} * table.stride();
  std::uint64_t lines = (record + kLine - 1) / kLine + 1;
  if (table.grid_multiplier == 0)
    for (std::uint32_t left = table.pieces; left > 1 && left * record > kLine; left -= left / 2) ++lines;
  return lines;
}

}  // namespace

std::uint64_t lines_of(const Equation& equation) noexcept {
  std::uint64_t lines = 0;
  for (const Instruction& step : equation.instructions)
    if (step.op == OpCode::kLookUp && step.b < equation.tables.size)
      lines += look_up_lines(equation.tables[step.b]);
  return lines;
}

std::uint64_t work_of(const Equation& equation, std::uint32_t channels) noexcept {
  constexpr std::uint64_t kInstruction = 4, kChannel = 6, kSine = 30, kLagStep = 8;
  std::uint64_t work = channels * kChannel + equation.lag_count;
  for (const Instruction& step : equation.instructions) {
    work += kInstruction;
    if (step.op == OpCode::kDot) work += std::uint64_t{step.a} + step.b;
    if (step.op == OpCode::kLookUp && step.b < equation.tables.size)
      work += look_up_work(equation.tables[step.b]);
    if (step.op == OpCode::kSineCosine) work += kSine;
    if (step.op == OpCode::kLag) work += kLagStep;
  }
  return work;
}

}  // namespace vernier
