#include "tools/compile/builder.h"

#include <cmath>
#include <stdexcept>

namespace vernier {
namespace {

constexpr std::uint32_t kFirstChannel = 512, kFirstResult = 640;
constexpr int kMostBits = 50, kFewestBits = -30;

std::string identifier(const std::string& name) {
  std::string out;
  for (const char c : name) out += (std::isalnum(static_cast<unsigned char>(c)) != 0) ? c : '_';
  if (out.empty() || std::isdigit(static_cast<unsigned char>(out[0])) != 0) out = "v" + out;
  return out;
}

/// Words that mean something else in the printed program.
std::set<std::string> taken_names() {
  return {"lower",
          "higher",
          "linear",
          "multiply",
          "multiply_add",
          "magnitude",
          "sign_of",
          "wrapped",
          "segment_of",
          "fraction_in",
          "linear_between",
          "cubic_between",
          "lagged",
          "step_lag",
          "start_lag",
          "channel",
          "lag",
          "starting",
          "deviation",
          "equation",
          "clamp",
          "narrow",
          "round_shift",
          "saturate",
          "std",
          "vernier",
          "generated",
          "View",
          "Segment",
          "Wrap",
          "LagState",
          "alignas",
          "and",
          "asm",
          "auto",
          "bool",
          "break",
          "case",
          "catch",
          "char",
          "class",
          "const",
          "continue",
          "default",
          "delete",
          "do",
          "double",
          "else",
          "enum",
          "explicit",
          "export",
          "extern",
          "false",
          "float",
          "for",
          "friend",
          "goto",
          "if",
          "inline",
          "int",
          "long",
          "mutable",
          "namespace",
          "new",
          "not",
          "operator",
          "or",
          "private",
          "protected",
          "public",
          "register",
          "requires",
          "return",
          "short",
          "signed",
          "sizeof",
          "static",
          "struct",
          "switch",
          "template",
          "this",
          "throw",
          "true",
          "try",
          "typedef",
          "typename",
          "union",
          "unsigned",
          "using",
          "virtual",
          "void",
          "volatile",
          "while",
          "xor",
          "concept",
          "constexpr",
          "nullptr",
          "noexcept"};
}

/// Two real factors as integers over one power of two: k ~ first / 2^shift, |first|, |second| <= kMaxFactor.
struct Factors {
  std::int32_t first = 0, second = 0;
  int shift = 0;
};

int room(double factor) {
  return factor == 0 ? 200 : 30 - static_cast<int>(std::ceil(std::log2(std::abs(factor)) - 1e-12));
}

Factors factors_for(double first, double second) {
  Factors f;
  f.shift = std::min({room(first), room(second), static_cast<int>(kMaxShift)});
  if (f.shift < 0) return f;
  const auto quantised = [&](double k) {
    return static_cast<std::int32_t>(std::lround(std::ldexp(k, f.shift)));
  };
  f.first = quantised(first);
  f.second = quantised(second);
  while (f.shift > 0 && f.first % 2 == 0 && f.second % 2 == 0) f.first /= 2, f.second /= 2, --f.shift;
  return f;
}

}  // namespace

int fraction_bits_for(double magnitude) {
  if (magnitude <= 0) return kMostBits;
  const int bits = static_cast<int>(std::floor(std::log2(2147483647.0 / magnitude)));
  return std::clamp(bits, kFewestBits, kMostBits);
}

ProgramBuilder::ProgramBuilder() : registers_(kFirstResult), ranges_(kFirstResult), names_(taken_names()) {}

double ProgramBuilder::lsb(Id id) const { return std::ldexp(1.0, -registers_[id].fraction_bits); }

std::string ProgramBuilder::unique(const std::string& name) {
  const std::string base = identifier(name);
  std::string result = base;
  for (int i = 2; !names_.insert(result).second; ++i) result = base + "_" + std::to_string(i);
  return result;
}

Equation ProgramBuilder::view() const {
  Equation e;
  e.tables = {table_views_.data(), static_cast<std::uint32_t>(table_views_.size())};
  e.columns = {column_views_.data(), static_cast<std::uint32_t>(column_views_.size())};
  e.wraps = {p_.wraps.data(), static_cast<std::uint32_t>(p_.wraps.size())};
  e.lag_count = p_.lag_count;
  return e;
}

ProgramBuilder::Id ProgramBuilder::constant(double value) {
  const auto found = known_constants_.find(value);
  if (found != known_constants_.end()) return found->second;
  const Id id = static_cast<Id>(p_.constants.size());
  if (id >= kFirstChannel) throw InputError("cannot be compiled: more constants than a program holds");
  Register& r = registers_[id];
  r.fraction_bits = fraction_bits_for(std::abs(value));
  const auto count = std::llround(std::ldexp(value, r.fraction_bits));
  r.name = unique("constant_" + std::to_string(id + 1));
  r.range = {value, value};
  r.error = r.own_error = std::abs(std::ldexp(static_cast<double>(count), -r.fraction_bits) - value);
  p_.constants.push_back(static_cast<std::int32_t>(count));
  ranges_[id] = {count, count};
  known_constants_[value] = id;
  return id;
}

ProgramBuilder::Id ProgramBuilder::channel(Channel channel, double unit, double reach,
                                           const std::string& name) {
  const Id id = kFirstChannel + static_cast<Id>(p_.channels.size());
  if (id >= kFirstResult) throw InputError("cannot be compiled: more channels than a program holds");
  const Interval exact{static_cast<double>(channel.low) * unit, static_cast<double>(channel.high) * unit};
  Register& r = registers_[id];
  r.fraction_bits = fraction_bits_for(std::max(exact.magnitude(), reach) * (1 + 1e-9));
  const double widest =
      std::max(std::abs(static_cast<double>(channel.low)), std::abs(static_cast<double>(channel.high)));
  while (std::ldexp(widest, -channel.pre_shift) > 2147483646.0) ++channel.pre_shift;
  double factor = unit * std::ldexp(1.0, r.fraction_bits + channel.pre_shift);
  while (factor > kMaxFactor) factor /= 2, --r.fraction_bits;
  const Factors f = factors_for(factor, 0);
  channel.multiplier = f.first;
  channel.shift = static_cast<std::uint8_t>(f.shift);
  r.name = unique(name);
  r.range = exact;
  const double scale_error = std::abs(std::ldexp(f.first, -f.shift) / factor - 1) * exact.magnitude();
  const double rounding = (f.shift > 0 ? 0.5 * lsb(id) : 0) +
                          (channel.pre_shift > 0 ? 0.5 * std::ldexp(unit, channel.pre_shift) : 0);
  r.error = r.own_error = scale_error + rounding;
  r.source = ErrorSource::kChannel;
  p_.channels.push_back(channel);
  ranges_[id] = {channel_value(channel, channel.low), channel_value(channel, channel.high)};
  return id;
}

ProgramBuilder::Id ProgramBuilder::append(const Instruction& step, const Register& meta, bool& overflow) {
  const Id id = static_cast<Id>(registers_.size());
  ValueRange range;
  const ProgramFault fault = range_of(view(), step, id, ranges_.data(), range);
  overflow = fault == ProgramFault::kOverflow;
  if (overflow) return 0;
  if (fault != ProgramFault::kNone)
    throw std::logic_error("the compiler wrote an instruction that its verifier refuses: " + meta.name +
                           ", fault " + std::to_string(static_cast<int>(fault)));
  registers_.push_back(meta);
  Register& r = registers_.back();
  r.name = unique(meta.name);
  r.error = r.own_error;
  for (const Register::Use& use : r.uses) r.error += use.gain * registers_[use.from].error;
  ranges_.push_back(range);
  p_.instructions.push_back(step);
  if (p_.instructions.size() + p_.constants.size() + p_.channels.size() > kMaxRegisters)
    throw InputError("cannot be compiled: the equation needs more than " + std::to_string(kMaxRegisters) +
                     " registers");
  return id;
}

ProgramBuilder::Id ProgramBuilder::linear(double k, Id a, double l, Id b, const Interval& exact,
                                          const std::string& name) {
  Register meta;
  meta.name = name;
  meta.range = exact;
  const double input_error = std::abs(k) * at(a).error + (l == 0 ? 0 : std::abs(l) * at(b).error);
  for (int bits = fraction_bits_for(exact.magnitude() + input_error); bits >= kFewestBits; --bits) {
    const double first = std::ldexp(k, bits - at(a).fraction_bits),
                 second = std::ldexp(l, bits - at(b).fraction_bits);
    const Factors f = factors_for(first, second);
    if (f.shift < 0) continue;
    meta.fraction_bits = bits;
    const double unit = std::ldexp(1.0, -bits);
    const auto largest = [&](Id id) {
      return std::max(std::abs(static_cast<double>(ranges_[id].low)),
                      std::abs(static_cast<double>(ranges_[id].high)));
    };
    meta.own_error = std::abs(std::ldexp(f.first, -f.shift) - first) * largest(a) * unit +
                     std::abs(std::ldexp(f.second, -f.shift) - second) * largest(b) * unit +
                     (f.shift > 0 ? unit / 2 : 0);
    meta.uses = {{a, std::abs(k)}};
    if (l != 0) meta.uses.push_back({b, std::abs(l)});
    Instruction step{OpCode::kLinear,
                     static_cast<std::uint8_t>(f.shift),
                     static_cast<std::uint16_t>(a),
                     static_cast<std::uint16_t>(b),
                     0,
                     f.first,
                     f.second};
    bool overflow = false;
    const Id id = append(step, meta, overflow);
    if (!overflow) return id;
  }
  throw InputError("cannot be compiled: " + name + " is too large for 32 bits over the declared ranges");
}

ProgramBuilder::Id ProgramBuilder::product(Id a, Id b, const Interval& exact, const std::string& name) {
  const double size_a = at(a).range.magnitude(), size_b = at(b).range.magnitude();
  const double input_error = size_b * at(a).error + size_a * at(b).error + at(a).error * at(b).error;
  const int sum_bits = at(a).fraction_bits + at(b).fraction_bits;
  const int finest = std::min(sum_bits, fraction_bits_for(exact.magnitude() + input_error));
  for (int bits = finest; bits >= kFewestBits && sum_bits - bits <= static_cast<int>(kMaxShift); --bits) {
    Register meta;
    meta.name = name;
    meta.range = exact;
    meta.fraction_bits = bits;
    meta.own_error = sum_bits > bits ? std::ldexp(0.5, -bits) : 0;
    meta.uses = {{a, size_b + at(b).error}, {b, size_a}};
    Instruction step{OpCode::kMultiply,
                     static_cast<std::uint8_t>(sum_bits - bits),
                     static_cast<std::uint16_t>(a),
                     static_cast<std::uint16_t>(b),
                     0,
                     0,
                     0};
    bool overflow = false;
    const Id id = append(step, meta, overflow);
    if (!overflow) return id;
  }
  throw InputError("cannot be compiled: the product " + name +
                   " does not fit 32 bits over the declared ranges");
}

ProgramBuilder::Id ProgramBuilder::plain(Instruction step, int fraction_bits, const Interval& exact,
                                         double error, ErrorSource source, std::vector<Register::Use> uses,
                                         const std::string& name) {
  Register meta;
  meta.name = name;
  meta.range = exact;
  meta.fraction_bits = fraction_bits;
  meta.own_error = error;
  meta.source = source;
  meta.uses = std::move(uses);
  bool overflow = false;
  const Id id = append(step, meta, overflow);
  if (overflow)
    throw InputError("cannot be compiled: " + name + " does not fit 32 bits over the declared ranges");
  return id;
}

ProgramBuilder::Id ProgramBuilder::reformat(Id a, int fraction_bits) {
  if (at(a).fraction_bits == fraction_bits) return a;
  const Factors f = factors_for(std::ldexp(1.0, fraction_bits - at(a).fraction_bits), 0);
  if (f.shift < 0 || f.first == 0)
    throw InputError("cannot be compiled: " + at(a).name +
                     " is compared with a value of another order of magnitude");
  const Instruction step{OpCode::kLinear,
                         static_cast<std::uint8_t>(f.shift),
                         static_cast<std::uint16_t>(a),
                         static_cast<std::uint16_t>(a),
                         0,
                         f.first,
                         0};
  return plain(step, fraction_bits, at(a).range, f.shift > 0 ? std::ldexp(0.5, -fraction_bits) : 0,
               ErrorSource::kRounding, {{a, 1}}, at(a).name + "_aligned");
}

std::uint16_t ProgramBuilder::add_table(std::vector<Segment> segments, const std::string& name) {
  if (p_.tables.size() >= kMaxTables) throw InputError("cannot be compiled: more tables than an image holds");
  p_.tables.push_back(std::move(segments));
  p_.table_names.push_back(name);
  table_views_.push_back({p_.tables.back().data(), static_cast<std::uint32_t>(p_.tables.back().size())});
  return static_cast<std::uint16_t>(p_.tables.size() - 1);
}

std::uint16_t ProgramBuilder::add_column(std::vector<std::int32_t> values, const std::string& name) {
  if (p_.columns.size() >= kMaxColumns)
    throw InputError("cannot be compiled: more table columns than an image holds");
  p_.columns.push_back(std::move(values));
  p_.column_names.push_back(name);
  column_views_.push_back({p_.columns.back().data(), static_cast<std::uint32_t>(p_.columns.back().size())});
  return static_cast<std::uint16_t>(p_.columns.size() - 1);
}

std::uint16_t ProgramBuilder::add_wrap(const Wrap& wrap) {
  p_.wraps.push_back(wrap);
  return static_cast<std::uint16_t>(p_.wraps.size() - 1);
}

std::uint16_t ProgramBuilder::add_lag() {
  if (p_.lag_count >= kMaxLags) throw InputError("cannot be compiled: more lags than a program holds");
  return static_cast<std::uint16_t>(p_.lag_count++);
}

LoweredProgram ProgramBuilder::finish(const std::vector<std::pair<Output, Id>>& outputs) {
  const auto constants = static_cast<Id>(p_.constants.size()), channels = static_cast<Id>(p_.channels.size());
  const auto final_id = [&](Id id) {
    if (id < kFirstChannel) return id;
    if (id < kFirstResult) return id - kFirstChannel + constants;
    return id - kFirstResult + constants + channels;
  };
  const auto move_operand = [&](std::uint16_t& operand) {
    operand = static_cast<std::uint16_t>(final_id(operand));
  };
  for (Instruction& s : p_.instructions) {
    move_operand(s.a);
    const bool lookup =
        s.op == OpCode::kFraction || s.op == OpCode::kLinearColumn || s.op == OpCode::kCubicColumn;
    const bool index = lookup || s.op == OpCode::kSegment || s.op == OpCode::kWrap || s.op == OpCode::kLag;
    if (!index && s.op != OpCode::kAbs && s.op != OpCode::kSign) move_operand(s.b);
    if (lookup || s.op == OpCode::kMultiplyAdd) move_operand(s.c);
  }
  for (Id id = 0; id < registers_.size(); ++id) {
    const bool gap =
        (id >= constants && id < kFirstChannel) || (id >= kFirstChannel + channels && id < kFirstResult);
    if (gap) continue;
    for (Register::Use& use : registers_[id].uses) use.from = final_id(use.from);
    p_.registers.push_back(registers_[id]);
  }
  for (const auto& [output, id] : outputs) {
    p_.outputs.push_back(output);
    p_.outputs.back().source = static_cast<std::uint16_t>(final_id(id));
  }
  return std::move(p_);
}

}  // namespace vernier
